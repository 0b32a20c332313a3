"""Conditions: "if that reading is below 33 °C", "if the CO2 at tree 4 is low", "if the tree is yellow"."""

from __future__ import annotations

from collections.abc import Sequence
from dataclasses import dataclass, replace

from fieldhand.language import Number, joined, message, named
from fieldhand.language.words import listed, say_name, say_unit
from fieldhand.planning.english.asking import choices_of_actions
from fieldhand.planning.english.attributes import OPPOSITE, hinted, number_of
from fieldhand.planning.english.draft import DraftCapture
from fieldhand.planning.english.faults import Question, text_of, unclear
from fieldhand.planning.english.kinds import RELATIONS
from fieldhand.planning.english.naming import Naming
from fieldhand.planning.english.tokens import Term
from fieldhand.robot.model import RobotProfile
from fieldhand.site.model import Site
from fieldhand.task import conditions as c

_SUBJECT = frozenset({"NOUN", "ORD", "LAST"})
#: Words of a condition that say which reading is meant, or nothing.
_AROUND = frozenset(
    {"DET", "IT", "IS", "WHICH", "STILL", "OF", "READING", "THANEQ", "THERE", "PLACE", "FOR", "AT", "FROM"}
)
_PREDICATE = frozenset({"IS", "ISNOT", "NOT", "CMP", "LEVEL", "BETWEEN", "STILL", "ATTRVAL", "SUPER"})
_HERE = frozenset({"DET", "IT", "TREE", "PLACE", "THERE", "NOUN", "READING", "ORD", "LAST"})
_TEMPERATURE_WORDS = ("hot", "warm", "cold", "cool")


@dataclass(frozen=True, kw_only=True)
class Predicate:
    """One comparison of a condition.

    Attributes:
        made: The comparison, its reading and quantity still unnamed; whole for an attribute of the tree.
        capture: The capture whose reading it tests; None for an attribute, or if nothing measured it yet.
        missing: Action that must be done first, where nothing measured it yet.
        quantity: What is compared.
    """

    made: c.Condition
    negated: bool = False
    capture: DraftCapture | None = None
    missing: str = ""
    quantity: str = ""

    def condition(self, reading: str) -> c.Condition:
        """The condition on a reading of that name."""
        made = self.made
        if isinstance(made, c.Compare | c.Between | c.Level):
            made = replace(made, reading=reading, quantity=self.quantity)
        return c.Not(condition=made) if self.negated else made


@dataclass(frozen=True, kw_only=True)
class Tested:
    """What a condition tests: all of its predicates, or any of them; ``place`` holds the terms that say where."""

    predicates: tuple[Predicate, ...]
    any_of: bool = False

    def condition(self, readings: Sequence[str]) -> c.Condition:
        """The condition on readings of these names, one for each predicate."""
        made = tuple(p.condition(name) for p, name in zip(self.predicates, readings, strict=True))
        if len(made) == 1:
            return made[0]
        return c.AnyOf(conditions=made) if self.any_of else c.AllOf(conditions=made)


def place_in(terms: Sequence[Term]) -> tuple[tuple[Term, ...], tuple[Term, ...]]:
    """The terms of a condition, and those in it that name a place of its own ("the CO2 | at tree 4 | is low")."""
    for start, term in enumerate(terms):
        if term.kind in _PREDICATE and not any(t.kind in RELATIONS for t in terms[:start]):
            break
        if term.kind in RELATIONS - {"FOR"}:
            end = next((k for k in range(start, len(terms)) if terms[k].kind in _PREDICATE), len(terms))
            place = tuple(terms[start:end])
            kinds = {t.kind for t in place[1:]}
            ranked_tree = "TREE" in kinds and kinds & {"ORD", "LAST"}  # "at the first tree" is a place of its own
            if kinds <= _HERE and not ranked_tree:
                return tuple(terms), ()
            return (*terms[:start], *terms[end:]), place
    return tuple(terms), ()


def read_condition(terms: Sequence[Term], captures: Sequence[DraftCapture], robot: RobotProfile, site: Site) -> Tested:
    """What a condition tests.

    Args:
        terms: Its terms, the "if" and a place of its own left out.
        captures: What was captured before it, in the order of the text.

    Raises:
        Unclear, Question: It cannot be told what is tested.
    """
    groups, any_of = _groups(terms)
    made: list[Predicate] = []
    subject: list[Term] = []
    attribute = ""
    for group in groups:
        subject = [t for t in group if t.kind in _SUBJECT] or subject
        attribute = _attribute_of(group, site) or ("" if any(t.kind in _SUBJECT for t in group) else attribute)
        if attribute:
            made.append(_tree_predicate(group, attribute))
        else:
            made.append(_reading_predicate(group, subject, captures, robot))
    return Tested(predicates=tuple(made), any_of=any_of)


def _groups(terms: Sequence[Term]) -> tuple[list[list[Term]], bool]:
    """Predicates between "and" and "or"; the "and" of "between" belongs to it."""
    groups: list[list[Term]] = [[]]
    words: set[str] = set()
    ranged = False
    for term in terms:
        ranged = ranged or term.kind == "BETWEEN"
        if term.kind not in ("JOIN", "OR"):
            groups[-1].append(term)
        elif ranged and any(t.kind == "BETWEEN" for t in groups[-1]) and _numbers(groups[-1]) == 1:
            ranged = False
        else:
            words.add("or" if term.kind == "OR" or term.value == "or" else "and")
            groups.append([])
    if len(words) > 1:
        raise unclear(
            terms,
            message("'and' and 'or' in one condition can be read in two ways"),
            message("say it as two conditions"),
        )
    return [g for g in groups if g], "or" in words


def _numbers(group: Sequence[Term]) -> int:
    return sum(t.kind in ("NUM", "AMOUNT") for t in group)


def _attribute_of(group: Sequence[Term], site: Site) -> str:
    """The attribute of the tree that a predicate is about, if it is about one."""
    for term in group:
        if term.kind in ("ATTR", "ATTRVAL"):
            names = [n if isinstance(n, str) else n[0] for n in term.value]
            if len(names) > 1:
                raise Question(
                    message(
                        "'{said}' is a value of {names}: which is meant?",
                        context="question",
                        said=term.text,
                        names=listed(names),
                    ),
                    tuple(names),
                )
            return str(names[0])
        if term.kind == "CMP" and term.value[1]:
            return hinted(term.value[1], (term,), site)
    if any(t.kind == "AMOUNT" and t.value.unit == "years" for t in group):
        return hinted("age", tuple(group), site)
    return ""


def _tree_predicate(group: Sequence[Term], attribute: str) -> Predicate:
    negated = sum(t.kind in ("NOT", "ISNOT") for t in group) % 2 == 1
    left = [t for t in group if t.kind not in _AROUND | {"TREE", "NOT", "ISNOT", "ATTR", "ANY"}]
    match [t.kind for t in left]:
        case ["ATTRVAL"]:
            name, wanted = left[0].value[0]
            return Predicate(made=c.TreeHas(attribute=name, test="ne" if negated else "eq", value=wanted))
        case ["CMP", "NUM" | "AMOUNT"]:
            test = OPPOSITE[left[0].value[0]] if negated else left[0].value[0]
            return Predicate(made=c.TreeHas(attribute=attribute, test=test, value=number_of(left[1])))
        case _:
            raise unclear(
                group,
                message("it does not say what the tree has to be like"),
                message("say 'older than 8 years', for example"),
            )


def _reading_predicate(
    group: Sequence[Term], subject: Sequence[Term], captures: Sequence[DraftCapture], robot: RobotProfile
) -> Predicate:
    wanted = quantities_of(group, subject, robot)
    capture = _latest(group, subject, captures, wanted, robot)
    if capture is None:
        quantity, missing = _measurable(wanted, group, robot)
    else:
        measured = robot.action[capture.action].measures
        quantity, missing = next(q for q in measured if q in wanted), ""
    made, negated = _comparison(group, quantity, robot)
    return Predicate(made=made, negated=negated, capture=capture, missing=missing, quantity=quantity)


def quantities_of(group: Sequence[Term], subject: Sequence[Term], robot: RobotProfile) -> list[str]:
    """The quantities that a predicate may be about, by its noun, its unit and its adjectives."""
    wanted = [q.name for q in robot.quantities]
    for term in subject:
        if term.kind == "NOUN" and isinstance(term.value, Naming):
            named = [*term.value.quantities, *(m for a in term.value.actions for m in robot.action[a].measures)]
            if not set(wanted) & set(named):
                raise unclear([term], message("{name} cannot measure this", name=robot.name), _reports(robot))
            wanted = [q for q in wanted if q in named]
    if any(t.kind in ("CMP", "LEVEL") and any(w in t.text.lower() for w in _TEMPERATURE_WORDS) for t in group):
        wanted = [q for q in wanted if robot.quantity[q].unit == "degC"]
    numbers = [t.value for t in group if t.kind == "NUM"] if any(t.kind in ("CMP", "BETWEEN") for t in group) else []
    possible = [q for q in wanted if all(_can_be(robot, q, number) for number in numbers)]
    wanted = possible or wanted
    amount = next((t for t in group if t.kind == "AMOUNT"), None)
    if amount is not None:
        fitting = [q for q in wanted if robot.quantity[q].unit == amount.value.unit]
        if not fitting:
            raise unclear([amount], message("that unit does not match what is measured"), _reports(robot, wanted))
        wanted = fitting
    return wanted


def _can_be(robot: RobotProfile, quantity: str, number: float) -> bool:
    """Whether a quantity can have a value: no temperature is 400."""
    known = robot.quantity[quantity]
    low, high = known.minimum, known.maximum
    return (low is None or number >= low) and (high is None or number <= high)


def _reports(robot: RobotProfile, wanted: Sequence[str] = ()) -> str:
    names = wanted or [q.name for q in robot.quantities]
    if not names:
        return message("{robot} reports no readings", robot=robot.name)
    units = [
        message("{quantity} in {unit}", quantity=say_name(n), unit=say_unit(robot.quantity[n].unit)) for n in names
    ]
    return message("{robot} reports {readings}", robot=robot.name, readings=joined(", ", units))


def _latest(
    group: Sequence[Term],
    subject: Sequence[Term],
    captures: Sequence[DraftCapture],
    wanted: list[str],
    robot: RobotProfile,
) -> DraftCapture | None:
    fitting = [cap for cap in captures if set(robot.action[cap.action].measures) & set(wanted)]
    rank = next((t.value for t in subject if t.kind == "ORD"), None)
    if rank is not None:
        if not 1 <= rank <= len(fitting):
            raise unclear(
                group,
                message("{count} readings are taken before it", count=len(fitting)),
                message("say which reading is meant"),
            )
        return fitting[int(rank) - 1]
    if not fitting:
        return None
    last = fitting[-1]
    rivals = [cap for cap in fitting if cap.command == last.command and cap.action != last.action]
    if rivals and last.command:
        names = choices_of_actions(cap.action for cap in (*rivals, last))
        raise Question(message("'{said}': which reading is meant?", context="question", said=text_of(group)), names)
    return last


def _measurable(wanted: list[str], terms: Sequence[Term], robot: RobotProfile) -> tuple[str, str]:
    """A quantity that nothing measured yet, and the action that measures it."""
    pairs = [(q, a.name) for q in wanted for a in robot.actions if q in a.measures]
    if len(pairs) == 1:
        return pairs[0]
    if not pairs:
        raise unclear(terms, message("{name} measures nothing like that", name=robot.name), _reports(robot))
    raise Question(
        message("'{said}': which reading is meant?", context="question", said=text_of(terms)),
        tuple(named(q.replace("_", " "), "answer", named(q.replace("_", " "), "name")) for q, _ in pairs),
    )


def _comparison(group: Sequence[Term], quantity: str, robot: RobotProfile) -> tuple[c.Condition, bool]:
    negated = sum(t.kind in ("NOT", "ISNOT") for t in group) % 2 == 1
    kept = [t for t in group if t.kind not in _AROUND | _SUBJECT | {"NOT", "ISNOT", "ANOTHER"}]
    if kept and kept[0].kind == "TREE" and any(t.kind == "AT" or t.kind == "OF" for t in group):
        kept = kept[1:]  # "the reading at the tree"
    unit = robot.quantity[quantity].unit
    match [t.kind for t in kept]:
        case ["CMP", "NUM" | "AMOUNT"]:
            return _compare(kept[0], kept[1], unit), negated
        case ["NUM" | "AMOUNT", "CMP"] if kept[1].text.lower() in ("or less", "or more", "minimum", "maximum"):
            return _compare(kept[1], kept[0], unit), negated
        case ["BETWEEN", "NUM" | "AMOUNT", "NUM" | "AMOUNT"]:
            low, high = number_of(kept[1]), number_of(kept[2])
            if low > high:
                raise unclear(
                    group,
                    message("no value lies between {low} and {high}", low=Number(f"{low:g}"), high=Number(f"{high:g}")),
                    message("put the lower number first"),
                )
            return c.Between(reading="", quantity="", low=low, high=high, unit=unit), negated
        case ["LEVEL"]:
            return _level(kept[0], quantity, robot), negated
        case _:
            raise unclear(
                group,
                message("it does not say what the reading has to be"),
                message("say 'below 33 °C', or 'low'"),
            )


def _compare(test: Term, number: Term, unit: str) -> c.Condition:
    return c.Compare(reading="", quantity="", test=test.value[0], value=number_of(number), unit=unit)


def _level(word: Term, quantity: str, robot: RobotProfile) -> c.Condition:
    levels = robot.quantity[quantity].levels
    name = word.text.lower().removeprefix("too ").strip()
    level = name if name in levels else word.value
    if level not in levels:
        what = message(
            "what is a {level} {quantity}? {name} does not define that level",
            level=named(level, "level"),
            quantity=say_name(quantity),
            name=robot.name,
        )
        raise Question(
            message(
                "{what}; say a threshold in {unit}", context="question", what=what, unit=robot.quantity[quantity].unit
            ),
            tuple(named(level, "answer", named(level, "level")) for level in levels),
            terms=(word,),
        )
    return c.Level(reading="", quantity="", level=level)
