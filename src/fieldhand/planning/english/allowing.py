"""What makes a step optional: "if the battery allows", "if there is enough time", "time permitting", "if possible".

Only what asks for no number: "if the battery is below 30 %" is a condition.
"""

from __future__ import annotations

import re

from fieldhand.planning.english.tokens import Term

#: What may run short, with the words before it; "the battery and the time".
_MEANS = r"(?:<DET>|<LEFT>|<ANY>|<ENOUGH>|<STILL>)*(?:<BATTERY>|<TIMES>|<MEANS>)+(?:<LEFT>|<MEANS>)*"
_ALL_MEANS = rf"{_MEANS}(?:<AND>{_MEANS})*"
_FOR_IT = r"(?:(?:<FOR>)?(?:<IT>|<WHICH>))?"
#: Behind these words a number or a level would make it a condition.
_NO_TEST = r"(?!<CMP>|<LEVEL>|<NUM>|<AMOUNT>|<BETWEEN>|<IS>|<ISNOT>|<NOT>|<UPTO>|<AT><NUM>)"
#: How it is said, over the kinds of the terms.
_PATTERNS = tuple(
    re.compile(pattern)
    for pattern in (
        # "if the battery (still) allows it", "as long as time and charge permit"
        rf"<IF>{_ALL_MEANS}(?:<STILL>)?<ALLOW>{_FOR_IT}",
        # "if the battery is enough for it", "if any time is left", "if enough charge remains"
        rf"<IF>{_ALL_MEANS}<IS>(?:<STILL>)?(?:<LEFT>|<ENOUGH>)+{_FOR_IT}",
        rf"<IF>(?:<STILL>)?(?:<ENOUGH>|<ANY>|<DET>)(?:<BATTERY>|<TIMES>|<MEANS>)+<IS>{_NO_TEST}{_FOR_IT}",
        # "if there is (still) enough time left for it", "if it has battery left"
        rf"<IF>(?:<IT>)?(?:<STILL>)?<IS>{_ALL_MEANS}{_FOR_IT}{_NO_TEST}(?:<AT>(?:<DET>)?<FINISH>)?",
        # "time permitting"
        r"(?:<DET>)?(?:<BATTERY>|<TIMES>|<MEANS>)+<PERMITTING>",
        # "if possible within the budget", "if it fits in the battery"
        rf"<FITS>(?:(?:<INSIDE>|<AT>|<WITH>){_MEANS})?",
    )
)


def with_allowances(terms: list[Term]) -> list[Term]:
    """Each of these phrases as one term of kind ``FITS``."""
    for pattern in _PATTERNS:
        pieces = [f"<{term.kind}>" for term in terms]
        starts = [sum(map(len, pieces[:k])) for k in range(len(pieces))]
        for match in reversed(list(pattern.finditer("".join(pieces)))):
            inside = [k for k, at in enumerate(starts) if match.start() <= at < match.end()]
            first, last = terms[inside[0]], terms[inside[-1]]
            text = " ".join(terms[k].text for k in inside)
            made = Term(kind="FITS", text=text, start=first.start, end=last.end)
            terms = [*terms[: inside[0]], made, *terms[inside[-1] + 1 :]]
    return terms
