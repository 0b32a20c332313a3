"""A mission carried out four ways: previewed, simulated, replayed from its log, and as a tree of BehaviorTree.CPP.

``python tests/missions/agreement.py COUNT [FIRST]`` compares so many random missions and prints what came of them
(docs/plans.md). Every one agrees on the places, their order, and the captures.
"""

from __future__ import annotations

import sys
from collections import Counter, defaultdict, deque
from collections.abc import Iterator, Mapping, Sequence
from dataclasses import dataclass, field, replace
from functools import cache
from typing import Any, get_args

import numpy as np
from lxml import etree

from fieldhand import mission
from fieldhand.errors import NoPlaceError
from fieldhand.evaluation.log_replay import replay_log
from fieldhand.exchange.btcpp import write_tree
from fieldhand.execution.drivers.simulation.world import ActionFails, ScriptedEvent, TreeRef, World
from fieldhand.execution.guard import Guard
from fieldhand.forecast import visit_order
from fieldhand.forecast.conditions import ConditionInputs, evaluate
from fieldhand.forecast.mission_state import MissionState, Verdict, Visit, VisitChoice
from fieldhand.forecast.request_handler import ForecastHandler, OptionalWorkPolicy
from fieldhand.forecast.walk_branch import walk_branch as preview
from fieldhand.forecast.walk_steps import Walk
from fieldhand.forecast.working import begin_of, end_of, stretches_of
from fieldhand.places.context import Context
from fieldhand.places.reading_series import ReadingSeries, TakenReading
from fieldhand.places.resolution import resolve, resolve_one
from fieldhand.places.selector import Selector
from fieldhand.places.selectors import (
    SELECTORS,
    Beside,
    Bound,
    ByReading,
    DoneEarlier,
    Excluding,
    Farthest,
    Here,
    Marker,
    Nearest,
    Period,
    Rows,
    TopEarlier,
    TreeIs,
    UnionOf,
    WhereEarlier,
)
from fieldhand.robot.capabilities import capabilities_of
from fieldhand.robot.charging_document import ChargingDocument
from fieldhand.robot.loader import load_robot
from fieldhand.robot.model import RobotProfile
from fieldhand.site.drives import Drives
from fieldhand.site.earlier_missions import EarlierCapture, EarlierMission, EarlierMissions, EarlierValue
from fieldhand.site.model import Place, Site
from fieldhand.task.aggregates import Aggregate, CompareSeries, CountReadings, MeanKnown, SeriesCondition
from fieldhand.task.build import make_task
from fieldhand.task.codec import decode_parts
from fieldhand.task.conditions import AllOf, AnyOf, Compare, Condition, Not
from fieldhand.task.conditions import walk as condition_parts
from fieldhand.task.earlier import site_of, with_earlier
from fieldhand.task.frames import Constraints, Task
from fieldhand.task.plan import (
    Act,
    AnyOrder,
    ForEach,
    GoTo,
    If,
    Node,
    OptionalStep,
    Pace,
    Recharge,
    Repeat,
    StopMission,
    Try,
    Wait,
    WorkAlong,
    acts,
    walk,
)
from fieldhand.task.plan import (
    InOrder as Steps,
)
from fieldhand.task.results import Acted, Arrived, Decided, Dwelling, Dwelt, Ended, Event, Exited, Visiting, Worked
from fieldhand.task.watches import EventAbsent, EventBeyond, EventHolds, Watch, WatchCondition
from fieldhand.task.ways import Avoid, SlowNear
from support.missions.rechargeable import CHARGING
from support.missions.rig import approved
from support.missions.rig import husky as bare_husky
from support.missions.rig import orchard as bare_orchard
from support.missions.watched import EVENTS

#: What happens: kind ("drive", "capture", "failure", "wait"), id of the node, id of the place (of a wait the seconds).
Trace = list[tuple[str, str, str]]

#: Fails at some trees, and stands only where a try catches that.
FAILING = "read_co2"
#: Is on along a path.
SPRAY = "spray"
#: A drive of so many metres is none: a stretch begins where the one before ended.
NOTHING_M = 1e-6
QUANTITIES = {
    "read_co2": ("co2", "ppm", 420.0),
    "take_thermal_picture": ("canopy_temperature", "degC", 33.0),
    "read_ambient_temperature": ("ambient_temperature", "degC", 30.0),
}


@cache
def orchard() -> Site:
    """The orchard of the rig with a charger, and a hole in an aisle between two trees."""
    site = bare_orchard()
    markers = dict(site.markers)
    for name, x, y in (("charger", -5.0, 10.0), ("hole", 12.5, 7.5)):
        ((lat, lon),) = site.projection.lat_lon([(x, y)])
        markers[name] = Place(kind="marker", id=name, x=x, y=y, lat=lat, lon=lon)
    return replace(site, markers=markers)


@cache
def husky() -> RobotProfile:
    """The husky of the rig, which can recharge, detects events, and has the band sprayer of the tractor."""
    robot = bare_husky()
    (sprayer,) = (action for action in load_robot("tractor").actions if action.name == SPRAY)
    return replace(
        robot,
        energy=replace(robot.energy, charging=ChargingDocument.model_validate(CHARGING).charging()),
        actions=(*robot.actions, sprayer),
        events=EVENTS,
    )


@cache
def earlier() -> EarlierMissions:
    """Three earlier missions in the orchard, each with a reading of every quantity at every third tree or so."""
    rng = np.random.default_rng(21)
    made = []
    for day in (1, 2, 3):
        at = f"2026-06-0{day}T08:00:00+00:00"
        captures = [
            EarlierCapture(
                place=tree.place.id,
                at=at,
                action=action,
                values=(EarlierValue(name=quantity, value=round(float(rng.normal(value, 2.0)), 2), unit=unit),),
            )
            for tree in orchard().trees
            for action, (quantity, unit, value) in QUANTITIES.items()
            if rng.random() < 0.35
        ]
        made.append(EarlierMission(id=f"m{day}", begun=at, captures=tuple(captures)))
    return EarlierMissions(as_of="2026-06-04T08:00:00+00:00", missions=tuple(made))


class Drawn:
    """A plan drawn by chance.

    Args:
        rng: Of every choice.
    """

    def __init__(self, rng: np.random.Generator) -> None:
        self._rng = rng
        self._trees = [tree.place.id for tree in orchard().trees]

    def plan(self) -> Node:
        return self._node(3, tried=False, optional=False, label="")

    def _chance(self, share: float) -> bool:
        return bool(self._rng.random() < share)

    def _tree(self) -> TreeIs:
        return TreeIs(tree=str(self._rng.choice(self._trees)))

    def _place(self, label: str, *, tried: bool) -> Selector:
        options: list[Selector] = [self._tree(), self._tree(), Nearest(to=Here()), Farthest(origin=Here())]
        if self._chance(0.2):
            options += [Beside(side="both" if self._chance(0.2) else "north", of=self._tree())]
        if label:
            options += [Bound(label=label), Nearest(to=Bound(label=label), adjacent=True)]
        if not tried and self._chance(0.15):  # a preview cannot go on without its place, as a try does
            return self._by_reading(1)
        return options[int(self._rng.integers(len(options)))]

    def _by_reading(self, count: int) -> ByReading:
        quantity = QUANTITIES[str(self._rng.choice(list(QUANTITIES)))][0]
        return ByReading(
            reading=str(self._rng.choice(["a", "b"])), quantity=quantity, count=count, lowest=self._chance(0.5)
        )

    def _by_records(self, of: Selector) -> Selector:
        """A choice by earlier missions, if it is not empty; else the group itself."""
        action = str(self._rng.choice(list(QUANTITIES)))
        quantity, unit, value = QUANTITIES[action]
        period = Period(last_missions=int(self._rng.integers(1, 4)))
        done = DoneEarlier(action=action, period=period)
        some: Selector
        match int(self._rng.integers(4)):
            case 0:
                some = Excluding(places=done, of=of)
            case 1:
                some = replace(done, of=of)
            case 2:
                some = TopEarlier(quantity=quantity, count=3, lowest=self._chance(0.5), period=period)
            case _:
                some = WhereEarlier(quantity=quantity, test="gt", value=value, unit=unit, period=period, of=of)
        try:
            found = resolve(some, orchard().with_earlier(earlier()), Context(here=orchard().start))
        except NoPlaceError:
            return of
        return some if found else of

    def _series_condition(self) -> Condition:
        quantity, unit, value = QUANTITIES[str(self._rng.choice(list(QUANTITIES)))]
        reading = str(self._rng.choice(["a", "b"]))
        value = round(value + float(self._rng.normal(0.0, value / 20)), 1)
        one = Compare(reading=reading, quantity=quantity, test="lt", value=value, unit=unit)
        match int(self._rng.integers(4)):
            case 0:
                return Aggregate(of=str(self._rng.choice(["mean", "median", "maximum"])), condition=one)  # type: ignore[arg-type]
            case 1:
                return CountReadings(test="ge", number=float(self._rng.integers(1, 4)), condition=one)
            case 2:
                return MeanKnown(reading=reading, quantity=quantity, percent=3.0, at_least=2)
            case _:
                than = "b" if reading == "a" else "a"
                return CompareSeries(of="mean", reading=reading, than=than, quantity=quantity, test="gt")

    def _condition(self, depth: int = 1) -> Condition:
        if self._chance(0.25):
            return self._series_condition()
        kind = int(self._rng.integers(4 if depth else 1))
        if kind == 1:
            return Not(condition=self._condition(depth - 1))
        if kind >= 2:
            both = (self._condition(depth - 1), self._condition(depth - 1))
            return AllOf(conditions=both) if kind == 2 else AnyOf(conditions=both)
        quantity, unit, value = QUANTITIES[str(self._rng.choice(list(QUANTITIES)))]
        value += float(self._rng.normal(0.0, value / 20))
        reading = str(self._rng.choice(["a", "b"]))
        return Compare(reading=reading, quantity=quantity, test="lt", value=round(value, 1), unit=unit)

    def _act(self, *, tried: bool, label: str) -> Act:
        fails = tried and self._chance(0.5)
        return Act(
            id="",
            action=FAILING if fails else str(self._rng.choice([a for a in QUANTITIES if a != FAILING])),
            at=self._place(label, tried=tried) if self._chance(0.6) else None,
            count=1 if fails else int(self._rng.integers(1, 4)),
            reading=str(self._rng.choice(["", "a", "b"])),
        )

    def _node(self, depth: int, *, tried: bool, optional: bool, label: str) -> Node:
        if depth == 0 or self._chance(0.15):
            if self._chance(0.15):
                return GoTo(id="", place=self._place(label, tried=tried))
            if self._chance(0.1):
                return Wait(id="", seconds=float(self._rng.integers(1, 90)))
            if self._chance(0.08):
                return Recharge(id="", duration_s=float(self._rng.integers(60, 600)))
            return self._act(tried=tried, label=label)

        def inner(*, also_tried: bool = False, also_optional: bool = False, named: str = "") -> Node:
            return self._node(
                depth - 1, tried=tried or also_tried, optional=optional or also_optional, label=named or label
            )

        match int(self._rng.integers(11)):
            case 0 | 1:
                return Steps(id="", steps=tuple(inner() for _ in range(int(self._rng.integers(1, 4)))))
            case 2:
                return AnyOrder(id="", steps=tuple(inner() for _ in range(int(self._rng.integers(1, 4)))))
            case 3 | 4:
                also = not optional and self._chance(0.3)
                return self._loop(inner, optional=also, tried=tried, named=f"t{depth}")
            case 5:
                until = self._condition() if self._chance(0.4) else None
                times = int(self._rng.integers(1, 4))
                return Repeat(id="", times=times, body=inner(), until=until, collects=self._collects())
            case 6:
                stop = StopMission(id="", exit="nominal" if self._chance(0.5) else "faulted")
                then = stop if self._chance(0.15) else inner()
                otherwise = inner() if self._chance(0.5) else None
                first = replace(self._act(tried=tried, label=label), reading="a")
                chosen = If(id="", condition=self._condition(), then=then, otherwise=otherwise)
                return Steps(id="", steps=(first, chosen))
            case 7:
                return Pace(id="", body=inner(), speed_m_s=float(self._rng.choice([0.3, 0.5, 0.9])))
            case 8 if not optional:
                return self._along()
            case 9:
                return Try(id="", body=inner(also_tried=True), otherwise=inner())
            case _:
                return inner() if optional else OptionalStep(id="", body=inner(also_optional=True))

    def _along(self) -> WorkAlong:
        rows = self._rng.permutation(["r0", "r1", "r2", "r3"])[: int(self._rng.integers(1, 4))].tolist()
        mode = str(self._rng.choice(["rows", "rows", "aisles", "headlands"])) if len(rows) > 1 else "rows"
        select = UnionOf(parts=tuple(Rows(first=row, last=row) for row in rows))
        return WorkAlong(
            id="",
            action=SPRAY if mode == "rows" and self._chance(0.6) else "",
            along=select if len(rows) > 1 else select.parts[0],
            mode=mode,  # type: ignore[arg-type]
            sides="both" if mode == "rows" and self._chance(0.3) else "one",
            order="given" if self._chance(0.3) else "best",
        )

    def constraints(self) -> Constraints:
        """Ground to keep away from, which closes an aisle between two trees, and ground to drive slowly on."""
        options: list[Selector] = [self._tree(), Rows(first="r1", last="r1"), Marker(name="end"), self._tree()]
        slow = tuple(
            SlowNear(
                places=options[k],
                distance_m=float(self._rng.choice([2.0, 5.0, 9.0])),
                speed_m_s=float(self._rng.choice([0.2, 0.4, 0.7])),
            )
            for k in self._rng.permutation(4)[: int(self._rng.integers(0, 3))].tolist()
        )
        avoid = (Avoid(places=Marker(name="hole"), distance_m=2.0),) if self._chance(0.3) else ()  # type: ignore[arg-type]
        return Constraints(avoid=avoid, slow=slow)

    def watches(self) -> tuple[Watch, ...]:
        """Events at which the robot waits or drives slowly, after which it goes on as before."""
        conditions: list[WatchCondition] = [
            EventHolds(event="person_near"),
            EventBeyond(event="wind", test="gt", value=5.0, unit="m/s"),
            EventAbsent(event="gate_closed"),
        ]
        return tuple(
            Watch(
                condition=conditions[k],
                response="slow" if self._chance(0.5) else "wait",
                at_most_s=float(self._rng.integers(5, 60)),
                fallback="go_on",
                speed_m_s=0.3 if self._chance(0.5) else None,
                during=FAILING if self._chance(0.2) else "",
            )
            for k in self._rng.permutation(3)[: int(self._rng.integers(0, 3))].tolist()
        )

    def happening(self) -> tuple[ScriptedEvent, ...]:
        """What the watches of a mission are for."""
        return (
            ScriptedEvent(event="person_near", chance=0.3, every_s=90, for_s=20),
            ScriptedEvent(event="wind", value=7.0, chance=0.2, every_s=120, for_s=30),
            ScriptedEvent(event="gate_closed", from_s=float(self._rng.integers(0, 40))),
        )

    def _collects(self) -> str:
        return "a" if self._chance(0.2) else ""

    def _loop(self, inner: Any, *, optional: bool, tried: bool, named: str) -> ForEach:
        names = self._rng.permutation(self._trees)[: int(self._rng.integers(1, 5))].tolist()
        near = self._chance(0.2) and not optional
        select: Selector = UnionOf(parts=tuple(TreeIs(tree=t) for t in names))
        if self._chance(0.2):
            select = Beside(side=str(self._rng.choice(["both", "north", "south"])), of=select)  # type: ignore[arg-type]
        if near:
            select = self._by_reading(2) if not tried and self._chance(0.5) else Nearest(to=Here(), count=2)
        elif self._chance(0.25):
            select = self._by_records(select)
        return ForEach(
            id="",
            select=select,
            body=inner(also_optional=optional, named=named),
            label=named,
            order="given" if not optional and self._chance(0.4) else "best",
            optional=optional,
            at_most=None if self._chance(0.7) else int(self._rng.integers(1, 4)),
            until=self._condition() if self._chance(0.2) else None,
            collects=self._collects(),
        )


@dataclass(frozen=True, kw_only=True)
class Done:
    """One time that an action was done.

    Attributes:
        captures: That succeeded.
        failed: Whether it failed then.
        readings: What each capture measured.
    """

    captures: int
    failed: bool
    readings: list[dict[str, float]]


@dataclass(frozen=True, kw_only=True)
class Simulated:
    """A mission that came to its end as its plan has it.

    Attributes:
        chosen: The places that the guard chose of optional visits, each time that their for-each was reached; by node.
        taken: Whether the guard let an optional step be done, each time that it was reached; by node.
    """

    task: Task
    events: tuple[Event, ...]
    chosen: Mapping[str, Sequence[Sequence[Place]]]
    taken: Mapping[str, Sequence[bool]]

    @property
    def trace(self) -> Trace:
        found: Trace = []
        seconds = 0.0
        for event in self._of_plan():
            if isinstance(event, Arrived) and event.kind == "point" and event.leg_m < NOTHING_M:
                continue
            if isinstance(event, Arrived):
                found.append(("drive", event.node, event.place))
            elif isinstance(event, Dwelling):
                seconds = event.seconds
            elif isinstance(event, Dwelt):
                found.append(("wait", event.node, f"{seconds:.3f}"))  # an event may prolong it
            elif isinstance(event, Worked) and event.status == "success":
                found.append(("work", event.node, event.stretch))
            elif isinstance(event, Acted) and event.status == "success":
                found.append(("capture", event.node, event.place))
            elif isinstance(event, Acted):
                failure = ("failure", event.node, event.place)
                # A capture that is tried again fails once.
                if event.attempt == 1:
                    found.append(failure)
        return found

    @property
    def decisions(self) -> dict[str, deque[bool]]:
        """Return the result of each condition, in its order, by node."""
        found: dict[str, deque[bool]] = defaultdict(deque)
        for event in self._of_plan():
            if isinstance(event, Decided):
                found[event.node].append(event.holds)
        return found

    @property
    def work(self) -> dict[str, deque[Done]]:
        """Each time that an action was done, by node."""
        counts = {act.id: act.count for act in acts(self.task.composition.plan)}
        found: dict[str, deque[Done]] = defaultdict(deque)
        made: dict[str, list[dict[str, float]]] = defaultdict(list)
        for event in self._of_plan():
            if not isinstance(event, Acted) or (event.status == "failed" and event.attempt > 1):
                continue
            failed = event.status == "failed"
            if not failed:
                made[event.node].append(dict(event.readings))
            if failed or len(made[event.node]) == counts[event.node]:
                readings = made.pop(event.node, [])
                found[event.node].append(Done(captures=len(readings), failed=failed, readings=readings))
        return found

    def _of_plan(self) -> Iterator[Event]:
        for event in self.events:
            if isinstance(event, Exited):
                return
            yield event


class _Watch:
    """A guard that notes what another chooses.

    Args:
        events: Of the mission, as it goes.
    """

    def __init__(self, events: list[Event]) -> None:
        self._events = events
        self.chosen: dict[str, list[list[Place]]] = defaultdict(list)
        self.taken: dict[str, list[bool]] = defaultdict(list)

    def over(self, guard: Guard) -> Guard:
        self._guard = guard
        return self

    def admit(self, state: MissionState, visit: Visit, still_to_come: Sequence[Visit] = ()) -> Verdict:
        return self._guard.admit(state, visit, still_to_come)

    def choose(
        self,
        state: MissionState,
        candidates: Sequence[Visit],
        *,
        at_most: int | None = None,
        still_to_come: Sequence[Visit] = (),
    ) -> VisitChoice:
        choice = self._guard.choose(state, candidates, at_most=at_most, still_to_come=still_to_come)
        if state.frames[-1].node.is_optional_step:
            self.taken[state.node].append(choice.index is not None)
            return choice
        runs = sum(isinstance(e, Visiting) and e.node == state.node for e in self._events)
        self.chosen[state.node] += [[] for _ in range(runs - len(self.chosen[state.node]))]
        if choice.index is not None:
            self.chosen[state.node][-1].append(candidates[choice.index].place)
        return choice

    def update_drives(self, drives: Drives) -> None:
        self._guard.update_drives(drives)


class AsChosen:
    """Takes the optional work that the guard of a mission has chosen."""

    def __init__(self, flight: Simulated) -> None:
        self._chosen = {node: deque(runs) for node, runs in flight.chosen.items()}
        self._taken = {node: deque(answers) for node, answers in flight.taken.items()}

    def visits(
        self,
        walker: ForecastHandler,
        node: ForEach | WorkAlong,
        places: tuple[Place, ...],
        closed: tuple[Place, ...],
        stretches: tuple[Visit, ...] = (),
    ) -> tuple[Place, ...]:
        return self.next(node.id)

    def next(self, node: str) -> tuple[Place, ...]:
        """The visits of a for-each that is reached once more."""
        return tuple(self._chosen[node].popleft())

    def takes(self, walker: ForecastHandler, node: OptionalStep) -> bool:
        taken = self._taken.get(node.id)
        return taken.popleft() if taken else False  # a step that cannot be reached is not offered to the guard


def simulated(seed: int) -> Simulated:
    """The first mission of a seed that ends as its plan says."""
    robot, site = husky(), orchard()
    for attempt in range(100):
        rng = np.random.default_rng([18, seed, attempt])
        drawn = Drawn(rng)
        task = make_task(
            request="a test",
            plan=drawn.plan(),
            measures={},
            nominal=str(rng.choice(["return_to_start", "return_to_end", "stay"])),  # type: ignore[arg-type]
            constraints=drawn.constraints(),
            watches=drawn.watches(),
        )
        task = with_earlier(task, earlier())
        bad = rng.permutation([t.place.id for t in site.trees])[:7].tolist()
        faults = tuple(ActionFails(action=FAILING, at=TreeRef(id=tree)) for tree in bad)
        world = World(faults=faults, events=drawn.happening())
        events: list[Event] = []
        watch = _Watch(events)
        mission.simulate(
            approved(task, site, robot),
            world=world,
            seed=seed,
            speed=None,
            emit=events.append,
            watched=watch.over,
        )
        stopped = any(isinstance(e, Exited) and e.node for e in events)
        if stopped or any(isinstance(e, Ended) and e.status == "completed" for e in events):
            return Simulated(task=task, events=tuple(events), chosen=watch.chosen, taken=watch.taken)
    raise AssertionError(f"no mission of seed {seed} ends as its plan says")


def previewed(flight: Simulated, optional: OptionalWorkPolicy | None) -> Walk:
    """The preview of the branch that a mission took, with the optional work as given, or as it is forecast."""
    decisions, work, read = flight.decisions, flight.work, flight.work
    return preview(
        flight.task,
        orchard(),
        husky(),
        holds=lambda node: decisions[node].popleft(),
        fails=lambda node: bool(work[node]) and work[node].popleft().failed,
        measured=lambda node: read[node].popleft().readings,
        optional=optional,
    )


def trace_of(walked: Walk) -> Trace:
    """Return the events of a preview."""
    found: Trace = []
    for step in walked.steps:
        if step.kind == "drive" and step.drive is not None:
            if step.places[0].kind == "point" and step.drive.length_m < NOTHING_M:
                continue  # as the robot's trace
            found.append(("drive", step.node.id, step.places[0].id))
        elif step.kind == "work" and step.stretch is not None:
            found.append(("work", step.node.id, step.stretch.name))
        elif step.kind == "wait":
            found.append(("wait", step.node.id, f"{step.seconds:.3f}"))
        elif step.kind == "act" and step.node.act is not None:
            place = step.places[0].id
            found += [("capture", step.node.id, place)] * step.captures
            found += [("failure", step.node.id, place)] * (step.captures < step.node.act.count)
    return found


@dataclass
class Interpreter:
    """A robot that ticks an exported tree: the control nodes as BehaviorTree.CPP documents them, and the leaves.

    Args:
        flight: Says what its captures come to.
            The tree asks the budget about optional visits; their order is the robot's own.
    """

    flight: Simulated
    trace: Trace = field(default_factory=list)
    _entries: dict[str, Any] = field(default_factory=dict)
    _readings: dict[str, dict[str, float]] = field(default_factory=dict)
    _series: dict[str, ReadingSeries] = field(default_factory=dict)

    def __post_init__(self) -> None:
        self._task = self.flight.task
        robot, site = husky(), site_of(self._task, orchard())
        self._site = site
        self._work = self.flight.work
        self._optional = AsChosen(self.flight)
        self._drives = visit_order.drives_for(site, robot, self._task.constraints)
        self._context = Context(here=visit_order.start_place(self._drives))
        self._tree = etree.fromstring(write_tree(self._task, capabilities_of(robot)))[0]
        self._tested = self._conditions()

    def run(self) -> Trace:
        self._tick(self._tree[0])
        return self.trace

    def _conditions(self) -> dict[Any, Condition]:
        """The condition of each leaf that tests one: they stand in the order of the plan's."""
        written: dict[str, list[Any]] = defaultdict(list)
        for element in self._tree.iter("CompareReading"):
            written[_node(element)].append(element)
        found = {}
        for node in walk(self._task.composition.plan):
            parts = () if node.tested is None else tuple(condition_parts(node.tested))
            inner = {id(part.condition) for part in parts if isinstance(part, Aggregate | CountReadings)}
            leaves = [part for part in parts if isinstance(part, Compare) and id(part) not in inner]
            found.update(zip(written[node.id], leaves, strict=True))
        return found

    def _tick(self, element: Any) -> bool | None:
        """True for success, False for failure, None where it is skipped."""
        for key, answer in (("_failureIf", False), ("_successIf", True), ("_skipIf", None)):
            if key in element.attrib and self._holds(element.get(key)):
                return answer
        match element.tag:
            case "Sequence":
                return all(self._tick(child) is not False for child in element)
            case "Fallback":
                return any(self._tick(child) for child in element)
            case "IfThenElse":
                return self._tick(element[1] if self._tick(element[0]) else element[2])
            case "Inverter":
                return not self._tick(element[0])
            case "ForceSuccess":
                self._tick(element[0])
                return True
            case "Repeat":
                return all(self._tick(element[0]) is not False for _ in range(int(element.get("num_cycles"))))
            case "LoopString" | "LoopInt":
                return all(self._loops(element))
            case "Script":
                name, value = element.get("code").split(" := ")
                self._entries[name] = {"true": True, "false": False}.get(value, value.strip("'"))
                return True
            case "AlwaysSuccess" | "BeginMission" | "TakeExit" | "HandleFault" | "BudgetAllows":
                return True
            case "AlwaysFailure":
                return False
        return self._leaf(element)

    def _loops(self, element: Any) -> Iterator[bool]:
        for value in self._entries[_entry(element.get("queue"))]:
            self._entries[_entry(element.get("value"))] = value
            yield self._tick(element[0]) is not False

    def _holds(self, code: str) -> bool:
        name, _, value = code.partition(" != ")
        found = self._entries[name]
        return bool(found) if not value else str(found) != value.strip("'")

    def _leaf(self, element: Any) -> bool:
        match element.tag:
            case "GoToPlace":
                self._go(element)
            case "LimitSpeed":
                return self._tick(element[0]) is not False
            case "Wait":
                self.trace.append(("wait", _node(element), f"{float(element.get('wait_duration')):.3f}"))
            case "WorkAlong":
                self._work_along(element)
            case "RechargeBattery":
                self._drive(element, orchard().markers["charger"])
            case "ResolvePlaces":
                self._series.pop(element.get("collects", ""), None)
                self._entries[_entry(element.get("places"))] = self._resolved(element)
            case "OrderSteps":
                self._entries[_entry(element.get("order"))] = self._ordered(element)
            case "CompareReading":
                return self._truth(element, self._tested[element])
            case "TestReadings":
                return self._truth(element, decode_parts(element.get("condition"), get_args(SeriesCondition))[0])
            case "BeginReadings":
                self._series.pop(element.get("reading"), None)
            case _:
                return self._acts(element)
        return True

    def _work_along(self, element: Any) -> None:
        robot, site = husky(), orchard()
        work = replace(decode_parts(element.get("work"), (WorkAlong,))[0], id=_node(element))
        context = replace(self._context, series=self._series)
        for stretch in stretches_of(work, self._task, site, robot, self._drives, context):
            self._drive(element, begin_of(stretch, site))
            self.trace.append(("work", work.id, stretch.name))
            self._context = replace(self._context, here=end_of(stretch, site))

    def _truth(self, element: Any, condition: Condition) -> bool:
        facts = ConditionInputs(
            site=self._site, robot=husky(), here=self._context.here, readings=self._readings, series=self._series
        )
        truth = evaluate(condition, facts).truth
        return element.get("if_unknown") == "true" if truth is None else truth

    def _go(self, element: Any) -> None:
        wanted = element.get("place")
        place = self._entries[_entry(wanted)] if wanted.startswith("{") else self._place(wanted)
        self._drive(element, place)

    def _drive(self, element: Any, place: Place) -> None:
        here, visited, bound = self._context.here, self._context.visited, self._context.bound
        if not here.covers(place):
            here = self._drives.between(here, place).end
            if here.kind != "point" or self._drives.between(self._context.here, here).length_m >= NOTHING_M:
                self.trace.append(("drive", _node(element), here.id))
        if here.kind == "tree" and here.id not in set(visited):
            visited = (*visited, here.id)
        if label := element.get("label"):
            bound = {**bound, label: (here,)}
        self._context = Context(here=here, visited=visited, bound=bound)

    def _place(self, text: str) -> Place:
        return resolve_one(_selectors(text)[0], self._site, replace(self._context, series=self._series))

    def _resolved(self, element: Any) -> tuple[Place, ...]:
        node, context = _node(element), replace(self._context, series=self._series)
        if element.get("optional") == "true":
            return self._optional.next(node)
        loop = ForEach(
            id=node,
            select=_selectors(element.get("select"))[0],
            body=StopMission(id=""),
            order=element.get("order", "best"),
            at_most=int(element.get("at_most")) if "at_most" in element.attrib else None,
        )
        places = visit_order.places_of(loop, loop.select, self._site, context)
        home = visit_order.home_if_last(self._task, orchard(), node, self._context.here)
        return visit_order.visits_in_order(loop, self._drives, self._context.here, places, home)

    def _ordered(self, element: Any) -> tuple[int, ...]:
        node = next(n for n in walk(self._task.composition.plan) if n.id == _node(element))
        home = visit_order.home_if_last(self._task, orchard(), node.id, self._context.here)
        context = replace(self._context, series=self._series)
        order = visit_order.steps_in_order(node, self._site, self._drives, context, home)  # type: ignore[arg-type]
        return tuple(k + 1 for k in order)

    def _acts(self, element: Any) -> bool:
        node, reading = _node(element), element.get("reading", "").removeprefix("{reading_").removesuffix("}")
        self._readings.pop(reading, None)
        work = self._work[node].popleft()
        self.trace += [("capture", node, self._context.here.id)] * work.captures
        for values in work.readings if reading else ():
            taken = TakenReading(place=self._context.here, values=values)
            self._series[reading] = self._series.get(reading, ReadingSeries()).plus(taken)
        if work.failed:
            self.trace.append(("failure", node, self._context.here.id))
            return False
        assert work.captures == int(element.get("count", "1"))
        if reading:
            self._readings[reading] = work.readings[-1]
        return True


def _entry(port: str) -> str:
    return port.strip("{}")


def _node(element: Any) -> str:
    """The id of the plan node that an element belongs to."""
    while element.get("name") is None:
        element = element.getparent()
    return str(element.get("name"))


@cache
def _selectors(text: str) -> tuple[Selector, ...]:
    return decode_parts(text, SELECTORS)


def disagreements(flight: Simulated) -> list[str]:
    """Return the differences between the four ways of carrying out a mission."""
    robot, found = flight.trace, list[str]()
    walked = previewed(flight, AsChosen(flight))
    if trace_of(walked) != robot:
        found.append(f"the preview {_differs(trace_of(walked), robot)}")
    tree = Interpreter(flight=flight)
    if tree.run() != robot:
        found.append(f"the tree {_differs(tree.trace, robot)}")
    return found + _of_replay(flight, walked)


def _of_replay(flight: Simulated, walked: Walk) -> list[str]:
    """Return the differences between a replay's counts and the robot's; steps cut off by a failure are wanted."""
    tallies = replay_log(flight.task.composition.plan, flight.events)
    wanted: Counter[str] = Counter()
    for step in walked.steps:
        if step.kind == "act" and step.node.act is not None:
            wanted[step.node.id] += step.node.act.count
        elif step.kind == "work":
            wanted[step.node.id] += 1
    done = Counter(node for kind, node, _ in flight.trace if kind in ("capture", "work"))
    failed = Counter(node for kind, node, _ in flight.trace if kind == "failure")
    found = []
    for name, tally in tallies.items():
        counted = (tally.done, tally.seen, tally.failed)
        whole = bool(failed) or (tally.wanted == wanted[name] and not tally.open)
        if counted != (done[name], done[name], failed[name]) or not whole:
            found.append(f"the replay counts {counted} of {tally.wanted} of {name}, and not {done[name]}")
    return found


def _differs(one: Trace, robot: Trace) -> str:
    for number, (a, b) in enumerate(zip(one, robot, strict=False)):
        if a != b:
            return f"has {a} where the robot has {b}, as event {number + 1}"
    return f"has {len(one)} events, the robot {len(robot)}"


def main(arguments: Sequence[str]) -> int:
    """Compare missions and print how many disagree."""
    count, first = int(arguments[0]), int(arguments[1]) if len(arguments) > 1 else 0
    wrong = otherwise = nodes = events = failures = optional = 0
    for seed in range(first, first + count):
        flight = simulated(seed)
        found = disagreements(flight)
        for line in found:
            print(f"seed {seed}: {line}")
        wrong += bool(found)
        nodes += sum(1 for _ in walk(flight.task.composition.plan))
        events += len(flight.trace)
        failures += any(kind == "failure" for kind, _, _ in flight.trace)
        if flight.chosen or flight.taken:
            optional += 1
            otherwise += trace_of(previewed(flight, None)) != flight.trace
    print(f"{count} missions, {nodes} nodes, {events} drives, captures and failures: {wrong} disagree")
    print(f"{failures} with failures; {optional} with optional work, of which {otherwise} were forecast otherwise")
    return 1 if wrong else 0


if __name__ == "__main__":
    sys.exit(main(sys.argv[1:]))
