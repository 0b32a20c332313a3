"""Convert attribute values to text and back. Every value is restored with its type.

Numbers are written with the fewest digits that restore the same value. A value that may be text, number or boolean is
written bare; text that would be read as a number or boolean is marked (``value="10" value-as="text"``).
"""

from __future__ import annotations

import math
import re
from typing import Any

from fieldhand.hidden_characters import find_hidden
from fieldhand.task.codec_shapes import Attribute
from fieldhand.terms import Value

NUMBER = r"[+-]?([0-9]+(\.[0-9]*)?|\.[0-9]+)([eE][+-]?[0-9]+)?"
INTEGER = r"[+-]?[0-9]{1,18}"
SPANS = r"([0-9]{1,9}-[0-9]{1,9}( [0-9]{1,9}-[0-9]{1,9})*)?"

#: Elements with multi-line text: the Task keeps the request as it was typed.
SEVERAL_LINES = frozenset({"request", "read-as"})


def hidden_character(text: str, *, lines: bool = False) -> str | None:
    """Return the first forbidden character of a text, such as ``U+202E``; None if there is none.

    Invisible characters are forbidden, including those that XML 1.0 excludes: a signed document must contain exactly
    what was read back. They are refused rather than escaped, because nobody means them and an escape would shift the
    character ranges in ``said``.
    """
    found = find_hidden(text, lines=lines)
    return None if found is None else found.name


def number_text(value: float) -> str:
    """Return a finite number as text.

    Raises:
        ValueError: Infinite or not a number.
    """
    if not math.isfinite(value):
        raise ValueError(f"{value} is not a finite number")
    exact = float(value)
    if exact.is_integer() and abs(exact) < 1e15 and not (exact == 0 and math.copysign(1, exact) < 0):
        return str(int(exact))
    return repr(exact)


def number_of(text: str) -> float:
    """Return the number that a text represents.

    Raises:
        ValueError: Not a number, or too large.
    """
    if not re.fullmatch(NUMBER, text.strip(" \t\r\n")):
        raise ValueError(f"{text!r} is not a number")
    value = float(text)
    if not math.isfinite(value):
        raise ValueError(f"{text!r} is too large")
    return value


def bare_value(text: str) -> Value:
    """Return the value of an unmarked text: a boolean for ``true`` and ``false``, a number, else the text itself."""
    if text in ("true", "false"):
        return text == "true"
    return number_of(text) if re.fullmatch(NUMBER, text) else text


def attribute_text(attribute: Attribute, value: Any) -> dict[str, str]:
    """Return the XML attributes, by name, that represent a value.

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
    """Return the value that a text represents; ``marked`` is the text of the ``-as`` attribute beside it, if present.

    Raises:
        ValueError: The text is invalid; the message says what is allowed.
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
                raise ValueError(f'{marked!r} is not "text", the only possible mark')
            return text if marked else bare_value(text)


def _one_of(attribute: Attribute, word: str) -> str:
    if word not in attribute.choices:
        raise ValueError(f"{word!r} is not one of {', '.join(attribute.choices)}")
    return word
