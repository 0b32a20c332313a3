"""Extract the answer from a model's reply: a Task, a question or a refusal, with any text around it.

Models wrap XML in prose or Markdown fences or precede it with a chain of thought; small models stop early. A reply
must contain exactly one complete document. Anything else is rejected with a reason that is sent to the model.
"""

from __future__ import annotations

import re
from dataclasses import dataclass
from typing import Literal
from xml.sax.saxutils import unescape

from fieldhand.planning.llm.chat import Reply
from fieldhand.planning.llm.display_text import visible_line

#: The root elements of the three kinds of answer.
AnswerKind = Literal["task", "question", "refusal"]

#: Maximum length of an answer in characters; longer ones come from a model that repeats itself.
LONGEST_ANSWER = 60_000

#: Maximum number of choices of a question.
MOST_CHOICES = 20
#: Maximum length in characters of a question, choice or reason; longer text is cut.
LONGEST_SENTENCE = 600

#: Chains of thought that open-weight models write before their answer.
_THOUGHT = re.compile(r"<(think|thinking|reasoning)>.*?(</\1>|\Z)", re.DOTALL | re.IGNORECASE)
_COMMENT = re.compile(r"<!--.*?-->", re.DOTALL)
_OPENING = re.compile(r"<(task|question|refusal)(?=[\s>/])[^<>]*>")
_CHOICE = re.compile(r"<choice(?:\s[^<>]*)?>(.*?)</choice>", re.DOTALL)
_TAG = re.compile(r"</?[a-zA-Z][^<>]*>")


@dataclass(frozen=True, kw_only=True)
class TaskAnswer:
    """A Task document in draft form, not yet validated."""

    document: str


@dataclass(frozen=True, kw_only=True)
class QuestionAnswer:
    """A question to the operator."""

    question: str
    choices: tuple[str, ...] = ()


@dataclass(frozen=True, kw_only=True)
class RefusalAnswer:
    """A refusal: the model reports that the request cannot be carried out here."""

    reason: str


@dataclass(frozen=True, kw_only=True)
class Unusable:
    """An unusable reply, with the reason as a sentence for the model."""

    reason: str
    truncated: bool = False


ModelAnswer = TaskAnswer | QuestionAnswer | RefusalAnswer | Unusable


def read_answer(reply: Reply) -> ModelAnswer:
    """Parse a reply; an unreadable one returns :class:`Unusable`, so that no exception is raised."""
    if len(reply.text) > LONGEST_ANSWER:
        return Unusable(reason=f"The answer was longer than {LONGEST_ANSWER} characters.")
    text = _without_comments(_THOUGHT.sub("", reply.text)).strip()
    if reply.finish == "content_filter":
        return Unusable(reason="The answer was withheld by the content filter of the endpoint.")
    if not text:
        return _cut_off() if reply.finish == "length" else Unusable(reason="The answer was empty.")
    documents, unclosed = _documents(text)
    if unclosed or (not documents and reply.finish == "length"):
        return _cut_off()
    if not documents:
        return Unusable(reason="The answer held neither <task>, <question> nor <refusal>.")
    if len(set(documents)) > 1:
        return Unusable(reason=f"The answer held {len(documents)} documents; give exactly one.")
    return _understand(*documents[0])


def _without_comments(text: str) -> str:
    """Return the text without comments but with their line breaks, so that line numbers match the model's text.

    The search stops after the last comment end, since trying every opening without an end takes quadratic time.
    """
    before, end, after = text.rpartition("-->")
    return _COMMENT.sub(lambda m: "\n" * m[0].count("\n"), before + end) + after


def _documents(text: str) -> tuple[list[tuple[AnswerKind, str]], bool]:
    """Return every complete document of the text, and True if the last one is incomplete."""
    found: list[tuple[AnswerKind, str]] = []
    position = 0
    while opening := _OPENING.search(text, position):
        name: AnswerKind = opening[1]  # type: ignore[assignment]  # the pattern knows no other names
        if opening[0].endswith("/>"):
            found.append((name, opening[0]))
            position = opening.end()
            continue
        end = text.find(f"</{name}>", opening.end())
        if end < 0:
            return found, not found
        end += len(name) + 3
        # Prose may mention the element before the document starts ("here is the <task>:"): the last one counts.
        start = [m.start() for m in _OPENING.finditer(text, opening.start(), end) if m[1] == name][-1]
        found.append((name, text[start:end]))
        position = end
    return found, False


def _understand(kind: AnswerKind, document: str) -> ModelAnswer:
    match kind:
        case "task":
            return TaskAnswer(document=document)
        case "refusal":
            reason = _words(document)
            return RefusalAnswer(reason=reason) if reason else Unusable(reason="The refusal gave no reason.")
        case "question":
            before, end, after = document.rpartition("</choice>")  # as with comments: past it, none is looked for
            choices = _CHOICE.findall(before + end)[:MOST_CHOICES]
            question = _words(_CHOICE.sub(" ", before + end) + after)
            if not question:
                return Unusable(reason="The question asked nothing.")
            return QuestionAnswer(question=question, choices=tuple(filter(None, map(_words, choices))))


def _words(markup: str) -> str:
    """Return the text of markup on one line, without tags and invisible characters, for display to a person."""
    return visible_line(unescape(_TAG.sub(" ", markup), {"&quot;": '"', "&apos;": "'"}), LONGEST_SENTENCE)


def _cut_off() -> Unusable:
    return Unusable(
        reason="The answer was cut off before its end. Give the whole document again, shorter, with nothing around it.",
        truncated=True,
    )
