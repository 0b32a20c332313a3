"""Purposes of a request: what is to be found out or compared, beside the command that serves it."""

from __future__ import annotations

from collections.abc import Iterator, Mapping, Sequence
from collections.abc import Set as AbstractSet

from fieldhand.planning.grammar.tellings import Telling, WordKinds, head_of_number, place_words

#: Categories of words that restrict, forbid or command wherever they stand.
_NEVER = frozenset(
    {
        "ALLOW", "ASMANY", "ATLEAST", "BATTERY", "BEFORE", "BUT", "CLOCKWISE", "CONTRAST", "CORRECTION", "DEMANDS",
        "EVENLYSPACED", "EXCEPT", "GOHOME", "IF", "IFSO", "INCASE", "INORDER", "INSTEAD", "INTERVAL", "ISNOT",
        "LEAVEOUT", "LIMIT", "MAXIMISE", "MUST", "NOORDER", "NOT", "ONLY", "OTHERWISE", "REVERSE",
        "TRY", "UNIT", "UNLESS", "UNTIL", "WITHOUT",
    }
)  # fmt: skip
#: Categories of the verbs of commands, which ask for something only where a verb may begin.
_VERBS = frozenset(
    {
        "ACTV", "CLIP", "GO", "KEEP", "MEASURE", "PASSON", "REPEAT", "RETURN", "SORT", "STAY", "STOP", "TAKE", "USE",
        "VISIT",
    }
)  # fmt: skip
#: Categories of words with which a command begins behind a comma.
_BEGINS = frozenset({"ACTV", "GO", "MEASURE", "TAKE", "USE", "VISIT"})
#: Words that join a command to its purpose, and verbs of what is found out that demand nothing.
_JOINTS = frozenset({"so", "therefore", "hence", "please", "and", "then"})
_OF_PLANTS = frozenset({"need", "needs", "change", "changes", "changed", "wrong", "mean", "means", "slow", "first"})
_ASKS = frozenset({"how", "whether", "what", "which", "why", "where", "when"})
#: Marks that set a command off from what it is for.
_COLONS = frozenset({":", " - ", " \u2013 ", "\u2014", " \u2014 "})
_BACK = frozenset({"IT", "ITS", "SAME", "THERE"})
#: Categories of words that name no part of a place before which they stand.
_BEFORE_PLACES = frozenset(
    {"AT", "AUXILIARY", "HARMLESS", "HOW", "IS", "IT", "LIMITEDTO", "OF", "QUESTION", "STATES", "WHETHER", "WITH"}
)
#: Words behind a place that begin a description of its trees.
_DESCRIBES = frozenset({"that", "which", "who", "whose", "where", "with", "without", "behind", "beside", "near", "by"})
_RELATIVES = frozenset({"that", "which", "who", "whose"})
#: Pronouns that may refer to a thing as well as to where it is.
_PRONOUNS = frozenset({"them", "they", "these", "those", "each", "one"})
#: Categories of the words that may stand before a purpose.
_OPENING = frozenset({"AND", "ASIDE", "DOES", "FILLER", "OPENER"})


def purpose(sentence: Sequence[int], openings: Mapping[int, int], known: WordKinds) -> Telling | None:
    """Return what a sentence says to be the purpose of a command; None if it says none, or may ask for something else.

    A purpose begins with who wants to know something ("we want to see how", "I am comparing") and ends with the
    sentence, at a colon, or where a command begins. The places that it names are named by the command, too, or the
    command refers to the only one ("there"), which is kept as what the request is about.

    Args:
        sentence: Numbers of the words of the sentence, its commas among them.
        openings: Ends of the phrases with which purposes begin, by their first words.
        known: What the words of the request can be.
    """
    begin = next((at for at, k in enumerate(sentence) if k in openings), None)
    if begin is None:
        return None
    said = sentence[begin:]
    start = sum(k < openings[said[0]] for k in said)
    end = next((at for at in range(start, len(said)) if _ends(at, said, known)), len(said))
    body = said[start:end]
    places = _places(body, known)
    compares = known.words[said[start - 1]].norm == "compare"
    if compares and any("LATELY" in known.kinds[k] for k in body):
        return None  # "compare it with last year"
    if not all(_is_harmless(at, body, {k for run in places for k in run}, known) for at in range(len(body))):
        return None
    command = next((at for at in range(end, len(said)) if known.words[said[at]].norm not in _JOINTS | {",", ":"}), end)
    marks = [k for k in said[end : end + 1] if known.words[k].kind == "comma"]
    opens = all(known.kinds[k] & _OPENING or known.words[k].kind == "comma" for k in sentence[:begin])
    joints = set[int]()
    if command == len(said):  # ", and compare the means" behind what is read
        for k in reversed(sentence[:begin]):
            if known.words[k].kind != "comma" and known.words[k].norm != "and":
                break
            joints.add(k)
    told = frozenset({*said[:command], *marks, *joints})
    if opens and len(places) == 1 and _refers_back(max(told) + 1, known) and _is_whole(places[0], body, known):
        return Telling(left_out=told - {said[0], *places[0]}, topic=said[0])
    return _named_again(places, told, said, known)


#: Categories of words that no statement contains beside those that no purpose contains.
_NO_STATEMENT = _NEVER | frozenset(
    {
        "DOES", "GIVES", "HOPES", "KEEP", "KEEPOUT", "LEAVE", "LEFTOUT", "LIMITEDTO", "MATTERS", "MUST", "OFFLIMITS",
        "PASSES", "PASSON", "REPEAT", "SAMEFOR", "SHOULD", "STAY", "STOP", "TIMES", "TIMEWORD", "TOPIC", "UNCUT",
        "UNTOUCHED", "UPTO", "WANTED", "WANTS",
    }
)  # fmt: skip
#: Words with which a statement begins, and what somebody finds that it is like.
_SUBJECTS = frozenset({"today", "tomorrow", "something", "somebody", "someone", "nothing"})
_OURS = frozenset({"i", "we", "i'm", "we're", "they", "they're"})
_SEARCHES = frozenset({"check", "inspect", "examine", "survey", "search", "scan"})
_COMES = frozenset({"come", "comes", "go", "goes", "are", "is"})
_LOOKS = frozenset({"look", "looks", "looked", "feel", "feels", "felt", "seem", "seems", "smell", "smells"})


def statement(sentence: Sequence[int], known: WordKinds) -> Telling | None:
    """Return what a sentence states of places that the request then names again or refers to; None if it may ask.

    "The slope is steep, so mow it slowly": the statement ends where the sentence does, or before "so". It has a
    subject other than the robot, and a verb that says what the subject is, has or did.

    Args:
        sentence: Numbers of the words of the sentence, its commas among them.
        known: What the words of the request can be.
    """
    if (search := _search(sentence, known)) is not None:
        return search
    said = [k for k in sentence if "FILLER" not in known.kinds[k] or "TELLS" in known.kinds[k]]
    if len(said) < 3 or not _is_subject(said, known):
        return None
    end = next((at for at in range(2, len(said)) if _ends_statement(at, said, known)), len(said))
    body = said[:end]
    if end == len(said) and any(known.words[k].kind == "comma" for k in body):
        return None
    places = [_without_quality(run, known) for run in _places(body, known)]
    placed = {k for run in places for k in run}
    if len(places) > 1 and len(placed) == len(body):
        return None
    verb = next((k for at, k in enumerate(body) if k not in placed and _states(at, body, known)), None)
    if verb is None or not all(_is_plain(at, body, placed, known) for at in range(len(body))):
        return None
    last = next((at for at in range(end, len(said)) if known.words[said[at]].norm not in _JOINTS | {","}), len(said))
    told = frozenset(k for k in sentence if k < (said[last] if last < len(said) else sentence[-1] + 1))
    if len(places) == 1 and _refers_back(max(told) + 1, known):
        place = places[0]
        fits = _is_whole(place, body, known) and place[-1] < verb
        return Telling(left_out=told - {verb, *place}, topic=verb) if fits else None
    if end < len(said) and not _refers_back(max(told) + 1, known):
        return Telling(left_out=told)  # a reason, whatever it names
    if not places and (known.words[said[0]].norm not in ("is", "'s") or _refers_back(max(told) + 1, known)):
        return None
    if any(known.words[k].norm == "first" for k in body) and not _is_named_first(places, max(told) + 1, known):
        return None
    return _named_again(places, told, said, known)


def _search(sentence: Sequence[int], known: WordKinds) -> Telling | None:
    """Return what "check the fence for holes: film it" looks for, before the command that serves it."""
    end = next((at for at, k in enumerate(sentence) if known.words[k].text in _COLONS), 0)
    body = sentence[:end]
    if not body or known.words[body[0]].norm not in _SEARCHES or not _refers_back(sentence[end], known):
        return None
    places = _places(body, known)
    sought = next((at for at, k in enumerate(body) if known.words[k].norm == "for"), 0)
    if len(places) != 1 or not sought or places[0] != body[1:sought] or any(known.kinds[k] for k in body[sought + 1 :]):
        return None
    told = frozenset(sentence[: end + 1])
    return Telling(left_out=told - {*places[0], body[sought]}, topic=body[sought])


def _without_quality(run: Sequence[int], known: WordKinds) -> Sequence[int]:
    """Return the words of a place without those that say how something is there ("high on the bank")."""
    behind = len(run) > 1 and "VAGUEADJ" in known.kinds[run[0]] and "AT" in known.kinds[run[1]]
    return run[2:] if behind else run


def _is_named_first(places: Sequence[Sequence[int]], start: int, known: WordKinds) -> bool:
    """Return True if the only place is the first one that the words from one on name ("carrots come first")."""
    after = next((k for k in range(start, len(known.words)) if known.names_place(k)), None)
    if after is None or len(places) != 1:
        return False
    return known.words[after].norm.removesuffix("s") in {name for name, _ in _named(places[0], known)}


def _is_subject(said: Sequence[int], known: WordKinds) -> bool:
    """Return True if a sentence begins with somebody or something other than the robot and its work."""
    kinds, word = known.kinds[said[0]], known.words[said[0]].norm
    if known.may_be(said[0], _VERBS | {"DOES", "NUM", "IF", "WHERE"}) and not kinds & {"TELLS"}:
        return False
    if "DOES" in known.kinds[said[1]] and "DET" in kinds:
        return False
    if word in ("is", "'s"):  # "(today) is hay day", of which the day is a time
        asks = any("?" in known.words[k].text for k in range(said[-1] + 1, min(said[-1] + 2, len(known.words))))
        return not asks and not any(known.kinds[k] for k in said[1:])
    return word in _SUBJECTS or bool(kinds & {"DET", "TELLS"}) or known.names_place(said[0])


def _ends_statement(at: int, said: Sequence[int], known: WordKinds) -> bool:
    """Return True for "so" before a command, with the comma before it, and for a mark before one."""
    word = known.words[said[at]]
    if word.text in _COLONS:
        return True
    follows = [known.words[k].norm for k in said[at + 1 : at + 2]]
    return word.norm == "so" or (word.kind == "comma" and follows == ["so"])


def _states(at: int, body: Sequence[int], known: WordKinds) -> bool:
    """Return True for the verb of a statement."""
    k = body[at]
    word, kinds = known.words[k], known.kinds[k]
    if word.norm in _COMES and at + 1 < len(body) and known.words[body[at + 1]].norm == "first":
        return True
    if "STAYV" in kinds and at > 1 and not known.kinds[body[at - 1]]:
        return True
    if word.norm in _LOOKS:
        return at + 1 < len(body) and not known.kinds[body[at + 1]] & {"AT", "FOR", "DET", "IT"}
    told = at > 0 and not kinds and known.is_past(k) and "TELLS" in known.kinds[body[at - 1]]
    return told or bool(kinds & {"AUXILIARY", "STATES"}) or word.norm in ("is", "are", "was", "were", "'s")


def _is_plain(at: int, body: Sequence[int], placed: AbstractSet[int], known: WordKinds) -> bool:
    """Return True for a word of a statement that neither asks for something nor restricts the work."""
    k = body[at]
    word, kinds = known.words[k], known.kinds[k]
    if k in placed or word.norm in _LOOKS or "HARMLESS" in kinds:
        return True
    before = known.words[body[at - 1]].norm if at > 0 else ""
    if word.norm == "first" and before in _COMES and at + 1 >= len(body) - 1:
        return True
    if word.norm.endswith("n't") or word.kind in ("number", "rank", "comma"):
        return False
    if known.captures.get(k) and "GROUND" not in kinds:
        return False
    if "STAYV" in kinds and at > 1 and not known.kinds[body[at - 1]]:
        return True  # "the horses stay in the barn"
    if "AT" in kinds and at + 1 < len(body) and (body[at + 1] in placed or "DET" in known.kinds[body[at + 1]]):
        return word.norm not in ("above", "over", "than")
    if known.may_be(k, _NO_STATEMENT) and word.norm not in ("is", "are", "was", "were", "has", "have", "had", "will"):
        return False
    ours = before == "to" and not kinds and known.words[body[0]].norm in _OURS and at > 2
    if ours and known.words[body[at - 2]].norm in ("going", "about", "planning", "plan", "hoping"):
        return True  # "we are going to harvest them"
    return not (before in ("and", "or", "then", "to") and (not kinds or known.may_be(k, _VERBS)))


def _ends(at: int, said: Sequence[int], known: WordKinds) -> bool:
    """Return True for a mark or a word with which a purpose ends before a command."""
    word = known.words[said[at]]
    follows = known.words[said[at + 1]] if at + 1 < len(said) else None
    if word.text in _COLONS or follows is None:
        return word.text in _COLONS
    if word.norm == "so" or word.kind == "comma":
        later = (k for k in said[at + 1 :] if known.words[k].norm not in _JOINTS)
        begins = bool(known.kinds[next(later, said[at])] & _BEGINS)
        return begins or (word.kind == "comma" and follows.norm == "so")
    return False


def _is_harmless(at: int, body: Sequence[int], placed: set[int], known: WordKinds) -> bool:
    """Return True for a word of what is to be found out that neither asks for something nor restricts the work."""
    k = body[at]
    word, kinds = known.words[k], known.kinds[k]
    before = known.words[body[at - 1]] if at > 0 else None
    joined = before is not None and (before.kind == "comma" or before.norm in ("and", "or", "then", "to"))
    if k in placed or word.norm in _ASKS:
        return True
    if (word.norm in _OF_PLANTS or "HARMLESS" in kinds) and not joined:
        return True
    if word.norm.endswith("n't") or word.kind in ("number", "rank", "unit") or known.may_be(k, _NEVER):
        return False
    if word.kind == "comma":
        follows = [known.words[one].norm for one in body[at + 1 : at + 3]]
        tells = bool(follows) and "TELLS" in known.kinds[body[at + 1]] and "DET" not in known.kinds[body[at + 1]]
        return tells or bool({*follows} & _ASKS)
    if known.captures.get(k):
        others = {one for n, found in known.captures.items() if n not in body for one in found}
        return bool(known.captures[k] & others)
    acts = not kinds and at + 1 < len(body) and bool(known.kinds[body[at + 1]] & {"DET", "IT"})
    return not (joined and (acts or known.may_be(k, _VERBS)))


def _places(body: Sequence[int], known: WordKinds) -> Sequence[Sequence[int]]:
    """Return the runs of words that name places, but for "the trees" and the like."""
    return [
        run for run in place_words(body, known) if not all(known.kinds[k] & {"AT", "DET", "OF", "TREE"} for k in run)
    ]


def _is_whole(place: Sequence[int], body: Sequence[int], known: WordKinds) -> bool:
    """Return True unless a purpose may be about a part of a place, or about something there that a pronoun refers to.

    "Both ends of row 5" and "the gnarled trees" are parts; "the gaps in row 5" are what "photograph them" refers to.
    """
    at = body.index(place[0])
    inside = at > 1 and "AT" in known.kinds[body[at - 1]]
    thing = body[at - 2] if inside and not known.kinds[body[at - 2]] else None
    after = body[at + len(place) :]
    described = bool(after) and (known.words[after[0]].norm in _DESCRIBES or known.is_past(after[0]))
    described = described or any(known.words[k].norm in _RELATIVES for k in after)
    if described or any(k != thing and _is_of_place(k, known) for k in body[max(0, at - 3) : at]):
        return False
    return thing is None or not any(word.norm in _PRONOUNS for word in known.words[body[-1] + 1 :])


def _is_of_place(k: int, known: WordKinds) -> bool:
    """Return True for a word before a place that may be a part of its name."""
    word, kinds = known.words[k], known.kinds[k]
    if word.norm in _ASKS or known.captures.get(k) or word.kind == "comma":
        return False
    return "DET" not in kinds and (not kinds & _BEFORE_PLACES or "INDEFINITE" in kinds)


def _named(run: Sequence[int], known: WordKinds) -> Iterator[tuple[str, str]]:
    """Yield the words that name a place, each number with the word for what it counts."""
    for at, k in enumerate(run):
        if "NUM" in known.kinds[k]:
            yield known.words[k].norm, head_of_number(at, run, known)
        elif known.kinds[k] and not known.kinds[k] & {"AND", "AT", "DET", "OF", "WITH"}:
            yield known.words[k].norm.removesuffix("s"), ""


def _named_again(
    places: Sequence[Sequence[int]], told: frozenset[int], said: Sequence[int], known: WordKinds
) -> Telling | None:
    """Return a purpose of which the command needs nothing: it names all of the places itself; None otherwise."""
    others = {*_named([k for k in range(len(known.words)) if k not in told], known)}
    if not all(word in others for run in places for word in _named(run, known)):
        return None
    first = not any("TELLS" in known.kinds[k] for k in range(said[0]))
    return Telling(left_out=told) if places or first or not _refers_back(max(told) + 1, known) else None


def _refers_back(start: int, known: WordKinds) -> bool:
    """Return True if the next sentence refers to a place before it names one."""
    for k in range(start, len(known.words)):
        kinds, follows = known.kinds[k], known.words[k + 1 : k + 2]
        if kinds & _BACK and not kinds & {"FILLER", "ASIDE", "INDEFINITE"}:
            return True
        if "EACH" in kinds and (not follows or follows[0].kind in ("comma", "stop")):
            return True
        if known.words[k].norm in ("one", "ones") and k > 0 and known.kinds[k - 1] & {"EACH", "ORD", "OTHER"}:
            return True
        tree = "TREE" in kinds and not any(one.kind == "number" for one in follows)
        if known.names_place(k) and not tree:
            return False
    return False
