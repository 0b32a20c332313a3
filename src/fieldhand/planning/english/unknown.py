"""Words that are not known, each with a reason and what may have been meant."""

from __future__ import annotations

from collections.abc import Sequence

from fieldhand.language import message, named
from fieldhand.language.words import some_names
from fieldhand.planning.english.faults import PLAINLY, Question
from fieldhand.planning.english.languages import language_of
from fieldhand.planning.english.lexicon import Lexicon
from fieldhand.planning.english.tokens import Term, Word
from fieldhand.planning.planner import Reason

#: Numbers to choose from in place of a vague one.
_NUMBERS = ("3", "5", "10")
#: Vague numbers that a number can replace.
_VAGUE = frozenset({"a few", "several", "some of", "a number of", "lots of", "plenty of"})


def check_numbers(terms: Sequence[Term]) -> None:
    """Ask for the number where a request says "a few" and is understood otherwise.

    Raises:
        Question: How many are meant.
    """
    unclear = [k for k, term in enumerate(terms) if term.kind in ("UNKNOWN", "NOTYET")]
    vague = [k for k in unclear if terms[k].text.lower() in _VAGUE and not (k and terms[k - 1].kind in ("EACH", "DET"))]
    if vague and vague == unclear:
        term = terms[vague[0]]
        after = " of" if term.text.lower() == "some of" else ""
        raise Question(
            message("'{said}': how many?", context="question", said=term.text),
            _NUMBERS,
            terms=(term,),
            words=tuple(f"{number}{after}" for number in _NUMBERS),
        )


def unknown_words(terms: Sequence[Term], lexicon: Lexicon) -> tuple[Reason, ...]:
    """A reason for each word that is not known, and for what is known but cannot be done yet."""
    known = [t for t in terms if t.kind == "NOTYET"]
    reasons = [
        Reason(
            what=message("'{said}' is not possible yet", said=t.text),
            said=(t.span,),
            advice=named(str(t.value), "advice"),
            final=True,
        )
        for t in known
    ]
    nameless = [t for k, t in enumerate(terms) if t.kind == "UNKNOWN" and k and _called(terms[k - 1])]
    reasons += [_no_such(terms[terms.index(t) - 1], t, lexicon) for t in nameless]
    strange = [t for t in terms if t.kind == "UNKNOWN" and t not in nameless]
    if strange:
        reasons.append(not_understood(strange))
    return tuple(reasons)


def not_understood(words: Sequence[Term | Word], advice: str = PLAINLY) -> Reason:
    """Return a reason for unknown words, which names their language if it is another one.

    Args:
        words: Unknown words, at least one.
        advice: What to do if they are English.
    """
    texts = [word.text for word in words]
    if language := language_of(texts):
        advice = message(
            "this seems to be {language}, and only English and Spanish are understood: say it in English, or plan it"
            " with a language model (--planner llm)",
            language=named(language, "language"),
        )
    quoted = some_names([message("'{said}'", said=text) for text in texts], 12)
    return Reason(
        what=message("not understood: {words}", words=quoted),
        said=tuple((word.start, word.end) for word in words),
        advice=advice,
        unknown=True,
    )


def _called(term: Term) -> str:
    """What a name is expected behind: a row or a block; nothing else is called by names of its own."""
    return "row" if term.kind == "ROW" else "block" if term.text.lower() in ("block", "blocks") else ""


def _no_such(head: Term, name: Term, lexicon: Lexicon) -> Reason:
    """A row or a block that the site does not have."""
    planting, kind = lexicon.site.planting, _called(head)
    names = list(dict.fromkeys(one.name for one in (planting.rows if kind == "row" else planting.blocks)))
    there = some_names(names, 6)
    if kind == "row":
        what, has = (
            message("there is no row '{said}'", said=name.text),
            message("this site has row {there}", there=there),
        )
    else:
        what = message("there is no block '{said}'", said=name.text)
        has = message("this site has block {there}", there=there)
    advice = has if names else message("no rows were found on this site")
    return Reason(what=what, said=(name.span,), advice=advice, final=True, instead=names[0] if names else "")
