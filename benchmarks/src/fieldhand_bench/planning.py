"""How long the English planner takes on an orchard of a size, over requests of every kind that it knows."""

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

#: From one tree to the longest published request; every kind of place, condition and limit stands in one of them.
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
    """How long a request took to plan.

    Attributes:
        answer: What the planner made of it on this orchard; a question or a refusal takes its time, too.
        first_s: The first time, when what the site remembers of selectors is worked out.
        median_s, worst_s: Of the repeats.
    """

    request: str
    answer: Literal["planned", "asked", "refused"]
    first_s: float
    median_s: float
    worst_s: float


@dataclass(frozen=True, kw_only=True)
class PlanningBenchmark:
    """The planner on an orchard of a size.

    Attributes:
        load_s: Reading the site, its rows and its drivable graph, once.
        grammar_s: The very first request of a process, for which grammar and lexicon are loaded.
        requests: In the order of :data:`REQUESTS`.
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
        """The median over the requests of their medians."""
        return statistics.median(timing.median_s for timing in self.requests)

    @property
    def slowest(self) -> RequestTiming:
        """The request with the largest median."""
        return max(self.requests, key=lambda timing: timing.median_s)

    @property
    def worst_s(self) -> float:
        """The longest that any request took at any time after the first of the process, first times included."""
        return max(max(timing.first_s, timing.worst_s) for timing in self.requests)


def measure_planning(trees: int, *, seed: int, repeats: int, clock: Callable[[], float]) -> PlanningBenchmark:
    """Plan each request on an orchard of so many trees; nothing is approved or driven.

    Args:
        trees: 20 or more.
        seed: Of the orchard.
        repeats: Of each request; 1 or more.
        clock: Seconds, running.

    Raises:
        InputError: Too few trees.
    """
    data = benchmark_orchard(trees, seed)
    robot, planner = load_robot(ROBOT), EnglishPlanner()
    begun = clock()
    site = parse_site(data, name="benchmark")
    drives = drives_for(site, robot)
    low, high = int(np.argmin(site.xy.sum(axis=1))), int(np.argmax(site.xy.sum(axis=1)))
    with contextlib.suppress(DriveFault):  # the graph is complete then all the same
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
