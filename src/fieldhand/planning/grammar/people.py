"""Words of a request that only say who asks for it: senders, and people who want something."""

from __future__ import annotations

from collections.abc import Sequence
from collections.abc import Set as AbstractSet

from fieldhand.planning.english.tokens import Word

#: Categories of the words for people and what a request is made for, and of those that may stand beside them.
_PEOPLE = frozenset({"PAPERWORK", "PEOPLE"})
_BESIDE_PEOPLE = frozenset({"AT", "DET", "FROM", "OF", "OWNER"})
#: Categories of the verbs of wanting.
_WANTING = frozenset({"SAYS", "WANTS"})
#: Words behind which a sender signs.
_SIGNING = frozenset(
    {"best", "cheers", "faithfully", "regards", "respectfully", "sincerely", "thanks", "truly", "wishes"}
)
#: Words at the beginning of a sentence that name nobody.
_NOBODY = frozenset(
    {"anybody", "anyone", "barely", "hardly", "nobody", "noone", "rarely", "scarcely", "seldom", "whoever"}
)
#: Maximum number of words of a sender, and of somebody who wants something.
_LONGEST = 6


def who_wants(sentence: Sequence[int], words: Sequence[Word], kinds: Sequence[AbstractSet[str]]) -> Sequence[int]:
    """Return the words that say who wants it ("My professor wants ...", "Ramon says ..."); empty if there are none."""
    begin = next((at for at, k in enumerate(sentence) if kinds[k] & _WANTING), 0)
    people = sentence[:begin]
    if not 0 < begin <= _LONGEST or not _are_people(people, words, kinds):
        return ()
    end = next((at for at in range(begin, len(sentence)) if not kinds[sentence[at]] & _WANTING), 0)
    return sentence[:end]


def sender(words: Sequence[Word], kinds: Sequence[AbstractSet[str]]) -> Sequence[int]:
    """Return who signs a request at its end ("Regards, the office", "Thanks, Maria"); empty if nobody does."""
    end = len(words)
    while end > 0 and words[end - 1].kind == "stop":
        end -= 1
    begin = next((k for k in range(end - 1, max(end - 1 - _LONGEST, 0), -1) if words[k].kind in ("comma", "stop")), 0)
    signs = begin > 0 and words[begin - 1].norm in _SIGNING and (words[begin].text[:1] in ",\n")
    signed = range(begin + 1, end)
    return signed if signs and _are_people(signed, words, kinds) else ()


def _are_people(said: Sequence[int], words: Sequence[Word], kinds: Sequence[AbstractSet[str]]) -> bool:
    """Return True for words that name people: "my foreman", "Ramon", "Dr Lopez of the lab".

    An unknown word is a name if it has a capital letter and no article, or is all that an article has behind it.
    """
    if any(words[k].norm in _NOBODY for k in said):
        return False
    article = bool(kinds[said[0]] & {"DET", "OWNER"})
    named = [k for k in said if not kinds[k] and (words[k].text[:1].isupper() or (article and len(said) == 2))]
    described = [k for k in said if kinds[k] and not kinds[k] - _PEOPLE - {"ASIDE"}]
    if not described and (not named or (article and len(said) > 2)):
        return False
    return all(k in (*named, *described) or kinds[k] & _BESIDE_PEOPLE for k in said)
