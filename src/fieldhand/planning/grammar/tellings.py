"""Sentences and clauses that tell something and ask for nothing: greetings, memories, opinions, idle questions."""

from __future__ import annotations

from collections.abc import Mapping, Sequence
from collections.abc import Set as AbstractSet
from dataclasses import dataclass

from fieldhand.planning.english.tokens import Word

#: Categories of words that no telling contains: conditions, prohibitions, numbers, limits, orders, demands, captures.
_NEVER = frozenset(
    {
        "ACTV", "ALLOW", "APART", "ASFIT", "ASMANY", "ATLEAST", "BATTERY", "BEFORE", "CAMERA", "CLIP", "CLOCKWISE",
        "CORRECTION", "COUNT", "DEMANDS", "DISTINCT", "EVENLYALONG", "EVENLYSPACED", "EXCEPT", "FARAPART", "FITS",
        "GOHOME", "IF", "IFSO", "INCASE", "INORDER", "INSTEAD", "INTERVAL", "ISNOT", "KEEP", "LAST", "LIMIT",
        "LIMITEDTO", "MAXIMISE", "MUST", "NOORDER", "NOT", "NOTYET", "NOUN", "NUM", "ONLY", "ORD", "ORDERED",
        "OTHERWISE", "PART", "PASSON", "READING", "REPEAT", "REVERSE", "SAMEFOR", "SHOULD", "SORT", "STAY", "STOP",
        "TIMES", "TIMEWORD", "TOPIC", "TRY", "UNIT", "UNLESS", "UNTIL", "UPTO", "WANTED", "WANTS", "WITHOUT",
    }
)  # fmt: skip
#: Categories of words that name trees or a part of the site.
PLACE_WORDS = frozenset(
    {
        "AISLE", "ATTRVAL", "BLOCKNAME", "CHARGER", "CORNER", "DIR", "EDGE", "GATENAME", "HALF", "MIDDLE", "MOST",
        "OLDS", "QUARTER", "ROW", "ROWNAME", "SOMEOFTHEM", "START", "SUPER", "TREE", "TREEID", "ZONE",
    }
)  # fmt: skip
#: Categories of words that a place may have beside these, and words that join its parts.
_IN_PLACES = frozenset({"AT", "DET", "OF", "OLD", "PLOT", "VAGUEADJ"})
_JOINTS = frozenset({"and", "to", "through", "with", "versus", "-", "\u2013", "&"})
#: Categories of the verbs of commands.
_COMMANDS = frozenset({"GO", "MEASURE", "TAKE", "USE", "VISIT"})
#: Categories of these that describe other words as well ("most", "northern").
_DESCRIBING = frozenset({"DIR", "MOST", "SUPER"})
#: Categories of the verbs of tellings.
_VERBS = frozenset({"AUXILIARY", "IS", "STATES"})
#: Categories of people, and endings of the adjectives by which an unknown word is told from a noun.
_PEOPLE = frozenset({"PAPERWORK", "PEOPLE"})
_ADJECTIVES = ("ous", "ful", "ing", "ish", "ed", "able", "ible", "ive", "ic", "less")
#: Categories of what grows between rows, of which something is told ("the weeds").
_GROWTH = frozenset({"AISLEGROUND", "GRASSWORD"})
#: Categories of words between a subject and its verb.
_ADVERBS = frozenset({"FILLER", "HARMLESS", "INEACHCASE"})
#: Categories of words that refer to what was said before.
_BACK = frozenset({"IT", "ITS", "ONE", "OTHERS", "REFERRING", "SAME", "THERE"})
#: Periods at the end of what is told ("this year").
_LATELY = frozenset({"year", "season", "week", "month", "summer", "spring", "autumn", "winter"})
#: Categories of words that may stand before a subject.
_OPENING = frozenset({"AND", "ASIDE", "CONTRAST", "FILLER", "OPENER"})


@dataclass(frozen=True, kw_only=True)
class Telling:
    """A sentence or clause that asks for nothing.

    Attributes:
        left_out: Numbers of its words, but for those of a place that the next sentence refers to.
        topic: Number of the word before that place, which stands for "this is about"; None without such a place.
    """

    left_out: frozenset[int]
    topic: int | None = None


@dataclass(frozen=True, kw_only=True)
class WordKinds:
    """The kinds that the words of a request can have.

    Attributes:
        words: The words.
        kinds: Categories of the phrases that each word is part of; none for unknown words.
        likely: Categories of the words that misspelt ones are likely to mean; no misspelt command is a telling.
        captures: What each word can capture.
    """

    words: Sequence[Word]
    kinds: Sequence[AbstractSet[str]]
    likely: Mapping[int, AbstractSet[str]]
    captures: Mapping[int, AbstractSet[object]]

    def may_be(self, k: int, categories: AbstractSet[str]) -> bool:
        """Return True if a word, or the one that it is a misspelling of, is of one of some categories."""
        return bool((self.kinds[k] | self.likely.get(k, frozenset())) & categories)

    def is_past(self, k: int) -> bool:
        """Return True for a word with the ending of a verb in the past."""
        return self.words[k].norm.endswith("ed")

    def names_place(self, k: int) -> bool:
        """Return True for a word that names trees or a part of the site."""
        return bool(self.kinds[k] & (PLACE_WORDS - _DESCRIBING))


def telling(said: Sequence[int], known: WordKinds, *, sentence: bool) -> Telling | None:
    """Return what a sentence, or a clause between commas, tells; None if it may ask for something.

    A telling has a subject, other than the robot, and a verb: an unknown one, one in the past, or one of thinking,
    feeling and planting. One with a place needs a verb of the last kind. If the next sentence refers to that place, the
    place is kept as what the request is about.

    Args:
        said: Numbers of its words.
        known: What the words of the request can be.
        sentence: True for a whole sentence.
    """
    begun = _begun(said, known)
    if len(begun) < 2 or any(known.kinds[k] & {"DEMANDS", "ONLY"} for k in said if k < begun[0]):
        return None
    kinds = [known.kinds[k] for k in begun]
    hopes = any("HOPES" in one for one in kinds[:2])
    asks = _is_question(begun, known)
    if sentence and _gives_reason(begun, known):
        return Telling(left_out=frozenset(said))
    if not (hopes or asks or _has_verb(begun, known, sentence=sentence)):
        return None
    if any(_may_ask(at, begun, known, hopes=hopes, asks=asks) for at in range(len(begun))):
        return None
    states = any("STATES" in one for one in kinds)
    refers_back = _refers_back(said[-1] + 1, known)
    if not any(known.may_be(k, PLACE_WORDS) for k in begun):
        first = begun[0] <= _first_word(known)
        if not first and (refers_back or not (states or asks or hopes or _describes(begun, known))):
            return None
        return Telling(left_out=frozenset(said))
    adds = any("ADDS" in one for one in kinds)
    if not sentence or asks or adds or not (states or "THEREIS" in kinds[0]):
        return None
    if not refers_back:
        return Telling(left_out=frozenset(said)) if states else None
    place = _only_place(begun, known)
    if not place or place[0] == begun[0]:
        return None
    topic = place[0] - 1
    single = any("CORNER" in known.kinds[k] for k in place)
    if "OF" in known.kinds[topic] or ("INDEFINITE" in known.kinds[place[0]] and not single):
        return None  # "one of the Carmels"
    return Telling(left_out=frozenset(said) - {topic, *place}, topic=topic)


def _describes(begun: Sequence[int], known: WordKinds) -> bool:
    """Return True unless "it" or "that", which may be the work, is or does something ("it's optional").

    It may be something ("that's the short one").
    """
    if "IMPERSONAL" not in known.kinds[begun[0]]:
        return True
    said = next((k for k in begun[1:] if not known.kinds[k] & (_VERBS | _ADVERBS)), begun[0])
    return "DET" in known.kinds[said]


def _first_word(known: WordKinds) -> int:
    """Return the number of the first word that is neither a greeting nor an aside."""
    return next((k for k, kinds in enumerate(known.kinds) if "TELLS" in kinds or not kinds & _OPENING), 0)


def _begun(said: Sequence[int], known: WordKinds) -> Sequence[int]:
    """Return a sentence from its subject on, without greetings, "and", and "in my day" before it."""
    opening = (at for at, k in enumerate(said) if "BECAUSE" not in known.kinds[k])
    at = next((at for at in opening if "TELLS" in known.kinds[said[at]] or not known.kinds[said[at]] & _OPENING), 0)
    begun = said[at:]
    if begun and "AT" in known.kinds[begun[0]]:  # "in my day we ..."
        begins = (at for at, k in enumerate(begun[:5]) if known.kinds[k] & {"TELLS"} and "DET" not in known.kinds[k])
        return begun[next(begins, 0) :]
    return begun


def _has_verb(begun: Sequence[int], known: WordKinds, *, sentence: bool) -> bool:
    """Return True for words that begin with a subject and contain a verb, which an unknown word may be.

    Behind "the" and "a" an unknown word may be a noun ("the plums"), and a clause may be an item of a list.
    """
    first = known.kinds[begun[0]]
    if "TELLS" not in first:
        return _is_about_someone(begun, known)
    if any(_is_person_is(at, begun, known) for at in range(1, len(begun))):
        return True
    verbs = [at for at, k in enumerate(begun) if known.kinds[k] & _VERBS or known.is_past(k)]
    if begun[0] > 0 and "BECAUSE" in known.kinds[begun[0] - 1]:
        return bool(verbs) or not all(known.kinds[k] for k in begun)
    if not first & {"DET", "LATELY"}:
        verb = next((k for k in begun[1:] if not known.kinds[k] & _ADVERBS), begun[0])
        return bool(verbs) or not known.kinds[verb]
    if "LATELY" in first:
        return bool(verbs)
    if "POINTING" in first:
        return 1 in verbs
    if sentence:
        return any(at > 0 for at in verbs) or (len(begun) > 3 and sum(not known.kinds[k] for k in begun) > 1)
    person = bool(known.kinds[begun[1]] & _PEOPLE)
    nouns = begun[1 : verbs[0]] if verbs else ()
    if nouns and known.kinds[begun[verbs[0]]] & {"IS", "AUXILIARY"} and all(known.kinds[k] <= _GROWTH for k in nouns):
        return True  # "the caterpillars are awful" and "the grass is up again"
    return ("OWNER" in first or person) and any(at > 1 for at in verbs)


def _is_person_is(at: int, begun: Sequence[int], known: WordKinds) -> bool:
    """Return True for the "foreman's" of "my foreman's superstitious"."""
    owner = {f"{category}POSS" for category in _PEOPLE}
    follows = begun[at + 1] if at + 1 < len(begun) else begun[at]
    adjective = known.words[follows].norm.endswith(_ADJECTIVES) and not known.kinds[follows]
    return bool(known.kinds[begun[at]] & owner) and adjective


def _is_about_someone(begun: Sequence[int], known: WordKinds) -> bool:
    """Return True for what is told of somebody by name ("Piotr is ill"), whom nothing refers to."""
    named = not known.kinds[begun[0]] and known.words[begun[0]].text[:1].isupper()
    told = "AUXILIARY" in known.kinds[begun[1]] and "IS" in known.kinds[begun[1]]
    return named and told and not _refers_back(begun[-1] + 1, known)


def _is_question(begun: Sequence[int], known: WordKinds) -> bool:
    """Return True for a question that a mission does not answer ("How are you?")."""
    end = begun[-1] + 1
    asks = end < len(known.words) and "?" in known.words[end].text
    return asks and bool(known.kinds[begun[0]] & {"HOW", "IS"})


def _gives_reason(begun: Sequence[int], known: WordKinds) -> bool:
    """Return True for a question behind which the work stands that answers it ("Does the oak take water? Compare ...").

    The work says by itself what is done and where, and no condition refers to the answer.
    """
    end = begun[-1] + 1
    if end + 1 >= len(known.words) or "?" not in known.words[end].text or "ASKSDO" not in known.kinds[begun[0]]:
        return False
    if known.words[begun[1]].norm in ("you", "i", "we") or _refers_back(end + 1, known):
        return False
    behind = range(end + 1, len(known.words))
    names = any(known.names_place(k) for k in behind) and any(known.captures.get(k) for k in behind)
    return names and not any(known.kinds[k] & {"IFSO", "OTHERWISE"} for k in behind)


def _may_ask(at: int, said: Sequence[int], known: WordKinds, *, hopes: bool, asks: bool) -> bool:
    """Return True for a word that may ask for something, restrict or forbid it, where it stands."""
    k = said[at]
    word, kinds = known.words[k], known.kinds[k]
    before = known.kinds[said[at - 1]] if at > 0 else frozenset[str]()
    follows = known.kinds[said[at + 1]] if at + 1 < len(said) else frozenset[str]()
    if word.norm.endswith("n't") or word.kind in ("number", "rank", "unit"):
        return True
    if kinds & {"ENOUGH", "REMAINS"} and not hopes:
        return True
    if kinds & {"STATES", "AUXILIARY", "HARMLESS", "HOPES"}:
        return False
    if hopes and not kinds and "DOES" in before and not known.is_past(k):
        return True  # "I hope you flambé them"
    if not kinds and follows & {"DET", "IT"} and not word.norm.endswith(("ed", "ing", "ly")):
        joined = at > 0 and known.words[k - 1].kind == "comma"
        return joined or bool(before & {"AND", "INORDERTO", "THEN", "FILLER", "OPENER"})  # "and flambé the Carmels"
    if asks and known.captures.get(k):
        others = {one for n, found in known.captures.items() if n not in said for one in found}
        return not known.captures[k] & others
    if known.may_be(k, {"DOES"}):
        return not (hopes or asks or follows & {"DET", "STATES"})
    if known.may_be(k, _COMMANDS):
        return not (known.is_past(k) or before & {"TELLS", "AUXILIARY", "HARMLESS", "IS"})
    if word.norm in _LATELY and at > 1 and known.words[k - 1].norm == "this" and at + 1 == len(said):
        return False  # "awful this year"
    if "LAST" in kinds and not follows:
        return False  # "last week"
    if (hopes and kinds & {"BATTERY", "TIMEWORD"}) or ("AT" in kinds and "IT" in follows):
        return False  # "something has been digging under it"
    return known.may_be(k, _NEVER) and not _is_age(k, said, known)


def _is_age(k: int, said: Sequence[int], known: WordKinds) -> bool:
    """Return True for a word of "two-year-olds"."""
    return any("OLDS" in known.kinds[one] for one in said if k <= one <= k + 4)


def _refers_back(start: int, known: WordKinds) -> bool:
    """Return True if the words from one on refer to something before them ("it", "there") before they name a place."""
    for k in range(start, len(known.words)):
        if known.kinds[k] & _BACK and not known.kinds[k] & {"FILLER", "ASIDE", "INDEFINITE"}:
            return True
        if known.names_place(k):
            return False
    return False


def _only_place(said: Sequence[int], known: WordKinds) -> Sequence[int]:
    """Return the words of the only place that a sentence names; empty if it names several or none."""
    named = place_words(said, known)
    return named[0] if len(named) == 1 else ()


def place_words(said: Sequence[int], known: WordKinds) -> Sequence[Sequence[int]]:
    """Return the runs of words that name places, with the numbers of rows and trees.

    Args:
        said: Numbers of the words of a sentence or clause.
        known: What the words of the request can be.
    """
    found: list[list[int]] = [[]]
    for at, k in enumerate(said):
        fits = known.kinds[k] & (PLACE_WORDS | _IN_PLACES) or _is_age(k, said, known) or _counts(at, said, known)
        joins = bool(found[-1]) and known.words[k].norm in _JOINTS and _goes_on(at + 1, said, known)
        if joins or (fits and not known.kinds[k] & {"STATES", "THEREIS"} and known.words[k - 1].kind != "comma"):
            found[-1].append(k)
        else:
            found.append([])
    return [_trimmed(run, known) for run in found if any(known.names_place(k) for k in run)]


def _counts(at: int, said: Sequence[int], known: WordKinds) -> bool:
    """Return True for the number of a row or tree ("rows 3 and 5"), and for "two" of "two halves"."""
    halves = at + 1 < len(said) and bool(known.kinds[said[at + 1]] & {"HALF", "QUARTER"})
    return "NUM" in known.kinds[said[at]] and (halves or bool(head_of_number(at, said, known)))


def head_of_number(at: int, said: Sequence[int], known: WordKinds) -> str:
    """Return the word for the rows or trees that a number names ("row" of "rows 3 and 5"); empty if it names none.

    Args:
        at: Index of the number in the words.
        said: Numbers of the words.
        known: What the words of the request can be.
    """
    before = (k for k in reversed(said[:at]) if "NUM" not in known.kinds[k] and known.words[k].norm not in _JOINTS)
    head = next(before, None)
    named = head is not None and bool(known.kinds[head] & {"PLOT", "ROW", "TREE"})
    return known.words[head].norm.removesuffix("s") if head is not None and named else ""


def _goes_on(at: int, said: Sequence[int], known: WordKinds) -> bool:
    """Return True if a place goes on at a word behind "and" or the like."""
    names = (known.names_place(k) or known.kinds[k] & {"DIR", "NUM"} for k in said[at : at + 2])
    return any(names)


def _trimmed(run: Sequence[int], known: WordKinds) -> Sequence[int]:
    """Return the words of a place without what stands before and behind it."""
    begin = next(at for at, k in enumerate(run) if not known.kinds[k] & {"AT", "OF"} or known.kinds[k] & PLACE_WORDS)
    end = max(at for at, k in enumerate(run) if known.kinds[k] & (PLACE_WORDS | {"NUM", "PLOT"}))
    return run[begin : end + 1]
