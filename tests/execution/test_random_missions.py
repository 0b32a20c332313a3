"""Any Task that can be written ends in order, in any world, under any guard."""

from __future__ import annotations

from collections.abc import Sequence
from dataclasses import replace
from itertools import count, pairwise

from hypothesis import HealthCheck, given, settings
from hypothesis import strategies as st

from fieldhand.errors import PlaceError
from fieldhand.execution.drivers.simulation.world import (
    ActionFails,
    BatteryDrains,
    Blocked,
    DriveFails,
    LocalisationLost,
    RobotStops,
    SensorAbsurd,
    SensorSilent,
    TreeRef,
    World,
)
from fieldhand.execution.guard import NoGuard
from fieldhand.forecast.mission_state import MissionState, Verdict, Visit, VisitChoice
from fieldhand.forecast.slow_ground import slow_ground
from fieldhand.forecast.visit_order import drives_for
from fieldhand.robot.capabilities import capabilities_of
from fieldhand.task.event_lines import from_json, to_json
from fieldhand.task.frames import Task
from fieldhand.task.plan import walk
from fieldhand.task.results import Acted, Arrived, Ended, EventBegan, Exited, Shed, Started
from fieldhand.testing.generated.tasks import Parts
from support.examples import examples
from support.missions.rig import Rig, husky, of_type, orchard


def with_possible_ways(task: Task) -> Task:
    """Return a Task without the places to avoid, or to pass slowly, if the orchard lacks one, as no approval allows."""
    site, robot = orchard(), husky()
    try:
        drives_for(site, robot, task.constraints)
        slow_ground(task.constraints, site, robot)
    except PlaceError:
        return replace(task, constraints=replace(task.constraints, avoid=(), only_gates=(), slow=()))
    return task


TASKS = Parts(capabilities_of(husky())).tasks().map(with_possible_ways)
TREES = st.sampled_from([t.place.id for t in orchard().trees]).map(lambda i: TreeRef(id=i))
TIMES = st.none() | st.integers(1, 3)

faults = st.one_of(
    st.builds(ActionFails, action=st.sampled_from(sorted(husky().action)), times=TIMES, at=st.none() | TREES),
    st.builds(SensorSilent, quantity=st.sampled_from(sorted(husky().quantity)), times=TIMES, at=st.none() | TREES),
    st.builds(SensorAbsurd, quantity=st.just("co2"), value=st.floats(), times=TIMES, at=st.none() | TREES),
    st.builds(Blocked, at=TREES, within_m=st.floats(0.1, 8), times=TIMES),
    st.builds(DriveFails, times=TIMES, at=st.none() | TREES),
    st.builds(Blocked, between=st.tuples(TREES, TREES), within_m=st.floats(0.1, 4), from_s=st.floats(0, 99)),
    st.builds(LocalisationLost, at_s=st.floats(0, 300), for_s=st.none() | st.floats(0, 100)),
    st.builds(LocalisationLost, at=TREES, for_s=st.none() | st.floats(0, 100), times=TIMES),
    st.builds(BatteryDrains, factor=st.floats(0.1, 500), from_s=st.floats(0, 99)),
    st.builds(RobotStops, at_s=st.floats(0, 500)),
)
worlds = st.builds(World, faults=st.lists(faults, max_size=3).map(tuple), charge_percent=st.floats(0.01, 100))


class Moody(NoGuard):
    """A guard that says what a list of numbers says, over and over."""

    def __init__(self, moods: Sequence[int]) -> None:
        self._moods, self._next = moods or [1], count()

    def _mood(self) -> int:
        return self._moods[next(self._next) % len(self._moods)]

    def admit(self, state: MissionState, visit: Visit, still_to_come: Sequence[Visit] = ()) -> Verdict:
        return Verdict(go=self._mood() > 0, reason="in a mood")

    def choose(
        self,
        state: MissionState,
        candidates: Sequence[Visit],
        *,
        at_most: int | None = None,
        still_to_come: Sequence[Visit] = (),
    ) -> VisitChoice:
        mood = self._mood()
        if mood == 0:
            return VisitChoice(index=None, reason="in a mood")
        return VisitChoice(index=mood % len(candidates), shed=tuple(range(min(mood // 5, len(candidates)))))


@settings(max_examples=examples(40, thorough=120), deadline=None, suppress_health_check=[HealthCheck.too_slow])
@given(TASKS, worlds, st.lists(st.integers(0, 9), max_size=6), st.integers(0, 5))
def test_every_mission_ends_in_order(task: Task, world: World, moods: list[int], seed: int) -> None:
    asked = count()
    # Fifty times fifty rounds are no harder than a few hundred ticks of them.
    enough = lambda: "enough" if next(asked) > 400 else None  # noqa: E731
    rig = Rig(robot=husky(alpha=0.5), world=world, guard=Moody(moods), seed=seed)
    result = rig.fly(task, interrupted=enough)
    events = result.events

    assert isinstance(events[0], Started)
    assert of_type(events, Ended) == [events[-1]]
    assert events[-1].status == result.status
    assert len(of_type(events, Exited)) >= 1
    assert all(a.t <= b.t + 1e-9 for a, b in pairwise(events))
    known = {node.id for node in walk(task.composition.plan)} | {""}
    assert {e.node for e in events} <= known
    assert result.spent.metres >= sum(e.leg_m for e in of_type(events, Arrived)) - 1e-6
    assert 0 <= events[-1].charge_percent <= 100
    for acted in of_type(events, Acted):
        if acted.status == "success":
            for name, value in acted.readings.items():
                assert husky().quantity[name].minimum <= value <= husky().quantity[name].maximum
    if result.status == "returned":
        assert any(not e.optional for e in of_type(events, Shed)) or of_type(events, EventBegan)
    again = [from_json(to_json(e)) for e in events]
    assert [to_json(e) for e in again if e is not None] == [to_json(e) for e in events]


@settings(max_examples=examples(10, thorough=25), deadline=None, suppress_health_check=[HealthCheck.too_slow])
@given(TASKS, worlds, st.integers(0, 5))
def test_every_mission_can_be_repeated(task: Task, world: World, seed: int) -> None:
    def lines() -> list[str]:
        asked = count()
        rig = Rig(robot=husky(alpha=0.5), world=world, seed=seed)
        return [to_json(e) for e in rig.fly(task, interrupted=lambda: "x" if next(asked) > 200 else None).events]

    assert lines() == lines()
