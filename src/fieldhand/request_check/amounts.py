"""Numbers in a request, each with the quantity that the words around it name."""

from __future__ import annotations

from collections.abc import Iterator, Sequence
from dataclasses import dataclass, replace
from itertools import zip_longest
from typing import Literal

from fieldhand.request_check import words as w
from fieldhand.request_check.numbers import StatedNumber, numbers
from fieldhand.request_check.words import Token

AmountKind = Literal[
    "id", "row", "name", "rows", "trees", "captures", "corners", "times", "length", "time", "attribute", "percent",
    "temperature", "speed", "unit", "ordinal", "plain",
]  # fmt: skip

#: Words between the numbers of a list of names ("trees 4, 9 and 12").
_RANGES = frozenset({"to", "-", "\u2013", "through", "thru", "until", "till"})
_NUMBERED = frozenset({"#", "number", "no", "nr", "id", "ids", "numbers", "numbered", "nos"})
_JOINS = _RANGES | _NUMBERED | {",", "and", "or", "&", "then", "up"}
_STOPS = frozenset({".", ";", ":", "?", "!", "(", ")"})
#: Maximum number of words between two numbers of a list.
_LONGEST_JOINT = 4
#: Maximum distance in tokens of a comparison word before its number.
_COMPARED = 5


@dataclass(frozen=True, kw_only=True)
class StatedAmount:
    """A number in the request.

    Attributes:
        kind: Kind of quantity.
        values: Possible values in the unit of plans (metres, seconds, degC, percent, or a plain number).
        words: Words of the request, for messages.
        index: Index of its first token.
        sentence: Number of its sentence.
        actions: Actions that the noun may mean, if captures are counted.
        unit: Unit, if the kind is ``unit``.
        compared: ``below`` or ``above`` for a threshold, ``between`` for an end of a range, else empty.
        through: Last number of a range that an ``id`` or ``row`` begins, else 0.
    """

    kind: AmountKind
    values: tuple[float, ...]
    words: str
    index: int
    sentence: int
    actions: frozenset[str] = frozenset()
    unit: str = ""
    compared: str = ""
    through: int = 0


@dataclass(frozen=True, kw_only=True)
class Noun:
    """A noun of the robot's vocabulary in the request: its length in tokens and the actions that it may mean."""

    length: int
    actions: frozenset[str]


def amounts(tokens: Sequence[Token], nouns: dict[int, Noun], units: frozenset[str]) -> tuple[StatedAmount, ...]:
    """Return every number of a request.

    Args:
        tokens: Tokens of the request.
        nouns: Nouns of the robot's vocabulary by the index of their first token.
        units: Units of the robot's quantities in lower case.
    """
    found: list[StatedAmount] = []
    for number in numbers(tokens):
        amount = _amount(tokens, number, nouns, units)
        before = found[-1] if found else None
        ends_range = number.start > 0 and tokens[number.start - 1].text in _RANGES  # "rows 2 to 4 photograph"
        counts = _is_counted(tokens, number.end, nouns) and not ends_range
        bare = amount.kind == "plain" or (amount.kind == "captures" and not counts)
        if before is not None and (bare or amount.kind == before.kind) and _listed(tokens, before, number):
            amount = replace(amount, kind=before.kind, actions=frozenset())
            if (
                any(tokens[k].text in _RANGES for k in range(before.index + 1, number.start))
                and len(amount.values) == 1
            ):
                found[-1] = replace(before, through=int(amount.values[0]))
        found.append(amount)
    return tuple(_shared_units(found, tokens))


def numbers_of(amount: StatedAmount) -> set[int]:
    """Return the whole numbers of an amount, including all of a range."""
    found = {int(v) for v in amount.values if float(v).is_integer()}
    return found | set(range(int(amount.values[0]), min(amount.through, int(amount.values[0]) + 10_000) + 1))


def _amount(
    tokens: Sequence[Token], number: StatedNumber, nouns: dict[int, Noun], units: frozenset[str]
) -> StatedAmount:
    value, k = number.value, number.end
    if [token.text for token in tokens[k : k + 1]] == ["-"]:
        k += 1  # "two-year-old"
    after = tokens[k].text if k < len(tokens) else ""
    words = w.quoted(tokens[number.start : min(k + 1, len(tokens))])
    made = StatedAmount(
        kind="ordinal" if number.ordinal else "plain",
        values=(value,),
        words=words,
        index=number.start,
        sentence=tokens[number.start].sentence,
        compared=_compared(tokens, number.start),
    )
    if number.ordinal:
        return made
    if after in w.LENGTHS and (pace := _pace(tokens, k + 1)):
        return replace(made, kind="speed", values=(value * w.LENGTHS[after] / pace,))
    if after in w.SPEEDS:
        return replace(made, kind="speed", values=(value * w.SPEEDS[after],))
    if after in w.LENGTHS:
        return replace(made, kind="length", values=(value * w.LENGTHS[after],))
    if after in w.TIMES:
        return replace(made, kind="time", values=(value * w.TIMES[after],))
    if after in w.PERCENT or (tokens[k : k + 2] and [t.text for t in tokens[k : k + 2]] == ["per", "cent"]):
        return replace(made, kind="percent")
    if after in w.DEGREES and _degrees(tokens, k):
        return replace(made, kind="temperature", values=_celsius(value, tokens, k))
    if after in units:
        return replace(made, kind="unit", unit=after)
    if after in w.AGES or (after == "-" and tokens[k + 1 : k + 2] and tokens[k + 1].text in w.AGES):
        return replace(made, kind="attribute")
    if after in ("times", "x") or [token.text for token in tokens[k : k + 2]] == ["more", "times"]:
        return replace(made, kind="times")
    if after in w.ROWS:
        return replace(made, kind="rows")
    if after == "of" and [w.is_number(t.text) for t in tokens[k + 2 : k + 3]] == [True]:
        return made  # "two of tree 9", of what was said to be captured
    name = _name(tokens[max(0, number.start - 3) : number.start])
    counted = _counted(tokens, k, nouns)
    spelt = not w.is_number(tokens[number.start].text)
    if name == "id" and spelt and counted is not None and _is_counted(tokens, k, nouns):
        name = None  # "take at each corner tree two pictures"
    if name == "row" or (name and after not in w.TREES):
        return replace(made, kind=name)
    return made if counted is None else replace(made, kind=counted[0], actions=counted[1])


def _pace(tokens: Sequence[Token], k: int) -> float:
    """Return the seconds of a speed's unit of time ("/ s", "per hour", "a second"); 0 if it is no speed."""
    per = [token.text for token in tokens[k : k + 2]]
    seconds = w.TIMES | {"second": 1.0}  # "half a metre a second"; elsewhere "second" is a rank
    return seconds.get(per[1], 0.0) if len(per) == 2 and per[0] in ("/", "per", "a", "an", "each", "every") else 0.0


def _name(before: Sequence[Token]) -> AmountKind | None:
    """Return the kind of name that a number is by the words before it: "tree 7", "row #3"."""
    texts = [token.text for token in before]
    marked = texts[-1:] == ["#"]
    if texts and texts[-1] in _NUMBERED:
        texts.pop()
    if len(texts) > 1 and texts[-1] == "from":
        texts.pop()  # "the trees from 20 to 30"
    head = texts[-1] if texts else ""
    if head in w.ROWS:
        return "row"
    if head in ("bed", "beds", "bench", "block", "blocks", "plot", "parcel", "zone", "section"):
        return "name"
    if head in ("tree", "trees", "vine", "vines", "plant", "plants") or marked:
        return "id"
    return None


def _degrees(tokens: Sequence[Token], k: int) -> bool:
    """Return True if a degree sign or letter is a temperature: "90 F", "33c"."""
    text = tokens[k].text
    return (
        text not in ("c", "f") or k + 1 >= len(tokens) or not tokens[k + 1].joined or not tokens[k + 1].text.isalpha()
    )


def _celsius(value: float, tokens: Sequence[Token], k: int) -> tuple[float, ...]:
    """Return a temperature in degC; both readings if the scale is not given."""
    scale = next((t.text[0] for t in tokens[k : k + 4] if t.text in w.DEGREES and t.text[0] in "cf"), "")
    fahrenheit = (value - 32.0) / 1.8
    return (value,) if scale == "c" else (fahrenheit,) if scale == "f" else (value, fahrenheit)


def _is_counted(tokens: Sequence[Token], k: int, nouns: dict[int, Noun]) -> bool:
    """Return True if a noun of captures begins at a token; "photographed" is none."""
    return k in nouns and not tokens[k].text.endswith("ed")


def _counted(tokens: Sequence[Token], k: int, nouns: dict[int, Noun]) -> tuple[AmountKind, frozenset[str]] | None:
    """Return the kind and actions that a number counts, by the noun at the end of its phrase."""
    for at in range(k, min(k + 6, len(tokens))):
        text = tokens[at].text
        if _is_counted(tokens, at, nouns) and nouns[at].actions:
            return "captures", nouns[at].actions
        # "Known to within 2 %, 5 readings or more" is no number of captures.
        if text in w.READINGS and at == k and [one.text for one in tokens[at + 1 : at + 3]] != ["or", "more"]:
            return "captures", frozenset()
        if text in w.CORNERS:
            return "corners", frozenset()
        if text in w.TREES:
            return "trees", frozenset()
        if text in w.ROWS:
            return None
        if text in w.ENDS_PHRASE or w.is_number(text) or text in w.NUMBERS:
            return None
    return None


def _compared(tokens: Sequence[Token], index: int) -> str:
    """Return the direction of the comparison whose threshold a number is; empty if there is none."""
    for k in range(index - 1, max(-1, index - 1 - _COMPARED), -1):
        text = tokens[k].text
        number = k + 2 < len(tokens) and (w.is_number(tokens[k + 1].text) or tokens[k + 1].text in w.NUMBERS)
        if text == "between" or (text == "from" and number and tokens[k + 2].text == "to"):
            return "between"
        if text in w.BELOW or text in w.ABOVE:
            side = "below" if text in w.BELOW else "above"
            negated = any(t.text in w.NEGATIONS for t in tokens[max(0, k - 3) : k])
            return "between" if negated else side
        if text in (".", ";", ",", "if", "then", "another", "take"):
            break
    return ""


def _listed(tokens: Sequence[Token], before: StatedAmount, number: StatedNumber) -> bool:
    """Return True if a bare number continues a list of names: "trees 4, 9 and 12"."""
    if before.kind not in ("id", "row", "name") or number.ordinal:
        return False
    between = [t.text for t in tokens[before.index + 1 : number.start]]
    behind = [t.text for t in tokens[number.end : number.end + 2]]
    if before.kind == "row" and len(behind) == 2 and behind[0] in ("in", "from", "of") and behind[1] in w.ROWS:
        return False  # "one tree in row 3 and two in row 5"
    spelt = not w.is_number(tokens[number.start].text)
    if between and spelt and behind and not (behind[0] in _JOINS or behind[0] in _STOPS or behind[0] in w.TREES):
        return False  # "three at tree 12, two at tree 13", "along row 3, one reading every 20 m"
    if number.value <= before.values[0] and not _RANGES.isdisjoint(between):
        return False  # "row 3 until one of them"
    return 0 < len(between) <= _LONGEST_JOINT and all(text in _JOINS | w.TREES | w.ROWS for text in between)


def _shared_units(amounts_found: Sequence[StatedAmount], tokens: Sequence[Token]) -> Iterator[StatedAmount]:
    """Yield amounts with a unit taken from the second number of a range: "between 380 and 420 ppm"."""
    for amount, following in zip_longest(amounts_found, amounts_found[1:]):
        joined = following is not None and [t.text for t in tokens[amount.index + 1 : following.index]] in (
            ["and"], ["to"], ["-"], ["or"]
        )  # fmt: skip
        if not joined or following is None or amount.kind != "plain" or following.kind in ("ordinal", "plain"):
            yield amount
            continue
        if following.kind == "temperature" and len(following.values) == 1:
            fahrenheit = abs(following.values[0] - _first(following.words)) > 1e-9
            values = tuple((v - 32.0) / 1.8 if fahrenheit else v for v in amount.values)
        else:
            values = amount.values
        if following.kind in ("temperature", "unit", "percent"):
            yield replace(amount, kind=following.kind, unit=following.unit, values=values)
        else:
            yield amount


def _first(text: str) -> float:
    head = text.split()[0].replace(",", "")
    return float(head) if w.is_number(head) else w.NUMBERS.get(head, 0.0)
