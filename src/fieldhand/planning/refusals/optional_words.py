"""The words of a request that may be left out: clauses that tell something, and phrases that describe something.

No clause or phrase is among them that may command, restrict, limit or forbid anything.
"""

from __future__ import annotations

from collections.abc import Iterator, Sequence
from collections.abc import Set as AbstractSet
from dataclasses import dataclass

from fieldhand.planning.english.tokens import Word
from fieldhand.planning.grammar.english import ENGLISH
from fieldhand.planning.grammar.remarks import RESTRICTING
from fieldhand.planning.grammar.tellings import PLACE_WORDS
from fieldhand.planning.grammar.words import edges_of
from fieldhand.robot.model import RobotProfile
from fieldhand.site.model import Site

#: Words with which a clause begins that stands beside a command.
_SUBORDINATING = frozenset({"after", "as", "because", "before", "once", "since", "so", "though", "although", "while"})
_ASKING = frozenset({"how", "what", "which", "who", "why"})
#: Words that join a clause to what stands before it.
_JOINING = frozenset({"and", "but", "so"})
#: Categories of the words with which a statement begins.
_SUBJECTS = frozenset({"DET", "IMPERSONAL", "OWNER", "PEOPLE", "POINTING", "TELLS"})
#: Categories of the verbs of statements.
_VERBS = frozenset({"AUXILIARY", "IS", "STATES"})
#: Categories of the verbs of commands.
_COMMANDS = frozenset({"ACTV", "GO", "GOHOME", "MEASURE", "REPEAT", "RETURN", "STOP", "TAKE", "USE", "VISIT"})
#: Categories of the words with which a phrase begins that describes what stands before it.
_DESCRIBING = frozenset(
    {
        "AGAIN", "ALONG", "AS", "AT", "BESIDE", "FOR", "FROM", "GOING", "NEAR", "ON", "OVER", "START", "THROUGH",
        "WHICH", "WITH",
    }
)  # fmt: skip
#: Categories of words with which no phrase ends, and of one that may stand alone.
_OPEN, _ALONE = _DESCRIBING - {"AGAIN"} | {"DET", "EACH"}, frozenset({"AGAIN"})


@dataclass(frozen=True, kw_only=True)
class OptionalWords:
    """The words of a request, to find those that may be left out.

    Attributes:
        words: Words of the request.
        kinds: Categories of the phrases that each word may be part of.
    """

    words: Sequence[Word]
    kinds: Sequence[AbstractSet[str]]

    @classmethod
    def of(cls, words: Sequence[Word], site: Site, robot: RobotProfile) -> OptionalWords:
        """Return the words of a request with their categories."""
        kinds: list[set[str]] = [set() for _ in words]
        for edge in edges_of(words, ENGLISH.phrases(robot, site), tells=True):
            for k in range(edge.start, edge.end):
                kinds[k].add(edge.category)
        return cls(words=words, kinds=kinds)

    def clauses_with(self, stuck: Sequence[int]) -> Iterator[Sequence[int]]:
        """Yield the clauses that contain some words and only tell something, shortest first.

        Each is given with the comma and the conjunction that join it to the rest.

        Args:
            stuck: Numbers of the words that are not understood, in order.
        """
        if not stuck:
            return
        found = {
            (start, end)
            for start in self._beginnings()
            if start <= stuck[0]
            for end in self._ends(start)
            if end > stuck[0] and end - start < len(self.words)
        }
        for start, end in sorted(found, key=lambda one: one[1] - one[0]):
            if all(start <= k < end for k in self._unknown(stuck)) and self._only_tells(range(start, end)):
                yield range(start, end)

    def phrases_with(self, stuck: Sequence[int]) -> Iterator[Sequence[int]]:
        """Yield the phrases that contain some words and only describe something, shortest first.

        They stand behind what they describe, with a preposition ("from the west side"), a participle ("going south")
        or a relative pronoun ("that are under covers"), or are an adverb ("again"). No place is named in them.

        Args:
            stuck: Numbers of the words that are not understood, in order.
        """
        if not stuck:
            return
        first, last = stuck[0], max(self._unknown(stuck), default=stuck[0])
        begin = max((k + 1 for k in range(first) if self.words[k].kind in ("comma", "stop")), default=1)
        starts = [k for k in range(begin, first + 1) if self._describes(k)]
        ends = self._phrase_ends(last)
        for start, end in sorted(((s, e) for s in starts for e in ends), key=lambda one: one[1] - one[0]):
            alone = end == start + 1
            whole = alone if self._is_adverb(start) else not alone and not self.kinds[end - 1] & _OPEN
            demands = any(self._demands(k) or self.kinds[k] & PLACE_WORDS for k in range(start, end))
            if whole and not demands and not any(self.kinds[k] & _COMMANDS for k in range(start + 1, end)):
                joined = self.words[start - 1].kind == "comma" and start > 1
                yield range(start - 1 if joined else start, end)

    def stated(self, said: Sequence[int]) -> Sequence[int]:
        """Return a clause or phrase without what joins it to the rest."""
        begin, end = 0, len(said)
        while begin < end - 1 and self._joins(said[begin]):
            begin += 1
        while end > begin + 1 and self.words[said[end - 1]].kind in ("comma", "stop"):
            end -= 1
        return said[begin:end]

    def _joins(self, k: int) -> bool:
        return self.words[k].kind == "comma" or self.words[k].norm in ("and", "but")

    def _unknown(self, stuck: Sequence[int]) -> Sequence[int]:
        """Return the words of no phrase.

        A known word is the place at which reading stopped; known words behind it may be read without the clause.
        """
        return [k for k in stuck if not self.kinds[k]]

    def _beginnings(self) -> Iterator[int]:
        """Yield the numbers of the words with which a clause may begin, a comma or conjunction before it included."""
        for k, word in enumerate(self.words):
            joins = word.kind == "comma" or word.norm in _JOINING | _SUBORDINATING
            if k == 0 or self.words[k - 1].kind == "stop" or joins:
                yield k

    def _ends(self, start: int) -> Iterator[int]:
        """Yield the numbers behind the last words with which a clause may end: at a comma, or with its sentence."""
        opens = start == 0 or self.words[start - 1].kind == "stop"
        for k in range(start + 1, len(self.words)):
            if self.words[k].kind == "stop":
                yield k + 1 if opens else k
                return
            if self.words[k].kind == "comma":
                yield k + 1 if opens else k
        yield len(self.words)

    def _phrase_ends(self, last: int) -> Sequence[int]:
        """Return the numbers behind the words with which a phrase may end that contains a word."""
        ends: list[int] = []
        for end in range(last + 1, len(self.words)):
            if self.words[end].kind in ("comma", "stop"):
                return [*ends, end]
            if self.words[end].norm in _JOINING or "THEN" in self.kinds[end] or self.kinds[end] & _DESCRIBING:
                ends.append(end)
        return [*ends, len(self.words)]

    def _describes(self, k: int) -> bool:
        """Return True for a word with which a phrase may begin that describes what stands before it."""
        participle = self.words[k].norm.endswith("ing")
        return bool(self.kinds[k] & _DESCRIBING) or participle or self._is_adverb(k)

    def _is_adverb(self, k: int) -> bool:
        return bool(self.kinds[k] & _ALONE) or self.words[k].norm.endswith("ly")

    def _demands(self, k: int) -> bool:
        """Return True for a word that restricts, limits or forbids something wherever it stands."""
        word = self.words[k]
        return bool(self.kinds[k] & RESTRICTING) or word.kind in ("number", "rank", "unit") or word.norm.endswith("n't")

    def _only_tells(self, clause: Sequence[int]) -> bool:
        """Return True for a clause that tells or asks something, and neither commands, restricts nor forbids."""
        words, kinds, said = self.words, self.kinds, self.stated(clause)
        if len(said) < 3:
            return False
        first, *others = said
        subordinate = words[first].norm in _SUBORDINATING
        if any(self._demands(k) for k in (others if subordinate else said)):
            return False
        if subordinate:
            subject, *rest = (kinds[k] for k in others)
            verb = any(one & (_VERBS | _COMMANDS) for one in rest) or ("DET" not in subject and not rest[0])
            return bool(subject & _SUBJECTS) and verb  # "before the flurb" names a place
        if not self._is_sentence(clause) or any(kinds[k] & _COMMANDS and not kinds[k] & _VERBS for k in said):
            return False  # beside a command, words without a conjunction may be an item of its list
        states = bool(kinds[first]) and any(kinds[k] & _VERBS for k in others[:3])
        return states or words[first].norm in _ASKING or bool(kinds[first] & _SUBJECTS)

    def _is_sentence(self, clause: Sequence[int]) -> bool:
        """Return True for a clause that is a sentence by itself."""
        begins = clause[0] == 0 or self.words[clause[0] - 1].kind == "stop"
        return begins and (clause[-1] == len(self.words) - 1 or self.words[clause[-1]].kind == "stop")
