"""Numbered lines of a plan, one per step, with the places that it resolves to on the site."""

from __future__ import annotations

from collections.abc import Mapping
from dataclasses import dataclass, replace

from fieldhand.language import counted, message, shaped
from fieldhand.language.words import (
    capitalised,
    say_marker,
    say_name,
    say_number,
    say_side,
    say_times,
    say_tree,
    say_wait,
)
from fieldhand.places.selector import Selector
from fieldhand.places.selectors import Trees
from fieldhand.places.wording import SelectorWording, say_places, say_selector
from fieldhand.robot.model import RobotProfile
from fieldhand.site.model import Place, Site
from fieldhand.task.conditions import Condition
from fieldhand.task.frames import Task, Then
from fieldhand.task.plan import (
    Act,
    AnyOrder,
    ForEach,
    GoTo,
    If,
    InOrder,
    Node,
    OptionalStep,
    Pace,
    Recharge,
    Repeat,
    StopMission,
    Try,
    Wait,
    WorkAlong,
)
from fieldhand.wording.conditions import say_act, say_condition
from fieldhand.wording.recharging import say_recharge
from fieldhand.wording.resolved_places import ResolvedPlaces
from fieldhand.wording.step_places import in_order, say_expected, say_expected_visits, say_ids
from fieldhand.wording.watches import say_watch
from fieldhand.wording.working import say_extent, say_work

Names = dict[str, str]


@dataclass(frozen=True, kw_only=True)
class ReadBackLine:
    """A line of a read-back.

    Attributes:
        number: Step number from 1; None for a line that only introduces a branch.
        node: Id of the plan node; the for-each, if its only action is on the same line.
        indent: Nesting depth, from 0.
        also: Ids of other nodes described by the line.
    """

    number: int | None
    node: str
    indent: int
    text: str
    also: tuple[str, ...] = ()


def say_place(place: Place) -> str:
    """Return the name of a place in the read-back: "tree 81", "the end marker"."""
    if place.kind == "tree":
        return say_side(place.id, place.side) if place.side else say_tree(place.id)
    return say_marker(place.id) if place.kind == "marker" else place.id


def write_lines(
    task: Task, site: Site, robot: RobotProfile, resolved: Mapping[str, ResolvedPlaces]
) -> tuple[ReadBackLine, ...]:
    """Return the watched conditions, the plan and its nominal exit as lines.

    Args:
        task: Task to describe.
        site, robot: Site and robot of the mission.
        found: Resolved places of each node, from :func:`fieldhand.wording.resolved_places.gather`.
    """
    writer = _LineWriter(site, robot, resolved)
    writer.node(task.composition.plan, 0)
    watches = [
        ReadBackLine(number=None, node=task.composition.plan.id, indent=0, text=say_watch(watch, robot))
        for watch in task.composition.watches
    ]
    writer.step(task.composition.plan.id, 0, say_exit(task.composition.nominal, site))
    return (*watches, *writer.lines)


def say_exit(then: Then, site: Site) -> str:
    """Return the nominal end of the mission as a sentence: "Return to the end marker."."""
    if then == "stay":
        return message("Stay at the last place.")
    wanted = "end" if then == "return_to_end" else "start"
    if wanted in site.markers:
        return message("Return to {place}.", place=say_marker(wanted))
    home = say_place(site.home(then, site.start))
    if wanted == "end":
        return message("Return to {place} (the site has no end marker).", place=home)
    return message("Return to {place} (the site has no start marker).", place=home)


def say_exit_after(then: Then, site: Site) -> str:
    """Return the behaviour after a fault as the end of a sentence: "return to the end marker"."""
    if then == "stay":
        return message("stop and wait there")
    wanted = "end" if then == "return_to_end" else "start"
    if wanted in site.markers:
        return message("return to {place}", place=say_marker(wanted))
    home = say_place(site.home(then, site.start))
    if wanted == "end":
        return message("return to {place} (the site has no end marker)", place=home)
    return message("return to {place} (the site has no start marker)", place=home)


@dataclass(frozen=True, kw_only=True)
class _Taken:
    """A reading: the step that took it, and a flag that the robot is still at that place."""

    step: int
    there: bool = True


class _LineWriter:
    """Writes the lines, and tracks the names by which later steps refer to earlier ones."""

    def __init__(self, site: Site, robot: RobotProfile, resolved: Mapping[str, ResolvedPlaces]) -> None:
        self.lines: list[ReadBackLine] = []
        self._site = site
        self._robot, self._resolved = robot, resolved
        self._number = 0
        #: Description of each label, and the place of each reading.
        self._names: Names = {}
        self._taken: dict[str, _Taken] = {}
        self._moved = False

    def step(self, node: str, indent: int, text: str, also: tuple[str, ...] = ()) -> int:
        """Write a line with the next step number."""
        self._number += 1
        self.lines.append(
            ReadBackLine(number=self._number, node=node, indent=indent, text=shaped(text, _one_line), also=also)
        )
        return self._number

    def _open(self, node: str, indent: int, text: str) -> None:
        self.lines.append(ReadBackLine(number=None, node=node, indent=indent, text=shaped(text, _one_line)))

    def node(self, node: Node, indent: int) -> None:
        match node:
            case InOrder(steps=steps):
                for step in steps:
                    self.node(step, indent)
            case AnyOrder(steps=steps):
                self._open(node.id, indent, message("In the order with the least driving:"))
                for step in steps:
                    self.node(step, indent + 1)
            case ForEach():
                self._for_each(node, indent)
            case Repeat():
                self._repeat(node, indent)
            case If():
                self._if(node, indent)
            case Try():
                self._open(node.id, indent, message("Try this:"))
                self.node(node.body, indent + 1)
                self._open(node.id, indent, message("If that fails:"))
                self.node(node.otherwise, indent + 1)
            case OptionalStep():
                self._optional(node, indent)
            case GoTo():
                number = self.step(node.id, indent, message("Drive to {place}.", place=self._at(node, node.place)))
                self._arrived(node.label, node.id, number)
            case Act():
                self._act(node, indent)
            case Wait(seconds=seconds):
                time = say_wait(seconds)
                there = message("Wait there for {time}.", time=time)
                self.step(
                    node.id, indent, there if self._moved else message("Wait at the start for {time}.", time=time)
                )
            case Pace(body=body, speed_m_s=speed):
                self._open(
                    node.id, indent, message("Drive no faster than {speed} m/s for this:", speed=say_number(speed))
                )
                self.node(body, indent + 1)
            case WorkAlong():
                self._work(node, indent)
            case Recharge():
                self.step(node.id, indent, say_recharge(node, self._robot))
                self._arrived("", node.id, self._number)
            case StopMission(exit=taken):
                failed = message("End the mission here, which counts as failed.")
                self.step(node.id, indent, message("End the mission here.") if taken == "nominal" else failed)

    # --- actions and drives ------------------------------------------------------------------------------------

    def _act(self, node: Act, indent: int) -> None:
        doing = say_act(node, self._robot)
        if node.at is not None:
            number = self.step(
                node.id, indent, message("At {place}: {doing}.", place=self._at(node, node.at), doing=doing)
            )
            self._arrived(node.label, node.id, number)
        else:
            there = message("There: {doing}.", doing=doing), message("At the start: {doing}.", doing=doing)
            number = self.step(node.id, indent, there[0] if self._moved else there[1])
            self._name(node.label, node.id, number)
        self._took(node, number)

    def _work(self, node: WorkAlong, indent: int) -> None:
        text = shaped(say_work(node, self._robot, self._names), capitalised)
        extent = say_extent(node, self._robot, self._resolved.get(node.id))
        number = self.step(node.id, indent, message("{work} {extent}.", work=text, extent=extent))
        self._arrived("", node.id, number)

    def _at(self, node: Node, selector: Selector) -> str:
        """Return a resolved place with its wording in the Task, or the reverse if it is decided during the mission."""
        text = say_selector(selector, self._names)
        resolved = self._resolved.get(node.id)
        one = resolved.one if resolved else None
        if one is not None:
            place = say_place(one)
            aside = selector.aside(text)
            return message("{place} ({words})", place=place, words=aside) if aside else place
        if selector.decided_by_readings:
            return message("{place} (decided on the way by the readings)", place=text)
        if resolved is None:
            return text
        if resolved.known:
            ids = say_places(tuple(p.id for visit in resolved.visits for p in visit))
            return message("{place} (in turn {ids})", place=text, ids=ids)
        likely = say_place(resolved.places[0])
        return message("{place} (decided on the way; most likely {likely})", place=text, likely=likely)

    def _arrived(self, label: str, node: str, number: int) -> None:
        """Register a new current place, so that earlier readings count as taken elsewhere."""
        self._taken = {name: replace(taken, there=False) for name, taken in self._taken.items()}
        self._moved = True
        self._name(label, node, number)

    def _name(self, label: str, node: str, number: int) -> None:
        if label:
            resolved = self._resolved.get(node)
            one = resolved.one if resolved else None
            self._names[label] = (
                say_place(one) if one is not None else message("the place of step {number}", number=number)
            )

    def _took(self, node: Act, number: int) -> None:
        if node.reading:
            self._taken[node.reading] = _Taken(step=number)

    # --- loops and branches ------------------------------------------------------------------------------------

    def _for_each(self, node: ForEach, indent: int) -> None:
        head = self._visits(node)
        body = node.body
        single = isinstance(body, Act) and body.at is None
        number = self._number + 1
        self._arrived("", node.id, number)
        if node.label:
            self._names[node.label] = message("that place")
        if isinstance(body, Act) and single:
            doing = say_act(body, self._robot)
            self.step(node.id, indent, message("{at_places}: {doing}.", at_places=head, doing=doing), (body.id,))
            self._name(body.label, body.id, number)
            self._took(body, number)
        else:
            self.step(node.id, indent, message("{at_places}:", at_places=head))
            self.node(body, indent + 1)
        if node.until is not None:
            self._open(
                node.id,
                indent + 1,
                message("Leave out the rest once {condition}.", condition=self._condition(node.until)),
            )
        self._arrived("", node.id, number)
        if node.label:
            self._names[node.label] = message("the last place of step {number}", number=number)

    def _visits(self, node: ForEach) -> str:
        """Return the places that a for-each visits, with their order."""
        resolved = self._resolved.get(node.id)
        places = (*resolved.places, *resolved.shed) if resolved else ()
        if node.select.single and len(places) < 2:
            return message("At {place}", place=self._at(node, node.select))
        whole = node.optional or node.at_most is None
        count = len(places) if resolved and resolved.known and places and whole else None
        phrase = SelectorWording(self._names).phrase(node.select)
        text = phrase.say(count)
        if node.select == Trees():
            text = counted("the {count} tree", "the {count} trees", count) if count else message("all trees")
        if node.optional:
            return self._optional_visits(node, text, resolved)
        if node.at_most is not None:
            at = message("At no more than {count} of {trees}", count=node.at_most, trees=text)
        elif phrase.listed:
            at = message("At {place}", place=text)
        elif phrase.every or (phrase.plain and count is None):
            at = message("At {every_tree}", every_tree=text)
        else:
            at = message("At each of {trees}", trees=text)
        return in_order(
            node,
            message("{at_places} {ids}", at_places=at, ids=say_ids(node.select, resolved, self._site)),
            len(places),
        )

    def _optional_visits(self, node: ForEach, text: str, resolved: ResolvedPlaces | None) -> str:
        at = message("At as many of {trees} as the budget allows", trees=text)
        if node.at_most is not None:
            at = message("{at_places}, at most {count}", at_places=at, count=node.at_most)
        if node.reward and node.reward_by != "value":
            at = self._best_first(node, at)
        elif node.reward:
            at = message("{at_places}, preferring high {reward}", at_places=at, reward=say_name(node.reward))
        return message("{at_places} {expected}", at_places=at, expected=say_expected_visits(resolved))

    def _best_first(self, node: ForEach, at: str) -> str:
        named = say_name(node.reward)
        if node.reward_by == "lowest":
            return message(
                "{at_places}, those with the lowest {attribute} first (worth most)", at_places=at, attribute=named
            )
        return message(
            "{at_places}, those with the highest {attribute} first (worth most)", at_places=at, attribute=named
        )

    def _repeat(self, node: Repeat, indent: int) -> None:
        times = say_times(node.times)
        most = message("Do this up to {times}:", times=times), message("Do this {times}:", times=times)
        self._open(node.id, indent, most[0] if node.until is not None and node.times > 1 else most[1])
        self.node(node.body, indent + 1)
        if node.until is not None:
            self._open(
                node.id,
                indent + 1,
                message("Leave out the rest once {condition}.", condition=self._condition(node.until)),
            )

    def _optional(self, node: OptionalStep, indent: int) -> None:
        expected = say_expected(self._resolved.get(node.id))
        if node.reward == 1.0:
            head = message("If the budget allows {expected}:", expected=expected)
        else:
            worth = say_number(node.reward)
            head = message("If the budget allows, worth {worth} {expected}:", worth=worth, expected=expected)
        self._open(node.id, indent, head)
        names, taken, moved = self._names, self._taken, self._moved
        self._names, self._taken = dict(names), dict(taken)
        self.node(node.body, indent + 1)
        # Names bound inside an optional step are valid only there; afterwards the robot may or may not have moved.
        still = {name: t.there and self._taken[name].there for name, t in taken.items()}
        self._names, self._moved = names, moved
        self._taken = {name: replace(t, there=still[name]) for name, t in taken.items()}

    def _if(self, node: If, indent: int) -> None:
        self._open(node.id, indent, message("If {condition}:", condition=self._condition(node.condition)))
        names, taken, moved = dict(self._names), dict(self._taken), self._moved
        self.node(node.then, indent + 1)
        then_names, then_taken, then_moved = self._names, self._taken, self._moved
        self._names, self._taken, self._moved = names, taken, moved
        if node.otherwise is not None:
            self._open(node.id, indent, message("Otherwise:"))
            self.node(node.otherwise, indent + 1)
        # After the branches, only what both of them established is certain.
        self._names = {**then_names, **self._names}
        self._moved = self._moved and then_moved
        both = {**then_taken, **self._taken}
        still = {n for n in both if all(t.get(n, both[n]).there for t in (then_taken, self._taken))}
        self._taken = {name: replace(taken, there=name in still) for name, taken in both.items()}

    def _condition(self, condition: Condition) -> str:
        where = {
            name: message("there", context="reading") if t.there else message("of step {number}", number=t.step)
            for name, t in self._taken.items()
        }
        series = {name: message("of step {number}", number=t.step) for name, t in self._taken.items()}
        return say_condition(condition, where, self._robot, series=series)


def _one_line(text: str) -> str:
    """Return the text on one line, since names of zones and trees come from files and may contain line breaks."""
    return " ".join(text.split())
