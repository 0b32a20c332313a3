"""Words that are not known, each with a reason and what may have been meant."""

from __future__ import annotations

from collections.abc import Sequence

from fieldhand.language import joined, message, named
from fieldhand.language.words import some_names
from fieldhand.planning.english.faults import PLAINLY
from fieldhand.planning.english.languages import language_of
from fieldhand.planning.english.lexicon import Lexicon
from fieldhand.planning.english.tokens import Term
from fieldhand.planning.planner import Reason


def unknown_words(terms: Sequence[Term], lexicon: Lexicon) -> tuple[Reason, ...]:
    """A reason for each word that is not known, and for what is known but cannot be done yet."""
    known = [t for t in terms if t.kind == "NOTYET"]
    reasons = [
        Reason(
            what=message("'{said}' is not possible yet", said=t.text),
            said=(t.span,),
            advice=named(str(t.value), "advice"),
        )
        for t in known
    ]
    nameless = [t for k, t in enumerate(terms) if t.kind == "UNKNOWN" and k and _called(terms[k - 1])]
    reasons += [_no_such(terms[terms.index(t) - 1], t, lexicon) for t in nameless]
    strange = [t for t in terms if t.kind == "UNKNOWN" and t not in nameless]
    if strange:
        words = some_names([message("'{said}'", said=t.text) for t in strange], 12)
        near = [
            message("'{near}' for '{said}'", near=n[0], said=t.text)
            for t in strange[:12]
            if (n := lexicon.nearest(t.text))
        ]
        advice = message("did you mean {near}?", near=joined(", ", near)) if near else PLAINLY
        if language := language_of(t.text for t in strange):
            advice = message(
                "this seems to be {language}, and only English and Spanish are understood: say it in English, or"
                " plan it with a language model (--planner llm)",
                language=named(language, "language"),
            )
        reasons.append(
            Reason(
                what=message("not understood: {words}", words=words),
                said=tuple(t.span for t in strange),
                advice=advice,
                unknown=True,
            )
        )
    return tuple(reasons)


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
    return Reason(what=what, said=(name.span,), advice=has if names else message("no rows were found on this site"))
