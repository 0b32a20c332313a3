"""Words that are not known, each with a reason and what may have been meant."""

from __future__ import annotations

from collections.abc import Sequence

from fieldhand.planning.english.languages import language_of
from fieldhand.planning.english.lexicon import Lexicon
from fieldhand.planning.english.tokens import Term
from fieldhand.planning.planner import Reason


def unknown_words(terms: Sequence[Term], lexicon: Lexicon) -> tuple[Reason, ...]:
    """A reason for each word that is not known, and for what is known but cannot be done yet."""
    known = [t for t in terms if t.kind == "NOTYET"]
    reasons = [Reason(what=f"'{t.text}' is not possible yet", said=(t.span,), advice=str(t.value)) for t in known]
    nameless = [t for k, t in enumerate(terms) if t.kind == "UNKNOWN" and k and _called(terms[k - 1])]
    reasons += [_no_such(terms[terms.index(t) - 1], t, lexicon) for t in nameless]
    strange = [t for t in terms if t.kind == "UNKNOWN" and t not in nameless]
    if strange:
        words = ", ".join(f"'{t.text}'" for t in strange[:12])
        more = f" and {len(strange) - 12} more" if len(strange) > 12 else ""
        near = [f"'{n[0]}' for '{t.text}'" for t in strange[:12] if (n := lexicon.nearest(t.text))]
        advice = f"did you mean {', '.join(near)}?" if near else "say it in other words"
        if language := language_of(t.text for t in strange):
            advice = (
                f"this seems to be {language}, and only English is understood: say it in English, or plan it with a "
            )
            advice += "language model (--planner llm)"
        reasons.append(
            Reason(what=f"not understood: {words}{more}", said=tuple(t.span for t in strange), advice=advice)
        )
    return tuple(reasons)


def _called(term: Term) -> str:
    """What a name is expected behind: a row or a block; nothing else is called by names of its own."""
    return "row" if term.kind == "ROW" else "block" if term.text.lower() in ("block", "blocks") else ""


def _no_such(head: Term, name: Term, lexicon: Lexicon) -> Reason:
    """A row or a block that the site does not have."""
    planting, kind = lexicon.site.planting, _called(head)
    names = list(dict.fromkeys(one.name for one in (planting.rows if kind == "row" else planting.blocks)))
    there = f"{', '.join(names[:6])}{' and more' if len(names) > 6 else ''}"
    advice = f"this site has {kind} {there}" if names else "no rows are known on this site"
    return Reason(what=f"there is no {kind} '{name.text}'", said=(name.span,), advice=advice)
