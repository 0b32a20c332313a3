"""Nouns in the plural and verbs in every form, by rule and by a list of those that keep none."""

from __future__ import annotations

_PLURALS = {"half": "halves", "leaf": "leaves", "bush": "bushes"}
_PAST = {
    "take": "took taken",
    "draw": "drew drawn",
    "get": "got",
    "make": "made",
    "do": "did done",
    "go": "went gone",
    "drive": "drove driven",
    "run": "ran",
    "find": "found",
    "choose": "chose chosen",
    "come": "came",
    "begin": "began begun",
    "keep": "kept",
    "read": "read",
    "quit": "quit",
    "leave": "left",
    "spend": "spent",
    "burn": "burnt",
    "mow": "mown",
}
_DOUBLED = frozenset({"get", "grab", "run", "stop", "snap", "quit", "begin", "travel", "scan", "clip", "dig", "cut"})
_VOWELS = "aeiou"


def plural_of(phrase: str) -> str:
    """The plural of a noun or a noun phrase, whose last word it is that changes."""
    head, _, last = phrase.rpartition(" ")
    if last in _PLURALS:
        plural = _PLURALS[last]
    elif last.endswith("y") and last[-2:-1] not in _VOWELS:
        plural = last[:-1] + "ies"
    elif last.endswith(("s", "x", "z", "ch", "sh")):
        plural = last + "es"
    else:
        plural = last + "s"
    return f"{head} {plural}".strip()


def forms_of(phrase: str) -> list[str]:
    """A verb or a verb phrase in every form; its first word is the one that changes."""
    verb, _, rest = phrase.partition(" ")
    doubled = verb + verb[-1]
    if verb.endswith("e") and not verb.endswith("ee"):
        made = [verb, verb + "s", verb[:-1] + "ing", verb + "d"]
    elif verb in _DOUBLED:
        made = [verb, verb + "s", doubled + "ing", doubled + "ed"]
    elif verb.endswith(("s", "x", "ch", "sh", "o")):
        made = [verb, verb + "es", verb + "ing", verb + "ed"]
    else:
        made = [verb, verb + "s", verb + "ing", verb + "ed"]
    made += _PAST.get(verb, "").split()
    return [f"{form} {rest}".strip() for form in made]


def base_form(verb: str) -> str:
    """Return the base form of a verb in the present: "sprays" and "spraying" are "spray"."""
    if verb.endswith("ing") and len(verb) > len("being"):
        return verb[:-3]
    return verb[:-1] if verb.endswith("s") and not verb.endswith("ss") else verb
