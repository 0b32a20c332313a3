"""How fast a site of a size is read, understood and driven, and how much memory that takes.

orchard    an orchard of so many trees, with all that makes a site slow
samples    each selector once, as a planner would write it
memory     the peak of a process of its own that only loads
measure    all of it, with a clock
"""

from fieldhand_bench.site.measure import SiteBenchmark, Timing, measure_site
from fieldhand_bench.site.orchard import benchmark_orchard
from fieldhand_bench.site.samples import samples

__all__ = ["SiteBenchmark", "Timing", "benchmark_orchard", "measure_site", "samples"]
