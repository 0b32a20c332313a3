"""Policies for the optional visits and steps of a walk: the most probable ones, or those selected by its answers."""

from __future__ import annotations

from collections.abc import Iterator, Mapping, Sequence
from dataclasses import replace
from typing import cast

import numpy as np

from fieldhand.errors import DriveFault
from fieldhand.forecast import visit_order
from fieldhand.forecast.expected_visits import ExpectedVisits, expected_visits
from fieldhand.forecast.mission_state import Visit
from fieldhand.forecast.optional_visits import OptionalVisits
from fieldhand.forecast.request_handler import ForecastHandler
from fieldhand.forecast.walk_steps import WalkStep
from fieldhand.site.model import Place
from fieldhand.task.plan import ForEach, OptionalStep, WorkAlong

#: Maximum number of optional visits on a walk that is to make them, if no simulation of them is available.
MAX_SCRIPTED_VISITS = 200


class LikelyOptionalWork:
    """Policy that makes the most probable visits, as many as missions make on average.

    Args:
        kept: Cache of the expected visits of walks with equal answers so far.
    """

    def __init__(self, kept: dict[object, ExpectedVisits]) -> None:
        self._kept = kept

    def visits(
        self,
        walker: ForecastHandler,
        node: ForEach | WorkAlong,
        places: tuple[Place, ...],
        closed: tuple[Place, ...],
        stretches: tuple[Visit, ...] = (),
    ) -> tuple[Place, ...]:
        if stretches or not places:
            return self._some(walker, node, stretches, closed)
        of_places = _visits(walker).of_places(cast("ForEach", node), places, walker.context)  # stretches come as visits
        return self._some(walker, node, of_places, closed)

    def takes(self, walker: ForecastHandler, node: OptionalStep) -> bool:
        try:
            visit = _visits(walker).of_step(node, walker.context)
        except DriveFault:
            here = walker.context.here
            never = next(iter(visit_order.first_places(node.body, walker.site, walker.context)), here)
            self._some(walker, node, [], (never,))
            return False
        return bool(self._some(walker, node, [visit], ()))

    def _some(
        self,
        walker: ForecastHandler,
        node: ForEach | OptionalStep | WorkAlong,
        visits: Sequence[Visit],
        closed: tuple[Place, ...],
    ) -> tuple[Place, ...]:
        """Return the visits most likely to fit the budgets."""
        if not visits:
            walker.note(WalkStep(node=node, kind="visit-list", context=walker.context, shed=closed))
            return ()
        samples = walker.samples
        key = (node.id, len(walker.steps), tuple(walker.decisions))
        found = self._kept.get(key)
        if found is None:
            # Branches that differ in readings but not in resource use have the same expected visits.
            state = (node.id, *_state(walker))
            found = self._kept.get(state)
            if found is None:
                rng = np.random.default_rng([0 if samples is None else samples.seed, len(walker.steps)])
                found = expected_visits(walker, node, visits, rng, self._kept.get(node.id))
            self._kept[key] = self._kept[state] = self._kept[node.id] = found
        walker.allowance = found.allowance
        step = WalkStep(node=node, kind="visit-list", context=walker.context, shed=(*found.shed, *closed))
        walker.note(replace(step, places=found.places, visit_forecast=found.visit_forecast))
        walker.sample_visits(found.preview, found.works, found.charged)
        return found.places


class ScriptedOptionalWork:
    """Policy that follows prescribed answers.

    Optional steps are taken if the walk's answers say so; optional visits are those of the sampled mission with the
    most or the fewest visits.

    Args:
        kept: Expected visits computed by walks under :class:`LikelyOptionalWork`.
    """

    def __init__(self, kept: Mapping[object, ExpectedVisits]) -> None:
        self._kept = kept

    def visits(
        self,
        walker: ForecastHandler,
        node: ForEach | WorkAlong,
        places: tuple[Place, ...],
        closed: tuple[Place, ...],
        stretches: tuple[Visit, ...] = (),  # noqa: ARG002
    ) -> tuple[Place, ...]:
        made = self._made(node, places, most=walker.decide(node, "taken"))
        walker.note(WalkStep(node=node, kind="visit-list", context=walker.context, places=made, shed=closed))
        return made

    def takes(self, walker: ForecastHandler, node: OptionalStep) -> bool:
        try:
            first = _visits(walker).of_step(node, walker.context).place
        except DriveFault:
            return False
        known = self._kept.get(node.id)
        takes = (known is None or bool(known.preview.visited.any())) and walker.decide(node, "taken")
        if takes:
            walker.note(WalkStep(node=node, kind="visit-list", context=walker.context, places=(first,)))
        return takes

    def _made(self, node: ForEach | WorkAlong, places: tuple[Place, ...], *, most: bool) -> tuple[Place, ...]:
        """Return the visits of the sampled mission with the most, or fewest; without samples all visits, or none."""
        known = self._kept.get(node.id)
        if known is None:
            return (places if node.at_most is None else places[: node.at_most])[:MAX_SCRIPTED_VISITS] if most else ()
        visits, by_id = known.preview.visits, {p.id: p for p in places}
        made = known.preview.stops(int(visits.argmax() if most else visits.argmin()))
        return tuple(by_id[name] for vertex in made if (name := known.ids[vertex - 1]) in by_id)


def _state(walker: ForecastHandler) -> Iterator[object]:
    """Yield everything that determines the further optional visits of missions."""
    context, spent = walker.context, walker.spent
    yield len(walker.steps), walker.allowance, walker.to_come()
    yield context.here, context.here.stand, tuple(context.visited), tuple(context.bound.items())
    yield tuple((frame.node.id, tuple((n.id, n.rounds) for n in frame.left)) for frame in walker.plan.frames)
    # Rounded, because sums of equal durations in another order differ in their last digits.
    yield tuple(round(amount, 6) for amount in (spent.metres, spent.seconds, spent.percent, spent.joules))
    if walker.samples is not None:
        yield walker.samples.metres.tobytes()


def _visits(walker: ForecastHandler) -> OptionalVisits:
    return OptionalVisits(walker.task, walker.site, walker.robot, walker.drives)
