"""Measure a site of a given size: loading steps, each selector, drives, and peak memory."""

from __future__ import annotations

import contextlib
import gc
import statistics
import sys
import tempfile
import time
from collections.abc import Callable, Sequence
from dataclasses import dataclass
from pathlib import Path

import numpy as np

from fieldhand.errors import DriveFault, PlaceError
from fieldhand.places.context import Context
from fieldhand.places.reading_series import EXAMPLE_QUANTITY, EXAMPLE_READING, ReadingSeries, TakenReading
from fieldhand.places.resolution import resolve
from fieldhand.places.sources.bound import EXAMPLE_LABEL
from fieldhand.site.drives import Drives
from fieldhand.site.loader import load_site, parse_site
from fieldhand.site.model import Place, Site
from fieldhand_bench.site.memory import own_peak_bytes, peak_bytes
from fieldhand_bench.site.orchard import benchmark_orchard
from fieldhand_bench.site.samples import samples, with_records

Stopwatch = Callable[[], float]

_DRIVES = 200
_VISITED = 50


@dataclass(frozen=True, kw_only=True)
class Timing:
    """Durations of a repeated step.

    Attributes:
        name: Name of the step.
        first_s: Duration of the first time, before anything is cached, seconds.
        median_s: Median duration of the repeats, seconds.
        worst_s: Maximum duration of the repeats, seconds.
        places: Number of places that a selector gave; 0 for other steps.
    """

    name: str
    first_s: float
    median_s: float
    worst_s: float
    places: int = 0


@dataclass(frozen=True, kw_only=True)
class SiteBenchmark:
    """Measurements of one site.

    Attributes:
        trees, blocks, rows: Numbers of trees, blocks and rows as recognised by Fieldhand.
        file_bytes: Size of the GeoJSON file.
        repeats: Number of repeats of each step.
        seed: Random seed of the orchard.
        steps: Timings of reading, rows, drivable graph, and the sum of these.
        selectors: Timings of the selectors, resolved on the same site.
        drives: Timing of computing the path between two random trees, each pair once.
        unreachable: Number of pairs without a path.
        peak_bytes: Peak memory of a process that only loads the site; None if the system does not report it.
    """

    trees: int
    blocks: int
    rows: int
    file_bytes: int
    repeats: int
    seed: int
    steps: tuple[Timing, ...]
    selectors: tuple[Timing, ...]
    drives: Timing
    unreachable: int
    peak_bytes: int | None

    @property
    def load(self) -> Timing:
        """Timing of reading, rows and graph together."""
        return self.steps[-1]

    @property
    def slowest_selector(self) -> Timing:
        """Timing of the selector with the largest median."""
        return max(self.selectors, key=lambda t: t.median_s)


def measure_site(
    trees: int,
    *,
    seed: int,
    repeats: int,
    clearance_m: float,
    standoff_m: float,
    clock: Stopwatch = time.perf_counter,
) -> SiteBenchmark:
    """Measure an orchard of so many trees.

    Args:
        trees: Number of trees, 20 or more.
        seed: Random seed of the orchard and of the trees between which drives are computed.
        repeats: Number of repeats of each step and each selector, 1 or more.
        clearance_m: Half the robot's width, metres.
        standoff_m: Distance at which the robot works on a tree, metres.
        clock: Function that returns the current time in seconds.

    Raises:
        InputError: There are too few trees.
    """
    data = benchmark_orchard(trees, seed)
    memory = _peak(data, clearance_m, standoff_m)
    steps = _steps(data, repeats, clearance_m, standoff_m, clock)
    site = parse_site(data, name="benchmark")
    drives = _graph(site, clearance_m, standoff_m)
    ways, unreachable = _drives(site, drives, np.random.default_rng(seed), clock)
    return SiteBenchmark(
        trees=len(site.trees),
        blocks=len(site.planting.blocks),
        rows=len(site.planting.rows),
        file_bytes=len(data),
        repeats=repeats,
        seed=seed,
        steps=steps,
        selectors=_selectors(site, repeats, clock),
        drives=ways,
        unreachable=unreachable,
        peak_bytes=memory,
    )


def load(file: str, clearance_m: str, standoff_m: str) -> None:
    """Load a site with its rows and drivable graph and print the peak memory of this process."""
    _graph(load_site(Path(file)), float(clearance_m), float(standoff_m))
    peak = own_peak_bytes()
    if peak is not None:
        sys.stdout.write(f"{peak}\n")


def _graph(site: Site, clearance_m: float, standoff_m: float) -> Drives:
    """Build the drivable graph, which is complete once the first drive across the site has been computed."""
    drives = Drives(site, clearance_m, standoff_m)
    low, high = int(np.argmin(site.xy.sum(axis=1))), int(np.argmax(site.xy.sum(axis=1)))
    with contextlib.suppress(DriveFault):  # also without a path the whole graph is built
        drives.between(site.trees[low].place, site.trees[high].place)
    return drives


def _steps(data: bytes, repeats: int, clearance_m: float, standoff_m: float, clock: Stopwatch) -> tuple[Timing, ...]:
    """Time reading, rows and graph on a fresh site each time."""
    taken: list[tuple[float, float, float]] = []
    for _ in range(repeats):
        gc.collect()
        begun = clock()
        site = parse_site(data, name="benchmark")
        read = clock()
        _ = site.planting
        planted = clock()
        _graph(site, clearance_m, standoff_m)
        taken.append((read - begun, planted - read, clock() - planted))
        del site
    parse, rows, graph = zip(*taken, strict=True)
    return (
        _timing("read the file", parse),
        _timing("find the rows", rows),
        _timing("build the drivable graph", graph),
        _timing("all of it", [sum(t) for t in taken]),
    )


def _selectors(site: Site, repeats: int, clock: Stopwatch) -> tuple[Timing, ...]:
    middle = site.trees[len(site.trees) // 3].place
    visited = tuple(t.place.id for t in site.trees[:_VISITED])
    context = Context(
        here=middle,
        visited=visited,
        bound={EXAMPLE_LABEL: (middle,)},
        series={EXAMPLE_READING: ReadingSeries((TakenReading(place=middle, values={EXAMPLE_QUANTITY: 30.0}),))},
    )
    timings, recorded = [], with_records(site)
    for name, selector in samples(site).items():
        taken, places = [], 0
        for _ in range(repeats + 1):
            begun = clock()
            try:
                places = len(resolve(selector, recorded, context))
            except PlaceError:
                places = 0  # finding no place takes as long
            taken.append(clock() - begun)
        timings.append(_timing(name, taken[1:], first_s=taken[0], places=places))
    return tuple(timings)


def _drives(site: Site, drives: Drives, rng: np.random.Generator, clock: Stopwatch) -> tuple[Timing, int]:
    """Time drives between random trees on a graph that is already built; return unreachable pairs, too."""
    places: list[Place] = [site.trees[k].place for k in rng.integers(len(site.trees), size=2 * _DRIVES).tolist()]
    taken: list[float] = []
    unreachable = 0
    for k in range(_DRIVES):
        begun = clock()
        try:
            drives.between(places[2 * k], places[2 * k + 1])
        except DriveFault:
            unreachable += 1
        taken.append(clock() - begun)
    return _timing("a drive between two trees", taken[1:], first_s=taken[0]), unreachable


def _peak(data: bytes, clearance_m: float, standoff_m: float) -> int | None:
    with tempfile.TemporaryDirectory() as folder:
        file = Path(folder) / "benchmark.geojson"
        file.write_bytes(data)
        return peak_bytes(file, clearance_m, standoff_m)


def _timing(name: str, taken: Sequence[float], *, first_s: float | None = None, places: int = 0) -> Timing:
    return Timing(
        name=name,
        first_s=taken[0] if first_s is None else first_s,
        median_s=statistics.median(taken),
        worst_s=max(taken),
        places=places,
    )
