"""Conditions: "if that reading is below 33 °C", "if it is low", "where the tree is yellow"."""

from __future__ import annotations

from collections.abc import Sequence
from dataclasses import dataclass

from fieldhand.planning.english.draft import Block, Capture
from fieldhand.planning.english.lexicon import Naming
from fieldhand.planning.english.places import Question, Unclear
from fieldhand.planning.english.tokens import Term
from fieldhand.planning.planner import Reason
from fieldhand.robot.model import RobotProfile
from fieldhand.site.model import Site
from fieldhand.task import conditions as c

NOISE = frozenset(
    {
        "DET",
        "IT",
        "IS",
        "WHICH",
        "STILL",
        "OF",
        "READING",
        "THANEQ",
        "AT",
        "THERE",
        "TREE",
        "PLACE",
        "FROM",
        "MORE",
        "ANY",
        "OTHER",
        "FOR",
        "EACH",
    }
)
TEMPERATURE_WORDS = ("hot", "warm", "cold", "cool")


@dataclass(frozen=True, kw_only=True)
class Tested:
    """What a condition is about.

    Attributes:
        build: The condition, once the reading has a name.
        capture: The capture whose reading it tests; None for an attribute of the tree.
        missing: Action that must be done first, where nothing measured it yet.
    """

    predicates: tuple[_Predicate, ...]
    any_of: bool
    capture: Capture | None = None
    missing: str = ""
    quantity: str = ""

    def condition(self, reading: str) -> c.Condition:
        """The condition on a reading of that name."""
        made = tuple(p.condition(reading, self.quantity) for p in self.predicates)
        if len(made) == 1:
            return made[0]
        return c.AnyOf(conditions=made) if self.any_of else c.AllOf(conditions=made)


@dataclass(frozen=True, kw_only=True)
class _Predicate:
    made: c.Condition
    negated: bool

    def condition(self, reading: str, quantity: str) -> c.Condition:
        from dataclasses import replace

        made = self.made
        if isinstance(made, c.Compare | c.Between | c.Level):
            made = replace(made, reading=reading, quantity=quantity)
        return c.Not(condition=made) if self.negated else made


def read_condition(
    terms: Sequence[Term], captures: Sequence[tuple[Capture, Block]], robot: RobotProfile, site: Site
) -> Tested:
    """What a condition tests.

    Args:
        terms: Its terms, the "if" left out.
        captures: What was captured before it, in the order of the text.

    Raises:
        Unclear, Question: It cannot be told what is tested.
    """
    groups, any_of = _groups(terms)
    subject = [t for g in groups for t in g if t.kind in ("NOUN", "ORD", "LAST")]
    attribute = _attribute_of(groups, site)
    if attribute is not None:
        return Tested(predicates=tuple(_tree_predicate(g, attribute, site) for g in groups), any_of=any_of)
    unit = next((t.value.unit for t in terms if t.kind == "AMOUNT"), "")
    wanted = _quantities(subject, terms, unit, robot)
    capture = _latest(subject, captures, wanted, robot)
    if capture is None:
        quantity, action = _measurable(wanted, terms, robot)
    else:
        measured = robot.action[capture.action].measures
        quantity = next((q for q in measured if q in wanted), measured[0])
        action = ""
    predicates = tuple(_predicate(g, quantity, robot) for g in groups)
    return Tested(predicates=predicates, any_of=any_of, capture=capture, missing=action, quantity=quantity)


def _groups(terms: Sequence[Term]) -> tuple[list[list[Term]], bool]:
    """Predicates between "and" and "or"; the "and" of "between" belongs to it."""
    groups: list[list[Term]] = [[]]
    any_of = False
    ranged = False
    for term in terms:
        if term.kind == "BETWEEN":
            ranged = True
        if term.kind in ("JOIN", "OR") and not ranged:
            any_of = any_of or term.kind == "OR" or term.value == "or"
            groups.append([])
            continue
        if term.kind in ("JOIN", "OR"):
            ranged = False
            continue
        groups[-1].append(term)
    return [g for g in groups if g], any_of


def _attribute_of(groups: list[list[Term]], site: Site) -> str | None:
    """The attribute of the tree that a condition is about, if it is about one."""
    for group in groups:
        for term in group:
            if term.kind == "ATTR":
                return str(term.value[0])
            if term.kind == "ATTRVAL":
                return str(term.value[0][0])
            if term.kind == "CMP" and term.value[1]:
                fitting = [n for n in site.attributes if term.value[1] in n.lower().split("_")]
                if not fitting:
                    raise Unclear(
                        Reason(
                            what=f"this site records no {term.value[1]} of its trees",
                            said=(term.span,),
                            advice=f"it records: {', '.join(list(site.attributes)[:8]) or 'none'}",
                        )
                    )
                return fitting[0]
    return None


def _tree_predicate(group: list[Term], attribute: str, site: Site) -> _Predicate:
    negated = any(t.kind in ("NOT", "ISNOT") for t in group)
    value = next((t for t in group if t.kind == "ATTRVAL"), None)
    if value is not None:
        name, wanted = value.value[0]
        return _Predicate(made=c.TreeHas(attribute=name, test="eq", value=wanted), negated=negated)
    test = next((t for t in group if t.kind == "CMP"), None)
    number = next((t for t in group if t.kind in ("NUM", "AMOUNT")), None)
    if test is None or number is None:
        raise _unclear(group, "what is asked of the tree does not stand there")
    del site
    return _Predicate(made=c.TreeHas(attribute=attribute, test=test.value[0], value=_number(number)), negated=negated)


def _quantities(subject: list[Term], terms: Sequence[Term], unit: str, robot: RobotProfile) -> list[str]:
    """The quantities that a condition may be about, by its noun, its unit and its adjectives."""
    wanted = [q.name for q in robot.quantities]
    for term in subject:
        if term.kind == "NOUN" and isinstance(term.value, Naming):
            named = [*term.value.quantities, *(m for a in term.value.actions for m in robot.action[a].measures)]
            wanted = [q for q in wanted if q in named] or wanted
    if any(t.kind in ("CMP", "LEVEL") and any(w in t.text.lower() for w in TEMPERATURE_WORDS) for t in terms):
        wanted = [q for q in wanted if robot.quantity[q].unit == "degC"]
    if unit:
        fitting = [q for q in wanted if robot.quantity[q].unit == unit]
        if not fitting:
            units = ", ".join(f"{q.replace('_', ' ')} in {robot.quantity[q].unit}" for q in wanted)
            amount = next(t for t in terms if t.kind == "AMOUNT")
            raise Unclear(
                Reason(
                    what=f"'{amount.text}' does not fit what is measured",
                    said=(amount.span,),
                    advice=f"{robot.name} reports {units}",
                )
            )
        wanted = fitting
    return wanted


def _latest(
    subject: list[Term], captures: Sequence[tuple[Capture, Block]], wanted: list[str], robot: RobotProfile
) -> Capture | None:
    fitting = [cap for cap, _ in captures if set(robot.action[cap.action].measures) & set(wanted)]
    rank = next((t.value for t in subject if t.kind == "ORD"), None)
    if rank is not None and 1 <= rank <= len(fitting):
        return fitting[rank - 1]
    return fitting[-1] if fitting else None


def _measurable(wanted: list[str], terms: Sequence[Term], robot: RobotProfile) -> tuple[str, str]:
    """A quantity that nothing measured yet, and the action that measures it."""
    pairs = [(q, a.name) for q in wanted for a in robot.actions if q in a.measures]
    if len(pairs) == 1:
        return pairs[0]
    text = " ".join(t.text for t in terms)
    if not pairs:
        raise _unclear(list(terms), f"{robot.name} measures nothing like that")
    raise Question(f"'{text}': which reading is meant?", tuple(q.replace("_", " ") for q, _ in pairs))


def _predicate(group: list[Term], quantity: str, robot: RobotProfile) -> _Predicate:
    left = [t for t in group if t.kind not in NOISE | {"NOUN", "ORD", "LAST", "ANOTHER"}]
    negated = False
    kept: list[Term] = []
    for term in left:
        if term.kind in ("NOT", "ISNOT"):
            negated = not negated
        else:
            kept.append(term)
    unit = robot.quantity[quantity].unit
    match [t.kind for t in kept]:
        case ["CMP", "NUM" | "AMOUNT"]:
            made: c.Condition = c.Compare(
                reading="", quantity="", test=kept[0].value[0], value=_number(kept[1]), unit=unit
            )
        case ["NUM" | "AMOUNT", "CMP"] if kept[1].text.lower() in ("or less", "minimum", "maximum"):
            made = c.Compare(reading="", quantity="", test=kept[1].value[0], value=_number(kept[0]), unit=unit)
        case ["BETWEEN", "NUM" | "AMOUNT", "NUM" | "AMOUNT"]:
            low, high = _number(kept[1]), _number(kept[2])
            if low > high:
                raise _unclear(group, f"nothing lies between {low:g} and {high:g}", "put the lower number first")
            made = c.Between(reading="", quantity="", low=low, high=high, unit=unit)
        case ["LEVEL"]:
            made = _level(kept[0], quantity, robot)
        case _:
            raise _unclear(group, "what is asked of the reading does not stand there", "say 'below 33 °C', or 'low'")
    return _Predicate(made=made, negated=negated)


def _level(word: Term, quantity: str, robot: RobotProfile) -> c.Condition:
    levels = robot.quantity[quantity].levels
    name = word.text.lower().removeprefix("too ").strip()
    level = name if name in levels else word.value
    if level not in levels:
        known = tuple(levels)
        raise Question(
            f"what is a {level} {quantity.replace('_', ' ')}? {robot.name} gives no such word for it;"
            f" say a threshold in {robot.quantity[quantity].unit}",
            known,
        )
    return c.Level(reading="", quantity="", level=level)


def _number(term: Term) -> float:
    return float(term.value if term.kind == "NUM" else term.value.number)


def _unclear(group: Sequence[Term], what: str, advice: str = "say it in other words") -> Unclear:
    text = " ".join(t.text for t in group)
    return Unclear(Reason(what=f"'{text}': {what}", said=tuple(t.span for t in group), advice=advice))
