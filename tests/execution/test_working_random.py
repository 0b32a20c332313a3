"""Any work along paths ends in order, in any world, under any guard, and never with an implement on."""

from __future__ import annotations

from itertools import count, pairwise

from hypothesis import HealthCheck, given, settings
from hypothesis import strategies as st

from execution.test_random_missions import TIMES, TREES, Moody
from fieldhand.evaluation.outcome import judge
from fieldhand.execution.drivers.simulation.world import (
    ActionFails,
    BatteryDrains,
    Blocked,
    DriveFails,
    LocalisationLost,
    RobotStops,
    World,
)
from fieldhand.task.event_lines import from_json, to_json
from fieldhand.task.plan import InOrder, WorkAlong
from fieldhand.task.results import Ended, Worked, Working
from support.examples import examples
from support.missions.rig import Rig, of_type, task_for
from support.missions.working import along, tractor

faults = st.one_of(
    st.builds(ActionFails, action=st.sampled_from(("spray", "mow", "film")), times=TIMES, at=st.none() | TREES),
    st.builds(Blocked, at=TREES, within_m=st.floats(0.1, 8), times=TIMES),
    st.builds(Blocked, between=st.tuples(TREES, TREES), within_m=st.floats(0.1, 4), from_s=st.floats(0, 99)),
    st.builds(DriveFails, times=TIMES, at=st.none() | TREES),
    st.builds(LocalisationLost, at_s=st.floats(0, 300), for_s=st.none() | st.floats(0, 100)),
    st.builds(BatteryDrains, factor=st.floats(0.1, 500), from_s=st.floats(0, 99)),
    st.builds(RobotStops, at_s=st.floats(0, 500)),
)
worlds = st.builds(World, faults=st.lists(faults, max_size=3).map(tuple), charge_percent=st.floats(0.01, 100))
works = st.builds(
    along,
    *[st.sampled_from(("r0", "r1", "r2", "r3"))] * 2,
    action=st.sampled_from(("spray", "mow", "film", "")),
    mode=st.sampled_from(("rows", "rows", "aisles", "headlands", "area", "perimeter")),
    sides=st.sampled_from(("one", "both", "north")),
    laps=st.integers(1, 2),
    gaps=st.sampled_from(("on", "off")),
    order=st.sampled_from(("best", "given")),
    optional=st.booleans(),
)


@settings(max_examples=examples(40, thorough=250), deadline=None, suppress_health_check=[HealthCheck.too_slow])
@given(st.lists(works, min_size=1, max_size=3), worlds, st.lists(st.integers(0, 9), max_size=6), st.integers(0, 5))
def test_every_work_along_paths_ends_in_order(
    nodes: list[WorkAlong], world: World, moods: list[int], seed: int
) -> None:
    asked = count()
    enough = lambda: "enough" if next(asked) > 400 else None  # noqa: E731
    task = task_for(InOrder(steps=tuple(nodes)))
    rig = Rig(robot=tractor(alpha=0.5), world=world, guard=Moody(moods), seed=seed)
    result = rig.fly(task, interrupted=enough)
    events = result.events
    assert of_type(events, Ended) == [events[-1]]
    assert all(a.t <= b.t + 1e-9 for a, b in pairwise(events))
    begun = [event for event in events if isinstance(event, Working | Worked)]
    assert [type(event) for event in begun] == [Working, Worked] * (len(begun) // 2)
    assert [to_json(e) for event in events if (e := from_json(to_json(event))) is not None] == [*map(to_json, events)]
    judge(task, events)
