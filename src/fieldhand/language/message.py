"""Messages: English text that keeps its template, so that it can be translated later.

A message is a ``str`` with the English text, usable wherever text is; slices and concatenations lose the template.
All text shown to people is therefore built from messages: sentences or phrases with named placeholders, which a
translation may reorder.
"""

from __future__ import annotations

from collections.abc import Callable, Iterable, Mapping
from copy import copy
from string import Formatter

#: Value of a placeholder: a message is translated with its sentence, any other text is inserted unchanged.
Fill = str | int

_PARTS = Formatter()

#: Context of sentences that event logs store in English.
LOG = "log"


class Message(str):
    """English text with the template it was made from.

    Attributes:
        template: Sentence with named placeholders in braces; the key in the catalogue.
        many: Plural form of the sentence; empty if it has none.
        number: Number that selects the plural form.
        fills: Values of the placeholders.
        context: Distinguishes sentences that are identical in English only.
        labels: Translations by language code that override the catalogue, such as names defined in a file.
        instead: Message used if a catalogue lacks the sentence; by default the English text.
    """

    template: str = ""
    many: str = ""
    number: int = 1
    fills: Mapping[str, Fill] = {}
    context: str = ""
    labels: Mapping[str, str] = {}
    instead: Message | None = None


class Number(str):
    """A number in English notation: a decimal point, and commas between thousands."""

    __slots__ = ()


class Joined(Message):
    """Parts joined by a separator that is the same in every language."""

    sign: str = ""
    parts: tuple[str, ...] = ()


class Shaped(Message):
    """A message whose translated text is passed through a function, such as capitalisation."""

    inner: str = ""
    through: Callable[[str], str] = str


def message(template: str, /, context: str = "", **fills: Fill) -> Message:
    """Return a message for a sentence or phrase.

    Args:
        template: English text with placeholders ("At {place}: {doing}."); an empty value also removes the space before
            its placeholder.
        context: Distinguishes equal English texts with different translations.
        fills: Values of the placeholders.
    """
    made = Message(fill(template, fills))
    made.template, made.fills, made.context = template, fills, context
    return made


def counted(one: str, many: str, /, count: int, context: str = "", **fills: Fill) -> Message:
    """Return a message with singular and plural forms; ``{count}`` is the placeholder of the number."""
    whole: dict[str, Fill] = {"count": count, **fills}
    made = Message(fill(one if count == 1 else many, whole))
    made.template, made.many, made.number, made.fills, made.context = one, many, count, whole, context
    return made


def named(text: str, /, context: str, instead: Message | None = None) -> Message:
    """Return a message for a word from a file, translated if a catalogue contains it in the context.

    Args:
        text: Word in English.
        context: Kind of word.
        instead: Message for languages that lack the word; by default the word itself.
    """
    made = Message(text)
    made.template, made.context, made.instead = text, context, instead
    return made


def recalled(text: str, context: str) -> Message:
    """Return text from a file as a message, to be recognized by the sentences of the context."""
    if isinstance(text, Message):
        return text
    made = Message(text)
    made.template, made.fills, made.context = "{text}", {"text": text}, context
    return made


def kept_in_log(text: str) -> Message:
    """Return text of an event as a message, to be recognized by the sentences that event logs store."""
    return recalled(str(text), LOG)


def labelled(text: str, labels: Mapping[str, str]) -> str:
    """Return a message with translations from a file, by language code."""
    if not labels or not isinstance(text, Message):
        return text
    made = copy(text)
    made.labels = labels
    return made


def joined(sign: str, parts: Iterable[str]) -> Message:
    """Return the parts joined by a separator that is the same in every language, such as a comma or a space."""
    held = tuple(parts)
    made = Joined(sign.join(held))
    made.sign, made.parts = sign, held
    return made


def shaped(text: str, through: Callable[[str], str]) -> Message:
    """Return a message whose text is passed through a function in every language."""
    made = Shaped(through(text))
    made.inner, made.through = text, through
    return made


def fill(template: str, fills: Mapping[str, Fill], join: Callable[[str, str], str] | None = None) -> str:
    """Return a sentence with its placeholders replaced by values.

    Args:
        template: Sentence with placeholders.
        fills: Values by placeholder name.
        join: Joins the text so far and the next part, for languages with contractions.
    """
    if "{" not in template:
        return template
    out, dropped = "", False
    for literal, name, _, _ in _PARTS.parse(template):
        # An empty value also removes one space: the one before it, or the one after it at the start of the text.
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
