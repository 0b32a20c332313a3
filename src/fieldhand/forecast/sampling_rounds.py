"""Forecast of adaptive sampling: how many readings a mean takes to be known, from the spread of the profile.

Readings are drawn from a normal distribution with the quantity's typical value and spread. A loop ends at the first
reading after which the condition holds, and at its maximum number of rounds at the latest. The branches of a forecast
include that maximum; this is the distribution below it.
"""

from __future__ import annotations

from collections.abc import Iterator, Sequence
from dataclasses import dataclass

import numpy as np
from numpy.typing import NDArray

from fieldhand.forecast.series_conditions import wanted_width
from fieldhand.forecast.walk_steps import Walk
from fieldhand.places.series_statistics import t_quantile
from fieldhand.robot.model import Quantity, RobotProfile
from fieldhand.task.aggregates import MeanKnown
from fieldhand.task.frames import Task
from fieldhand.task.plan import Node, acts, walk

#: Number of sampled loops.
DRAWS = 1000
#: Maximum number of readings of a sampled loop; longer loops are reported as if they ended there.
MAX_READINGS = 1000


@dataclass(frozen=True, kw_only=True)
class SamplingForecast:
    """The number of readings that a loop takes until a mean is known.

    Attributes:
        node: Id of the loop.
        quantity: Quantity whose mean is to be known.
        mean: Mean number of readings.
        p50, p90: Median, and the number not exceeded in nine missions of ten.
        at_most: Largest possible number of readings.
        known: Probability that the mean is known by then.
    """

    node: str
    quantity: str
    mean: float
    p50: int
    p90: int
    at_most: int
    known: float


def sampling_forecasts(
    task: Task, robot: RobotProfile, walks: Sequence[Walk], seed: int = 0
) -> tuple[SamplingForecast, ...]:
    """Return the forecast of each loop that ends once a mean is known.

    Args:
        task, robot: Task and robot.
        walks: Walks of the Task, which give the number of places of each loop.
        seed: Seed of the sampled readings.
    """
    return tuple(_forecasts(task, robot, walks, seed))


def _forecasts(task: Task, robot: RobotProfile, walks: Sequence[Walk], seed: int) -> Iterator[SamplingForecast]:
    for number, node in enumerate(walk(task.composition.plan)):
        known, quantity = node.tested, None
        if isinstance(known, MeanKnown):
            quantity = robot.quantity.get(known.quantity)
        if quantity is None or not isinstance(known, MeanKnown) or node.is_choice:
            continue
        each = sum(act.count for act in acts(node) if act.reading == known.reading)
        at_most = min(MAX_READINGS, each * _most_rounds(node, walks))
        if at_most < 1:
            continue
        counts, found = _sampled(known, quantity, each, at_most, np.random.default_rng([seed, number]))
        yield SamplingForecast(
            node=node.id,
            quantity=quantity.name,
            mean=float(counts.mean()),
            p50=int(np.quantile(counts, 0.5, method="inverted_cdf")),
            p90=int(np.quantile(counts, 0.9, method="inverted_cdf")),
            at_most=at_most,
            known=float(found.mean()),
        )


def _most_rounds(loop: Node, walks: Sequence[Walk]) -> int:
    """Return the largest number of rounds, or of visits on any walk, of one execution of a loop."""
    if loop.rounds is not None:
        return loop.rounds
    listed = (len(s.places) for w in walks for s in w.steps if s.kind == "visit-list" and s.node.id == loop.id)
    return max(listed, default=0)


def _sampled(
    known: MeanKnown, quantity: Quantity, each: int, at_most: int, rng: np.random.Generator
) -> tuple[NDArray[np.intp], NDArray[np.bool_]]:
    """Return the number of readings of each sampled loop, and whether its mean was known then.

    Args:
        known: Condition that ends the loop.
        quantity: Quantity that is read.
        each: Readings a round; the condition is tested after each round.
        at_most: Largest number of readings.
        rng: Random generator of the readings.
    """
    values = np.clip(
        rng.normal(quantity.typical, quantity.spread, (DRAWS, at_most)), quantity.minimum, quantity.maximum
    )
    numbers = np.arange(1, at_most + 1)
    means = np.cumsum(values, axis=1) / numbers
    squares = np.cumsum((values - quantity.typical) ** 2, axis=1) - numbers * (means - quantity.typical) ** 2
    with np.errstate(divide="ignore", invalid="ignore"):
        deviations = np.sqrt(np.maximum(squares, 0.0) / (numbers - 1))
        factors = np.array([np.inf if n < 2 else t_quantile(n - 1) / np.sqrt(n) for n in range(1, at_most + 1)])
        widths = factors * deviations
    limits = np.vectorize(lambda mean: wanted_width(known, mean))(means)
    tested = (numbers >= max(2, known.at_least)) & ((numbers % each == 0) | (numbers == at_most))
    holds = (widths <= limits) & tested
    found = holds.any(axis=1)
    return np.where(found, holds.argmax(axis=1) + 1, at_most), found
