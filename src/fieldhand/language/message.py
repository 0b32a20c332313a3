"""Messages: English text that remembers the sentence it was made of, so that it can be said again in another language.

A message is a ``str``, its English, and goes wherever text goes; only what is cut out of it or glued to it forgets the
sentence. Whatever a person reads is therefore made of messages: sentences or phrases with named placeholders, whose
order a translation may change.
"""

from __future__ import annotations

from collections.abc import Callable, Iterable, Mapping
from copy import copy
from string import Formatter

#: Fills of a placeholder: a message is said in the language of the sentence, any other text stands as it is.
Fill = str | int

_PARTS = Formatter()

#: Context of sentences that event logs keep, in English.
LOG = "log"


class Message(str):
    """English text with the sentence it came from.

    Attributes:
        template: The sentence, with named placeholders in braces: the key of the catalogue.
        many: The sentence for more than one; empty where it does not count.
        number: How many, where it counts.
        fills: What stands in the placeholders.
        context: Tells apart sentences that are the same in English only.
        labels: What some languages say for it whatever their catalogue has, by code: names that a file brings along.
        instead: What to say where a catalogue does not have the sentence; else the English.
    """

    template: str = ""
    many: str = ""
    number: int = 1
    fills: Mapping[str, Fill] = {}
    context: str = ""
    labels: Mapping[str, str] = {}
    instead: Message | None = None


class Number(str):
    """A number in figures, as English writes it: a point before decimals, commas between thousands."""

    __slots__ = ()


class Joined(Message):
    """Parts put together by a sign that no language changes."""

    sign: str = ""
    parts: tuple[str, ...] = ()


class Shaped(Message):
    """A message whose text goes through a function in every language: its first letter made large, say."""

    inner: str = ""
    through: Callable[[str], str] = str


def message(template: str, /, context: str = "", **fills: Fill) -> Message:
    """A sentence or phrase.

    Args:
        template: As English says it, with placeholders ("At {place}: {doing}."); an empty fill takes the space before
            its placeholder with it.
        context: Where the same English is said in different ways elsewhere.
        fills: What stands in the placeholders.
    """
    made = Message(fill(template, fills))
    made.template, made.fills, made.context = template, fills, context
    return made


def counted(one: str, many: str, /, count: int, context: str = "", **fills: Fill) -> Message:
    """A sentence that depends on a number, which stands in it as ``{count}`` where it is said."""
    whole: dict[str, Fill] = {"count": count, **fills}
    made = Message(fill(one if count == 1 else many, whole))
    made.template, made.many, made.number, made.fills, made.context = one, many, count, whole, context
    return made


def named(text: str, /, context: str, instead: Message | None = None) -> Message:
    """A word that comes from a file, said in another language if its catalogue has it in that context.

    Args:
        text: The word, as English says it.
        context: Of which kind of word it is.
        instead: What other languages say where they do not have it; else the word itself.
    """
    made = Message(text)
    made.template, made.context, made.instead = text, context, instead
    return made


def recalled(text: str, context: str) -> Message:
    """Text that was a message once and has been in a file since: known again by the sentences of that context."""
    if isinstance(text, Message):
        return text
    made = Message(text)
    made.template, made.fills, made.context = "{text}", {"text": text}, context
    return made


def kept_in_log(text: str) -> Message:
    """Return text of an event as a message, known again by the sentences that event logs keep."""
    return recalled(str(text), LOG)


def labelled(said: str, labels: Mapping[str, str]) -> str:
    """A message with what a file says for it in other languages, by their codes."""
    if not labels or not isinstance(said, Message):
        return said
    made = copy(said)
    made.labels = labels
    return made


def joined(sign: str, parts: Iterable[str]) -> Message:
    """Parts with a sign between them that means the same everywhere: a comma, a space."""
    held = tuple(parts)
    made = Joined(sign.join(held))
    made.sign, made.parts = sign, held
    return made


def shaped(text: str, through: Callable[[str], str]) -> Message:
    """A message whose text goes through a function, in whichever language."""
    made = Shaped(through(text))
    made.inner, made.through = text, through
    return made


def fill(template: str, fills: Mapping[str, Fill], join: Callable[[str, str], str] | None = None) -> str:
    """A sentence with its placeholders filled.

    Args:
        template: The sentence.
        fills: By the names of the placeholders.
        join: Puts what follows behind what stands there already, where a language melts them together.
    """
    if "{" not in template:
        return template
    out, dropped = "", False
    for literal, name, _, _ in _PARTS.parse(template):
        # The space around an empty fill goes with it: the one before it, or behind it where it comes first.
        out += literal.removeprefix(" ") if dropped and not out else literal
        if name is None:
            continue
        value = str(fills[name])
        if not value:
            out, dropped = out.removesuffix(" "), True
        elif join is not None:
            out = join(out, value)
        else:
            out += value
    return out
