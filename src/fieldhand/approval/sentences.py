"""A plan as numbered lines: one line a step, with what it comes to on this site."""

from __future__ import annotations

from collections.abc import Mapping
from dataclasses import dataclass, replace

from fieldhand.approval.clauses import say_act, say_condition
from fieldhand.approval.resolved import Found
from fieldhand.robot.model import RobotProfile
from fieldhand.site.model import Place, Site
from fieldhand.site.places.words import say_places, say_selector
from fieldhand.task.conditions import Condition
from fieldhand.task.frames import Task, Then
from fieldhand.task.plan import Act, AnyOrder, ForEach, GoTo, If, Node, Optional, Repeat, Sequence, Stop, Try
from fieldhand.task.selectors import Corners, Marker, Selector, TreeIs, Trees, is_single
from fieldhand.task.words import CORNERS, say_name, say_number

Names = dict[str, str]


@dataclass(frozen=True, kw_only=True)
class Line:
    """A line of a read-back.

    Attributes:
        number: Counted from 1 over the steps that do something; None for a line that only opens a branch.
        node: Id of the plan node; of a for-each with its one action on the same line, the for-each.
        indent: How deep it stands, from 0.
        also: Other nodes that the line speaks of.
    """

    number: int | None
    node: str
    indent: int
    text: str
    also: tuple[str, ...] = ()


def say_place(place: Place) -> str:
    """A place as the read-back calls it: "tree 81", "the end marker"."""
    if place.kind == "tree":
        return f"tree {place.id}"
    return say_marker(place.id) if place.kind == "marker" else place.id


def say_marker(name: str) -> str:
    """A marker in words."""
    return "the charger" if name == "charger" else f"the {say_name(name)} marker"


#: Optional visits that are less likely than this are named as those that go first, where they are no more than so many.
_SURE, _NAMED = 0.9, 6


def write_lines(task: Task, site: Site, robot: RobotProfile, found: Mapping[str, Found]) -> tuple[Line, ...]:
    """The plan and its nominal exit as lines.

    Args:
        task: What to say.
        site, robot: Where and with what.
        found: What each selector comes to, from :func:`fieldhand.approval.resolved.gather`.
    """
    writer = _Writer(robot, found)
    writer.node(task.composition.plan, 0)
    writer.step(task.composition.plan.id, 0, say_exit(task.composition.nominal, site))
    return tuple(writer.lines)


def say_exit(then: Then, site: Site) -> str:
    """What the mission does when it is over: "Return to the end marker."."""
    if then == "stay":
        return "Stay at the last place."
    wanted = "end" if then == "return_to_end" else "start"
    if wanted in site.markers:
        return f"Return to {say_marker(wanted)}."
    home = site.home(then, site.start)
    return f"Return to {say_place(home)} (the site has no {wanted} marker)."


@dataclass(frozen=True, kw_only=True)
class _Taken:
    """A reading: the step that took it, and whether the robot is still at that place."""

    step: int
    there: bool = True


class _Writer:
    """The lines written so far, and what earlier steps are called by later ones."""

    def __init__(self, robot: RobotProfile, found: Mapping[str, Found]) -> None:
        self.lines: list[Line] = []
        self._robot, self._found = robot, found
        self._number = 0
        #: What a label is called, and where a reading was taken.
        self._names: Names = {}
        self._taken: dict[str, _Taken] = {}
        self._moved = False

    def step(self, node: str, indent: int, text: str, also: tuple[str, ...] = ()) -> int:
        """Write a line with the next number."""
        self._number += 1
        self.lines.append(Line(number=self._number, node=node, indent=indent, text=_one_line(text), also=also))
        return self._number

    def _open(self, node: str, indent: int, text: str) -> None:
        self.lines.append(Line(number=None, node=node, indent=indent, text=_one_line(text)))

    def node(self, node: Node, indent: int) -> None:
        match node:
            case Sequence(steps=steps):
                for step in steps:
                    self.node(step, indent)
            case AnyOrder(steps=steps):
                self._open(node.id, indent, "In whichever order drives least:")
                for step in steps:
                    self.node(step, indent + 1)
            case ForEach():
                self._for_each(node, indent)
            case Repeat():
                self._repeat(node, indent)
            case If():
                self._if(node, indent)
            case Try():
                self._open(node.id, indent, "Try this:")
                self.node(node.body, indent + 1)
                self._open(node.id, indent, "If that fails:")
                self.node(node.otherwise, indent + 1)
            case Optional():
                self._optional(node, indent)
            case GoTo():
                number = self.step(node.id, indent, f"Drive to {self._at(node, node.place)}.")
                self._arrived(node.label, node.id, number)
            case Act():
                self._act(node, indent)
            case Stop(exit=taken):
                verdict = "" if taken == "nominal" else ", which counts as failed"
                self.step(node.id, indent, f"End the mission here{verdict}.")

    # --- actions and drives ------------------------------------------------------------------------------------

    def _act(self, node: Act, indent: int) -> None:
        doing = say_act(node, self._robot)
        if node.at is not None:
            number = self.step(node.id, indent, f"At {self._at(node, node.at)}: {doing}.")
            self._arrived(node.label, node.id, number)
        else:
            number = self.step(node.id, indent, f"{'There' if self._moved else 'At the start'}: {doing}.")
            self._name(node.label, node.id, number)
        self._took(node, number)

    def _at(self, node: Node, selector: Selector) -> str:
        """A place with what it was called in the Task, or the other way round where it is decided on the way."""
        said = say_selector(selector, self._names)
        found = self._found.get(node.id)
        one = found.one if found else None
        if one is not None:
            place = say_place(one)
            return place if isinstance(selector, TreeIs | Marker) else f"{place} ({_aside(selector, said)})"
        if found is None:
            return said
        if found.known:
            ids = say_places(tuple(p.id for visit in found.visits for p in visit))
            return f"{said} (in turn {ids})"
        return f"{said} (decided on the way; most likely {say_place(found.places[0])})"

    def _arrived(self, label: str, node: str, number: int) -> None:
        """The place in hand is a new one: readings taken before were taken elsewhere."""
        self._taken = {name: replace(taken, there=False) for name, taken in self._taken.items()}
        self._moved = True
        self._name(label, node, number)

    def _name(self, label: str, node: str, number: int) -> None:
        if label:
            found = self._found.get(node)
            one = found.one if found else None
            self._names[label] = say_place(one) if one is not None else f"the place of step {number}"

    def _took(self, node: Act, number: int) -> None:
        if node.reading:
            self._taken[node.reading] = _Taken(step=number)

    # --- loops and branches ------------------------------------------------------------------------------------

    def _for_each(self, node: ForEach, indent: int) -> None:
        head = f"{self._visits(node)}:"
        body = node.body
        single = isinstance(body, Act) and body.at is None
        number = self._number + 1
        self._arrived("", node.id, number)
        if node.label:
            self._names[node.label] = "that place"
        if isinstance(body, Act) and single:
            self.step(node.id, indent, f"{head} {say_act(body, self._robot)}.", (body.id,))
            self._name(body.label, body.id, number)
            self._took(body, number)
        else:
            self.step(node.id, indent, head)
            self.node(body, indent + 1)
        if node.until is not None:
            self._open(node.id, indent + 1, f"Leave out the rest once {self._condition(node.until)}.")
        self._arrived("", node.id, number)
        if node.label:
            self._names[node.label] = f"the last place of step {number}"

    def _visits(self, node: ForEach) -> str:
        """Which places a for-each goes to, and in which order."""
        found = self._found.get(node.id)
        places = (*found.places, *found.shed) if found else ()
        if is_single(node.select) and len(places) < 2:
            return f"At {self._at(node, node.select)}"
        whole = node.optional or node.at_most is None
        count = len(places) if found and found.known and places and whole else None
        said = say_selector(node.select, self._names, count)
        if isinstance(node.select, Trees):
            said = f"the {count} trees" if count else "all trees"
        if node.optional:
            return self._optional_visits(node, said, found)
        each = said if said.startswith("every ") else f"each of {said}"
        some = f"no more than {node.at_most} of {said}" if node.at_most is not None else each
        return f"At {some}{_which(node.select, found)}{_order(node, len(places))}"

    def _optional_visits(self, node: ForEach, said: str, found: Found | None) -> str:
        most = f", at most {node.at_most}" if node.at_most is not None else ""
        worth = f", preferring high {say_name(node.reward)}" if node.reward else ""
        return f"At as many of {said} as the budget allows{most}{worth}{_expected_visits(found)}"

    def _repeat(self, node: Repeat, indent: int) -> None:
        times = "twice" if node.times == 2 else f"{node.times} times"
        most = f"Do this up to {times}" if node.until is not None else f"Do this {times}"
        self._open(node.id, indent, f"{most}:" if node.times > 1 else "Do this once:")
        self.node(node.body, indent + 1)
        if node.until is not None:
            self._open(node.id, indent + 1, f"Leave out the rest once {self._condition(node.until)}.")

    def _optional(self, node: Optional, indent: int) -> None:
        worth = f", worth {say_number(node.reward)}" if node.reward != 1.0 else ""
        self._open(node.id, indent, f"If the budget allows{worth}{_expected(self._found.get(node.id))}:")
        names, taken, moved = self._names, self._taken, self._moved
        self._names, self._taken = dict(names), dict(taken)
        self.node(node.body, indent + 1)
        # What the step binds is known inside it alone; whether the robot has moved since a reading is not known.
        still = {name: t.there and self._taken[name].there for name, t in taken.items()}
        self._names, self._moved = names, moved
        self._taken = {name: replace(t, there=still[name]) for name, t in taken.items()}

    def _if(self, node: If, indent: int) -> None:
        self._open(node.id, indent, f"If {self._condition(node.condition)}:")
        names, taken, moved = dict(self._names), dict(self._taken), self._moved
        self.node(node.then, indent + 1)
        then_names, then_taken, then_moved = self._names, self._taken, self._moved
        self._names, self._taken, self._moved = names, taken, moved
        if node.otherwise is not None:
            self._open(node.id, indent, "Otherwise:")
            self.node(node.otherwise, indent + 1)
        # Whichever branch is taken: what only one of them did cannot be counted on.
        self._names = {**then_names, **self._names}
        self._moved = self._moved and then_moved
        both = {**then_taken, **self._taken}
        still = {n for n in both if all(t.get(n, both[n]).there for t in (then_taken, self._taken))}
        self._taken = {name: replace(taken, there=name in still) for name, taken in both.items()}

    def _condition(self, condition: Condition) -> str:
        where = {name: "there" if t.there else f"of step {t.step}" for name, t in self._taken.items()}
        return say_condition(condition, where, self._robot)


def _expected(found: Found | None) -> str:
    """Whether an optional step fits by the estimate; how often, where it comes up more than once."""
    if found is None:
        return ""
    fit, times = sum(bool(visit) for visit in found.visits), len(found.visits)
    if times > 1 and 0 < fit < times:
        return f" (about {fit} of {times} times by the estimate)"
    return " (by the estimate it does)" if fit else " (by the estimate it does not)"


def _expected_visits(found: Found | None) -> str:
    """How many optional visits are made on average, the chance of running short, and the few that go first."""
    if found is None or found.outlook is None:
        return ""
    total = len(found.places) + len(found.shed)
    said = f"{found.outlook.visits:.0f} of {total} expected, {100 * found.short:.0f} % chance of running short"
    doubtful = sorted((chance, place) for place, chance in found.outlook.chances.items() if chance < _SURE)
    if 0 < len(doubtful) <= _NAMED:
        kinds = {place.kind for place in (*found.places, *found.shed)}
        name = ("tree " if len(doubtful) == 1 else "trees ") if kinds == {"tree"} else ""
        goes = "goes" if len(doubtful) == 1 else "go"
        said += f"; {name}{say_places(tuple(place for _, place in doubtful))} {goes} first"
    return f" ({said})"


def _one_line(text: str) -> str:
    """Names of zones and trees come from files and may hold line ends."""
    return " ".join(text.split())


def _aside(selector: Selector, said: str) -> str:
    """What stands in brackets after a place: "north-west corner", "the tree farthest from tree 3"."""
    if isinstance(selector, Corners) and len(selector.which) == 1 and isinstance(selector.of, Trees):
        return f"{CORNERS[selector.which[0]]} corner"
    return said


def _which(selector: Selector, found: Found | None) -> str:
    """The places by name, where they are few and their names are not said yet."""
    if found is None:
        return ""
    ids = tuple(p.id for p in found.places)
    named = f"{say_places(ids)}" if len(ids) <= 12 else ""
    said = say_selector(selector)
    if found.known:
        return f" ({named})" if named and not all(i in said.split() for i in ids) else ""
    return f" (decided on the way; most likely {say_places(ids)})"


def _order(node: ForEach, count: int) -> str:
    if count < 2:
        return ""
    return ", in that order" if node.order == "given" else ", in the order that drives least"
