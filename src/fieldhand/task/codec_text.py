"""Values of attributes as text and back. Every value comes back equal, with its type.

Numbers are written with the fewest digits that read back as the same number. A value that may be text, number or yes/no
is written bare; text that would read as one of the others is marked (``value="10" value-as="text"``).
"""

from __future__ import annotations

import math
import re
from typing import Any

from fieldhand.task.codec_shapes import Attribute
from fieldhand.terms import Value
from fieldhand.visible import find_hidden

NUMBER = r"[+-]?([0-9]+(\.[0-9]*)?|\.[0-9]+)([eE][+-]?[0-9]+)?"
INTEGER = r"[+-]?[0-9]{1,18}"
SPANS = r"([0-9]{1,9}-[0-9]{1,9}( [0-9]{1,9}-[0-9]{1,9})*)?"

#: Elements whose text may have several lines: a request stands in the Task as it was typed.
SEVERAL_LINES = frozenset({"request", "read-as"})


def hidden_character(text: str, *, lines: bool = False) -> str | None:
    """Return the first character of a text that a Task may not hold, such as ``U+202E``; None if there is none.

    That is every character that nobody sees: what is read back must be what is signed. Those that XML 1.0 excludes are
    among them. They are refused and not escaped: no one means them, and an escape would shift the character ranges of
    ``said``.
    """
    found = find_hidden(text, lines=lines)
    return None if found is None else found.name


def number_text(value: float) -> str:
    """A finite number as text.

    Raises:
        ValueError: It is infinite or not a number.
    """
    if not math.isfinite(value):
        raise ValueError(f"{value} is not a finite number")
    exact = float(value)
    if exact.is_integer() and abs(exact) < 1e15 and not (exact == 0 and math.copysign(1, exact) < 0):
        return str(int(exact))
    return repr(exact)


def number_of(text: str) -> float:
    """The number that a text stands for.

    Raises:
        ValueError: It is no number, or too large for one.
    """
    if not re.fullmatch(NUMBER, text.strip(" \t\r\n")):
        raise ValueError(f"{text!r} is not a number")
    value = float(text)
    if not math.isfinite(value):
        raise ValueError(f"{text!r} is too large")
    return value


def bare_value(text: str) -> Value:
    """What a bare text stands for: ``true``, ``false``, a number, else itself."""
    if text in ("true", "false"):
        return text == "true"
    return number_of(text) if re.fullmatch(NUMBER, text) else text


def attribute_text(attribute: Attribute, value: Any) -> dict[str, str]:
    """The attributes, by name, that stand for a value.

    Raises:
        ValueError: The value cannot be written.
    """
    match attribute.kind:
        case "integer":
            text = str(int(value))
            if not re.fullmatch(INTEGER, text):
                raise ValueError(f"{text} has too many digits")
        case "number":
            text = number_text(value)
        case "flag":
            text = "true" if value else "false"
        case "choices":
            text = " ".join(value)
        case "spans":
            text = " ".join(f"{start}-{end}" for start, end in value)
            if not re.fullmatch(SPANS, text):
                raise ValueError(f"{text} are not ranges of characters")
        case "value":
            if isinstance(value, str):
                marked = {} if isinstance(bare_value(value), str) else {f"{attribute.name}-as": "text"}
                return {attribute.name: value, **marked}
            text = ("true" if value else "false") if isinstance(value, bool) else number_text(value)
        case _:
            text = value
    return {attribute.name: text}


def parse_value(attribute: Attribute, text: str, marked: str | None = None) -> Any:
    """The value that a text stands for; ``marked`` is the text of the ``-as`` attribute beside it, if it stands.

    Raises:
        ValueError: It stands for none; says what would.
    """
    bare = text.strip(" \t\r\n")
    match attribute.kind:
        case "text":
            return text
        case "integer":
            if not re.fullmatch(INTEGER, bare):
                raise ValueError(f"{text!r} is not a whole number")
            return int(bare)
        case "number":
            return number_of(text)
        case "flag":
            if bare not in ("true", "false", "1", "0"):
                raise ValueError(f"{text!r} is neither true nor false")
            return bare in ("true", "1")
        case "choice":
            return _one_of(attribute, bare)
        case "choices":
            return tuple(_one_of(attribute, word) for word in bare.split())
        case "spans":
            if not re.fullmatch(SPANS, bare):
                raise ValueError(f"{text!r} is not a list of character ranges such as 0-12 20-31")
            return tuple((int(a), int(b)) for a, b in (span.split("-") for span in bare.split()))
        case "value":
            if marked not in (None, "text"):
                raise ValueError(f'{marked!r} is not "text", the only mark there is')
            return text if marked else bare_value(text)


def _one_of(attribute: Attribute, word: str) -> str:
    if word not in attribute.choices:
        raise ValueError(f"{word!r} is not one of {', '.join(attribute.choices)}")
    return word
