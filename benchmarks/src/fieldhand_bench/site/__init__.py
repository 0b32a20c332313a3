"""Measure time and memory for loading a site of a given size, resolving selectors and computing drives on it.

orchard    generates an orchard of a given size, with all features that make a site slow
samples    an example of each selector, as a planner would write it
memory     peak memory of a separate process that only loads a site
measure    runs and times all steps
"""

from fieldhand_bench.site.measure import SiteBenchmark, Timing, measure_site
from fieldhand_bench.site.orchard import benchmark_orchard
from fieldhand_bench.site.samples import samples

__all__ = ["SiteBenchmark", "Timing", "benchmark_orchard", "measure_site", "samples"]
