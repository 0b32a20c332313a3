"""Measure the English planner on an orchard of a given size with requests of every kind that it understands."""

from __future__ import annotations

import contextlib
import gc
import statistics
from collections.abc import Callable
from dataclasses import dataclass
from typing import Literal

import numpy as np

from fieldhand.errors import DriveFault
from fieldhand.forecast.visit_order import drives_for
from fieldhand.planning.english.planner import EnglishPlanner
from fieldhand.planning.planner import Clarify, Outcome, Planned
from fieldhand.robot.loader import load_robot
from fieldhand.site.loader import parse_site
from fieldhand_bench.site import benchmark_orchard

ROBOT = "husky"

#: Requests from a single tree to the longest published one, with every kind of place, condition and limit.
REQUESTS = (
    "Take a picture of tree 7.",
    "Photograph trees 4, 9 and 12.",
    "Take a picture at each corner of the farm.",
    "Take a picture of the northernmost tree, then of the middle tree.",
    "Take pictures of 5 trees in the northern half.",
    "Take a picture of every tree.",
    "Take a picture of every tree in the wet corner.",
    "Take 5 CO2 readings spread over the wet corner.",
    "Take a picture of every tree within 30 m of the start.",
    "Take a CO2 reading at the 10 trees with the highest yield.",
    "Take a picture of every Kerman tree older than 20 years in the south-east quarter.",
    "Photograph the five oldest trees from north to south.",
    "Take a picture of every tree in row 3 of block 1.",
    "Take a picture of every third tree of rows 2 to 4 of block 1.",
    "Take a picture of the first three trees of row 2 of block 1.",
    "Read CO2 every 10 m along row 2 of block 1.",
    "Take a picture of tree 9. Go 2 trees down the row and do the same.",
    "Take a picture of tree 9 and then of the two trees next to it.",
    "Measure CO2 at tree 4. If it is low, take a picture, otherwise take a temperature reading. Then go to tree 9 and"
    " measure CO2.",
    "At every Kerman tree in the wet corner take a picture; if it is above 38 °C take a CO2 reading too.",
    "At the first tree, take a picture. If it is less than 33 C, take a temperature reading. If that reading is less"
    " than 30 C, take a CO2 sample. If that reading is less than 400 ppm, drive to a far away tree and repeat the"
    " process.",
    "Find a tree in the middle of the orchard and measure CO2. If it is low, go to 2 different trees nearby and take a"
    " picture of each of them. From there, measure another tree as far away as possible for CO2 and repeat the same"
    " process. Once done, take a temperature reading at any one of the northernmost trees. Finally, return to the end.",
    "Take pictures of as many trees as you can without driving more than 500 meters.",
    "Take as many CO2 readings at Kerman trees as you can in 20 minutes and keep 40 % of the battery in reserve.",
    "Photograph the corners within 20 minutes and, time permitting, measure CO2 at the middle tree.",
)


@dataclass(frozen=True, kw_only=True)
class RequestTiming:
    """Durations of planning a request.

    Attributes:
        request: Text of the request.
        answer: Answer of the planner on this orchard; a question or a refusal is measured, too.
        first_s: Duration of the first time, before the site has cached any selectors, seconds.
        median_s, worst_s: Median and maximum duration of the repeats, seconds.
    """

    request: str
    answer: Literal["planned", "asked", "refused"]
    first_s: float
    median_s: float
    worst_s: float


@dataclass(frozen=True, kw_only=True)
class PlanningBenchmark:
    """Measurements of the planner on one orchard.

    Attributes:
        trees, rows: Size of the orchard.
        repeats: Number of repeats of each request.
        seed: Random seed of the orchard.
        load_s: Duration of loading the site, its rows and its drivable graph once, seconds.
        grammar_s: Duration of the first request of the process, which loads grammar and lexicon, seconds.
        requests: Durations in the order of :data:`REQUESTS`.
    """

    trees: int
    rows: int
    repeats: int
    seed: int
    load_s: float
    grammar_s: float
    requests: tuple[RequestTiming, ...]

    @property
    def median_s(self) -> float:
        """Median of the requests' median durations, seconds."""
        return statistics.median(timing.median_s for timing in self.requests)

    @property
    def slowest(self) -> RequestTiming:
        """Timing of the request with the largest median."""
        return max(self.requests, key=lambda timing: timing.median_s)

    @property
    def worst_s(self) -> float:
        """Longest duration of any request, its first time included, seconds; without ``grammar_s``."""
        return max(max(timing.first_s, timing.worst_s) for timing in self.requests)


def measure_planning(trees: int, *, seed: int, repeats: int, clock: Callable[[], float]) -> PlanningBenchmark:
    """Plan each request on an orchard of so many trees; nothing is approved or simulated.

    Args:
        trees: Number of trees, 20 or more.
        seed: Random seed of the orchard.
        repeats: Number of repeats of each request, 1 or more.
        clock: Function that returns the current time in seconds.

    Raises:
        InputError: There are too few trees.
    """
    data = benchmark_orchard(trees, seed)
    robot, planner = load_robot(ROBOT), EnglishPlanner()
    begun = clock()
    site = parse_site(data, name="benchmark")
    drives = drives_for(site, robot)
    low, high = int(np.argmin(site.xy.sum(axis=1))), int(np.argmax(site.xy.sum(axis=1)))
    with contextlib.suppress(DriveFault):  # the graph is complete even without a path
        drives.between(site.trees[low].place, site.trees[high].place)
    loaded = clock()
    planner.plan("Take a picture of the first tree.", site, robot)
    grammar = clock()
    gc.collect()

    def timed(request: str) -> RequestTiming:
        taken: list[float] = []
        for _ in range(repeats + 1):
            before = clock()
            outcome = planner.plan(request, site, robot)
            taken.append(clock() - before)
        return RequestTiming(
            request=request,
            answer=_answer(outcome),
            first_s=taken[0],
            median_s=statistics.median(taken[1:]),
            worst_s=max(taken[1:]),
        )

    return PlanningBenchmark(
        trees=len(site.trees),
        rows=len(site.planting.rows),
        repeats=repeats,
        seed=seed,
        load_s=loaded - begun,
        grammar_s=grammar - loaded,
        requests=tuple(timed(request) for request in REQUESTS),
    )


def _answer(outcome: Outcome) -> Literal["planned", "asked", "refused"]:
    match outcome:
        case Planned():
            return "planned"
        case Clarify():
            return "asked"
        case _:
            return "refused"
