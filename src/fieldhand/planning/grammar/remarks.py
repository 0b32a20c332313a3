"""Remarks of a request: sentences, asides and reasons that ask for nothing of the robot."""

from __future__ import annotations

from collections import defaultdict
from collections.abc import Iterable, Iterator, Mapping, Sequence
from dataclasses import dataclass, replace
from itertools import pairwise

from fieldhand.planning.english.tokens import Word
from fieldhand.planning.grammar.chart import PhraseEdge
from fieldhand.planning.grammar.earlier.edges import EARLIER
from fieldhand.planning.grammar.earlier.past_words import past_ranges
from fieldhand.planning.grammar.list_marks import list_marks
from fieldhand.planning.grammar.people import sender, who_wants
from fieldhand.planning.grammar.purposes import purpose, statement
from fieldhand.planning.grammar.tellings import WordKinds, telling
from fieldhand.task.plan import Span

#: Categories of words that may ask for something, or forbid it, in whatever sentence they stand.
_ASKING = frozenset(
    {
        "ACTV", "ALLOW", "ANOTHER", "APART", "ASMANY", "ATLEAST", "ATTRVAL", "BATTERY", "BEFORE",
        "BETWEEN", "BUT", "CLOCKWISE", "CMP", "CORNER", "COUNT", "DIR", "EACH", "EXCEPT", "FITS", "GO", "GOHOME",
        "IF", "IFSO", "INORDER", "INSTEAD", "INTERVAL", "ISNOT", "KEEP", "LEVEL", "MEASURE", "MOST",
        "NEAREST", "NEARBY", "NOORDER", "NOT", "NOUN", "NUM", "ORD", "ORDERED", "OTHERWISE", "REPEAT",
        "RETURN", "ROW", "STOP", "SUPER", "TAKE", "TIMES", "TREE", "TREEID", "TRY", "UNIT", "UNLESS",
        "UNTIL", "UPTO", "USE", "VISIT", "WHERE", "WHETHER", "WITHOUT", "ZONE",
    }
)  # fmt: skip
#: Categories that ask for something even in a reason ("so we can check ..." gives a reason, "to photograph row 4" not).
_ASKING_IN_REASON = _ASKING - {"MEASURE", "TAKE", "GO", "USE", "IF", "WHETHER", "LEVEL", "ACTV", "RETURN", "REPEAT"}
#: Categories of the words of claims, which say nothing else of people and of what they say.
_OF_CLAIMS = frozenset({"CLAIMANT", "CLAIMS", "RIGHTWORD"})
#: Categories of words that may say what a study is about.
_OF_STUDIES = frozenset({"DET", "GROUND", "NOUN", "OWNER", "PAPERWORK", "READING"})
#: Categories of words that an aside may have beside unknown ones ("for the lab").
_IN_ASIDES = frozenset(
    {"DET", "FOR", "FILLER", "IT", "IS", "WHICH", "OF", "MORE", "QUESTION", "THATWORD", "AT", "AS", "TELLS", "MEASURE"}
    | {"ASKSIF", "PAPERWORK", "PURPOSE", "TELLME"}
)
#: Categories of words that what is told of a tree may have beside unknown ones ("the one by the road").
_IN_APPOSITIONS = frozenset({"AT", "BY", "DET", "DIMENSION", "IMPERSONAL", "IS", "OF", "VAGUEADJ", "WHICH"})
#: Categories of words that restrict, forbid or command even behind "because", and of verbs that do so behind "and".
RESTRICTING = frozenset(
    {
        "ALLOW", "ASMANY", "ATLEAST", "BATTERY", "BUT", "CONTRAST", "CORRECTION", "DEMANDS", "EXCEPT", "GOHOME", "IF",
        "IFSO", "INORDER", "INSTEAD", "INTERVAL", "ISNOT", "LEAVEOUT", "LIMIT", "NOT", "ONLY", "OTHERWISE", "REPEAT",
        "TIMES", "TRY", "UNIT", "UNLESS", "UNTIL", "WITHOUT",
    }
)  # fmt: skip
_VERBS = frozenset({"ACTV", "GO", "MEASURE", "STOP", "TAKE", "USE", "VISIT"})
#: Who may be those who ask.
_WHEN_WE = frozenset({"before", "after", "while", "whilst"})
_WE = frozenset({"i", "we", "i've", "we've", "i'm", "we're", "they", "he", "she"})
#: Categories of the words with which a request begins.
_WHO_ASKS = frozenset({"FILLER", "MEASURE", "TAKE", "TELLS"})


@dataclass(frozen=True, kw_only=True)
class Remarks:
    """The words of a request without its remarks.

    Attributes:
        words: Words that are left.
        spans: Character ranges of the remarks.
        labels: Character ranges of the labels of steps ("Step 2:", "2."), which ask for nothing but an order.
        corrected: Character ranges of numbers that others behind them correct, up to these.
        topics: Numbers of the words that are left and stand for "this is about", before a place that is told of.
    """

    words: tuple[Word, ...]
    spans: tuple[Span, ...]
    labels: tuple[Span, ...] = ()
    corrected: tuple[Span, ...] = ()
    topics: frozenset[int] = frozenset()


def without_remarks(
    words: Sequence[Word],
    edges: Iterable[PhraseEdge],
    *,
    tells: bool = False,
    respelt: Iterable[PhraseEdge] = (),
    frames: Iterable[tuple[int, int]] = (),
    aims: Iterable[tuple[int, int]] = (),
    past: bool = True,
) -> Remarks:
    """Return the words without remarks: what is told beside the command, and the reasons that are given.

    Args:
        words: Words of the request.
        edges: What its words and phrases can be.
        tells: True to leave out sentences and clauses that tell something, too.
        respelt: What the words can be with misspellings mended; what may ask for something then tells nothing.
        frames: Ranges of polite frames ("would you be able to"), which are left out, too.
        aims: Ranges of the phrases with which purposes begin ("I want to know how").
        past: True to keep "today" and the like where they may say when earlier work was done.
    """
    marks = list_marks(words)
    words = [replace(word, kind="stop") if k in marks.ends else word for k, word in enumerate(words)]
    kinds: list[set[str]] = [set() for _ in words]
    captures: dict[int, set[object]] = defaultdict(set)
    reasons: set[int] = set()
    purposes: dict[int, int] = {}
    asides: set[int] = set()
    hedges: set[int] = set()
    edges = list(edges)
    earlier = _of_earlier_missions(words, edges) if past else frozenset[int]()
    for edge in edges:
        if edge.category == "NOUN":
            for k in range(edge.start, edge.end):
                captures[k].add(edge.meaning.value)
        for k in range(edge.start, edge.end) if edge.category not in EARLIER | _OF_CLAIMS else ():
            kinds[k].add(edge.category)  # "We had a leak last week" tells of something else
        if edge.category == "REASON":
            reasons.add(edge.start)
        if edge.category in ("PURPOSE", "REASON"):
            purposes[edge.start] = max(edge.end, purposes.get(edge.start, 0))
        if edge.category == "ABOUT" and "hedges" in edge.meaning.features:
            hedges.add(edge.end - 1)
        of_earlier = not earlier.isdisjoint(range(edge.start, edge.end))
        if edge.category == "ASIDE" and not of_earlier and (_is_anywhere(edge) or _stands_apart(words, edge)):
            asides.update(range(edge.start, edge.end))
    likely: dict[int, set[str]] = defaultdict(set)
    for edge in respelt:
        for k in range(edge.start, edge.end):
            likely[k].add(edge.category)
    known = WordKinds(words=words, kinds=kinds, likely=likely, captures=captures)
    framed = {k for start, end in frames for k in range(start, end)}
    left_out, labels, topics = asides | framed, set(marks.marks), set[int]()
    sentences = list(_parts(words, {"stop"}))
    ranked = [one for one in sentences if len(one) > 2 and "ORD" in kinds[one[0]] and words[one[1]].kind == "comma"]
    if len(ranked) > 1:
        labels.update(k for one in ranked for k in one[:2])  # "First: ... Second: ..."
    openings = dict(aims)
    for whole in sentences:
        sentence: Sequence[int] = whole
        aim = purpose(sentence, openings, known) or (statement(sentence, known) if tells else None)
        if aim is not None:
            left_out |= aim.left_out
            topics |= set() if aim.topic is None else {aim.topic}
            sentence = [k for k in sentence if k not in aim.left_out]
            if not sentence:
                continue
        said = [k for k in sentence if words[k].kind != "comma" and k not in labels | framed]
        label = _label(words, sentence, kinds)
        labels.update(label)
        left_out.update(who_wants(sentence, words, kinds))
        if tells:
            left_out.update(_heading(words, sentence, kinds))
            left_out.update(_for_what(said, purposes, kinds))
        told = telling(said, known, sentence=True) if tells and said else None
        if told is not None:
            kept = {*said} - told.left_out
            left_out.update({*sentence} - kept)
            topics |= set() if told.topic is None else {told.topic}
            continue
        for clause in _clauses(words, sentence):
            aside = _reason(clause, reasons, kinds) or _aside(clause, kinds)
            if tells and not aside:
                aside = _because(clause, known) or _before_people(clause, known)
                aside = aside or (clause if _is_apposition(clause, said, words, kinds) else ())
                aside = aside or (clause if said and clause[0] == said[0] and _is_for_study(clause, kinds) else ())
            if tells and not aside and telling(clause, known, sentence=False) is not None:
                aside = clause
            if aside and len(aside) < len(said):
                left_out.update(aside)
    if tells:
        left_out.update(sender(words, kinds), (k for k in hedges if _measures(k + 1, kinds)))
    corrected = [found for part in sentences if (found := _corrected_numbers(words, kinds, part))]
    left_out.update(k for one in corrected for k in one)
    left_out.update(comma for one in corrected for comma in _comma_inside(words, kinds, one))
    left_out |= {k for k, word in enumerate(words) if word.kind == "comma" and _sets_off(words, k, left_out)}
    left_out -= labels
    if len(left_out | labels) == len(words):
        left_out, labels = set(), set()
    kept_ones = [k for k in range(len(words)) if k not in left_out | labels]
    dictated = {k for k, word in enumerate(words) if word.is_dictated}
    edited = tuple((words[one[0]].start, words[one[-1] + 1].start) for one in corrected)
    return Remarks(
        words=tuple(words[k] for k in kept_ones),
        spans=_spans(words, left_out | topics | dictated),
        labels=_spans(words, labels),
        corrected=edited,
        topics=frozenset(at for at, k in enumerate(kept_ones) if k in topics),
    )


def _measures(k: int, kinds: Sequence[set[str]]) -> bool:
    """Return True for a number of metres, minutes or trees, for which "about" it will do; a reading is never one."""
    follows = kinds[k + 1] if k + 1 < len(kinds) else set()
    equals = k > 1 and bool(kinds[k - 2] & {"CONTRACTED", "IS", "IT"})
    return k < len(kinds) and "NUM" in kinds[k] and bool(follows & {"NOUN", "ROW", "TREE", "UNIT"}) and not equals


def _spans(words: Sequence[Word], chosen: set[int]) -> tuple[Span, ...]:
    """Return the character ranges of some words, neighbours joined."""
    return tuple((words[part[0]].start, words[part[-1]].end) for part in _runs(sorted(chosen)))


def _sets_off(words: Sequence[Word], comma: int, left_out: set[int]) -> bool:
    """Return True for a comma before a remark, or behind one that a comma or nothing stands before."""
    if comma == 0 or comma + 1 in left_out:
        return True
    begin = comma
    while begin - 1 in left_out:
        begin -= 1
    return begin < comma and (begin == 0 or words[begin - 1].kind in ("comma", "stop"))


def _is_anywhere(edge: PhraseEdge) -> bool:
    return "anywhere" in edge.meaning.features


def _of_earlier_missions(words: Sequence[Word], edges: Sequence[PhraseEdge]) -> frozenset[int]:
    """Return the numbers of the words that are the time of earlier work ("already done today")."""
    asides = (edge for edge in edges if edge.category == "ASIDE" and _is_anywhere(edge))
    times = [("PERIOD", edge.start, edge.end) for edge in asides]
    return past_ranges(words, [*((edge.category, edge.start, edge.end) for edge in edges), *times])


def keeps_asides(words: Sequence[Word], edges: Iterable[PhraseEdge]) -> bool:
    """Return True if some asides of a request may say when earlier work was done ("photographed today")."""
    known = list(edges)
    earlier = _of_earlier_missions(words, known)
    asides = (edge for edge in known if edge.category == "ASIDE" and _is_anywhere(edge))
    return any(not earlier.isdisjoint(range(edge.start, edge.end)) for edge in asides)


def _stands_apart(words: Sequence[Word], edge: PhraseEdge) -> bool:
    """Return True for a fixed aside of several words, and for a short one between commas ("Right, ...")."""
    marks = ("comma", "stop")
    begins = edge.start == 0 or words[edge.start - 1].kind in marks
    ends = edge.end == len(words) or words[edge.end].kind in marks
    return edge.end - edge.start > 2 or (begins and ends)


def _label(words: Sequence[Word], sentence: Sequence[int], kinds: Sequence[set[str]]) -> Sequence[int]:
    """Return the label of a step with which a sentence begins ("Step 2: ..."); empty if there is none."""
    comma = next((at for at, k in enumerate(sentence[:3]) if words[k].kind == "comma"), 0)
    if comma == 0 or "LABEL" not in kinds[sentence[0]] or (comma == 2 and "NUM" not in kinds[sentence[1]]):
        return ()
    return sentence[: comma + 1]


def _corrected_numbers(words: Sequence[Word], kinds: Sequence[set[str]], sentence: Sequence[int]) -> Sequence[int]:
    """Return the only numbers of a sentence up to those that correct them ("above 400, sorry, 450 ppm")."""
    begin = next((k for k in sentence[2:] if "CORRECTION" in kinds[k] and words[k - 1].kind == "comma"), None)
    if begin is None or any("SCRATCH" in kinds[k] for k in range(sentence[0], begin)):
        return ()
    end = begin
    while end <= sentence[-1] and ("CORRECTION" in kinds[end] or words[end].kind == "comma"):
        end += 1
    if "WAITV" in kinds[begin] and end == begin + 1 and any("UNIT" in kinds[k] for k in range(end, len(kinds))[1:5]):
        return ()  # "tree 4, wait 10 min" and "..., wait a quarter of an hour"
    last = begin - 3 if "UNIT" in kinds[begin - 2] else begin - 2
    old, new = _numbers_from(words, kinds, last, -1), _numbers_from(words, kinds, end, 1)
    if not old or len(old) != len(new) or any("NUM" in kinds[k] for k in range(sentence[0], old[-1])):
        return ()
    return range(old[-1], end)


def _comma_inside(words: Sequence[Word], kinds: Sequence[set[str]], corrected: Sequence[int]) -> Sequence[int]:
    """Return the comma between a number that corrects another and its noun ("five, no, six, trees"), if any."""
    comma = corrected[-1] + 2
    inside = comma + 1 < len(words) and words[comma].kind == "comma" and kinds[comma + 1] & {"TREE", "ROW", "NOUN"}
    return (comma,) if inside else ()


def _numbers_from(words: Sequence[Word], kinds: Sequence[set[str]], start: int, step: int) -> list[int]:
    """Return the run of numbers, and of what joins them, that begins at a word in a direction."""
    run: list[int] = []
    while 0 <= start < len(words) and "NUM" in kinds[start]:
        run.append(start)
        joint, start = start + step, start + 2 * step
        if not 0 <= start < len(words) or "NUM" not in kinds[start]:
            break
        if "AND" not in kinds[joint] and words[joint].kind != "comma":
            break
        run.append(joint)
    return run


def _heading(words: Sequence[Word], sentence: Sequence[int], kinds: Sequence[set[str]]) -> Sequence[int]:
    """Return the heading with which a sentence begins ("Systematic design: ..."); empty if there is none."""
    end = next((at for at, k in enumerate(sentence[:6]) if words[k].text == ":"), 0)
    said = sentence[:end]
    of_heading = [k for k in said if "HEADING" in kinds[k]]
    if not of_heading or any(kinds[k] - _IN_ASIDES - {"ASIDE"} for k in said if k not in of_heading):
        return ()
    return sentence[: end + 1]


def _for_what(said: Sequence[int], purposes: Mapping[int, int], kinds: Sequence[set[str]]) -> Sequence[int]:
    """Return the words of what something is for, before who asks for it ("For my thesis I need ..."); empty if none."""
    if not said or "FOR" not in kinds[said[0]]:
        return ()
    end = purposes.get(said[0], said[0] + 1)
    length = sum(k < end for k in said)
    while length < len(said) and kinds[said[length]] & {"DET", "PAPERWORK"}:
        length += 1
    study = next((at for at, k in enumerate(said[:5]) if at > 1 and _is_for_study(said[: at + 1], kinds)), 0)
    length = max(length, study + 1)
    told = length > 1 and (said[0] in purposes or study > 0 or "PAPERWORK" in kinds[said[length - 1]])
    return said[:length] if told and length < len(said) and kinds[said[length]] & _WHO_ASKS else ()


def _is_for_study(clause: Sequence[int], kinds: Sequence[set[str]]) -> bool:
    """Return True for what work is for, by what is studied: "for the nitrogen trial"; a place is named by the work."""
    begins, ends = "FOR" in kinds[clause[0]], bool(kinds[clause[-1]] & {"HEADING", "PAPERWORK"})
    return begins and ends and all(not kinds[k] or kinds[k] & _OF_STUDIES for k in clause[1:-1])


def _reason(clause: Sequence[int], reasons: set[int], kinds: Sequence[set[str]]) -> Sequence[int]:
    """Return the reason at the end of a clause, or a clause that is one; empty if there is none."""
    begin = next((at for at, k in enumerate(clause) if k in reasons), None)
    if begin is None or any(kinds[k] & _ASKING_IN_REASON for k in clause[begin:]):
        return ()
    return clause[begin:]


def _because(clause: Sequence[int], known: WordKinds) -> Sequence[int]:
    """Return what "because" begins, which may name rows and trees ("because we did that row yesterday")."""
    begin = next((at for at, k in enumerate(clause) if known.kinds[k] & {"BECAUSE"}), None)
    if begin is None:
        return ()
    for before, k in pairwise(clause[begin:]):
        joined = known.words[before].norm in ("and", "then", "but", "or")
        if known.may_be(k, RESTRICTING) or known.words[k].norm.endswith("n't"):
            return ()
        if known.captures.get(k) and "HARMLESS" not in known.kinds[k]:
            return ()
        if joined and (known.may_be(k, _VERBS) or not known.kinds[k]):
            return ()
    return clause[begin:]


def _before_people(clause: Sequence[int], known: WordKinds) -> Sequence[int]:
    """Return what people are going to do ("before the crew needs the machine back"); empty if nobody is.

    "Before I water them" and "after we have watered them" tell when somebody starts the mission.
    """
    kinds = known.kinds
    begin = next((at for at, k in enumerate(clause) if known.words[k].norm in _WHEN_WE), None)
    if begin is None:
        return ()
    said = clause[begin + 1 :]
    ours = bool(said) and known.words[said[0]].norm in _WE
    if not ours and ("BEFORE" not in kinds[clause[begin]] or not any("PEOPLE" in kinds[k] for k in said[:3])):
        return ()
    if ours:
        return clause[begin:] if len(said) > 1 and _is_ours(said, known) else ()
    asks = any(kinds[k] & (_ASKING - {"BEFORE", "RETURN", "USE", "MEASURE", "GO"}) for k in said)
    return () if asks or len(said) < 3 else clause[begin:]


def _is_ours(said: Sequence[int], known: WordKinds) -> bool:
    """Return True for what "we" do, if none of it asks for something, or says when."""
    for before, k in pairwise(said):
        word, kinds = known.words[k], known.kinds[k]
        if word.kind in ("number", "rank", "unit") or word.norm.endswith("n't") or kinds & (RESTRICTING - {"TIMES"}):
            return False
        if known.words[before].norm in ("and", "then", "but", "or", "to") and (not kinds or known.may_be(k, _VERBS)):
            return False
    return True


def _is_apposition(
    clause: Sequence[int], said: Sequence[int], words: Sequence[Word], kinds: Sequence[set[str]]
) -> bool:
    """Return True for what is told of a tree behind it ("tree 4, the one by the road"), if it names no other place."""
    if not said or clause[0] == said[0] or not kinds[clause[0] - 2] & {"NUM", "TREEID"}:
        return False
    if clause[0] > 2 and kinds[clause[0] - 3] & {"AND", "COMMA"}:
        return False  # "trees 4 and 9, the one by the road"
    one = next((k for k in clause if words[k].norm == "one"), None)
    if one is None or not kinds[clause[0]] & {"DET", "IMPERSONAL", "WHICH"}:
        return False
    if one == clause[-1] and "DET" in kinds[clause[0]]:
        return False  # "the gnarled one" may choose among several
    others = [k for k in clause if k != one]
    return any(not kinds[k] for k in others) and all(not kinds[k] or kinds[k] & _IN_APPOSITIONS for k in others)


def _aside(clause: Sequence[int], kinds: Sequence[set[str]]) -> Sequence[int]:
    """Return an aside of unknown words: all of a clause, or what "for" begins; empty if there is none."""
    begins = [0, *(at for at, k in enumerate(clause) if "FOR" in kinds[k] and at > 0)]
    for begin in begins:
        said = clause[begin:]
        unknown = [k for k in said if not kinds[k]]
        begins_aside = begin > 0 or bool({"FOR", "AS"} & kinds[said[0]])
        if begins_aside and unknown and all(not kinds[k] or kinds[k] & _IN_ASIDES for k in said):
            return said
    return ()


def _clauses(words: Sequence[Word], sentence: Sequence[int]) -> Iterator[list[int]]:
    """Yield the parts of a sentence between commas."""
    yield from _parts([words[k] for k in sentence], {"comma", "stop"}, sentence)


def _parts(words: Sequence[Word], ends: set[str], numbers: Sequence[int] | None = None) -> Iterator[list[int]]:
    """Yield the numbers of the words between marks of some kinds, without these marks."""
    part: list[int] = []
    for at, word in enumerate(words):
        if word.kind not in ends:
            part.append(at if numbers is None else numbers[at])
        elif part:
            yield part
            part = []
    if part:
        yield part


def _runs(numbers: Sequence[int]) -> Iterator[list[int]]:
    """Yield the runs of successive numbers."""
    run: list[int] = []
    for number in numbers:
        if run and number != run[-1] + 1:
            yield run
            run = []
        run.append(number)
    if run:
        yield run
