"""Find what no plan can hold, wherever and however it is said: times of day, schedules, speeds, waiting.

These are looked for in the words as they were typed, so that no turn of phrase and no reading can leave them out.
"""

from __future__ import annotations

import re
from collections.abc import Sequence
from functools import cache

from fieldhand.language import message, named
from fieldhand.planning.english.tokens import Word
from fieldhand.planning.english.vocabulary import vocabulary
from fieldhand.planning.planner import Reason


def unheld(words: Sequence[Word]) -> tuple[Reason, ...]:
    """Return a reason for each stretch of the typed words that no plan can hold; none if there is none."""
    starts: dict[int, int] = {}
    ends: dict[int, int] = {}
    text = ""
    for k, word in enumerate(words):
        starts[len(text)] = k
        text += word.norm
        ends[len(text)] = k
        text += " "
    reasons: list[Reason] = []
    for pattern, advice in _patterns():
        for match in pattern.finditer(text):
            first, last = starts.get(match.start()), ends.get(match.end())
            if first is not None and last is not None:
                said = " ".join(word.text for word in words[first : last + 1])
                span = (words[first].start, words[last].end)
                reasons.append(
                    Reason(
                        what=message("'{said}' is not possible yet", said=said),
                        said=(span,),
                        advice=named(advice, "advice"),
                    )
                )
    return tuple(reasons)


@cache
def _patterns() -> tuple[tuple[re.Pattern[str], str], ...]:
    """Return the tables ``unheld`` of vocabulary.toml, each as one pattern with its advice."""
    return tuple(
        (re.compile(rf"(?<!\S)(?:{'|'.join(known['said'])})(?!\S)"), str(known["advice"]))
        for known in vocabulary()["unheld"]
    )
