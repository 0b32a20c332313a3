"""Names of keys: what a person reads when deciding whom to trust, so that each can be read in one way only.

A name is one line of letters of one script, digits 0 to 9, single spaces and punctuation. Refused are letters of two
scripts, which may look alike (the a of Latin and of Cyrillic), hidden characters, and the other forms of a letter that
Unicode has (full width, in a circle). Names of one script can look alike, too: :func:`skeleton` is the same for those
that do (Unicode Technical Standard 39, with a table of the letters that matter for names).
"""

# ruff: noqa: RUF001
from __future__ import annotations

import unicodedata

from fieldhand.errors import KeyFileError
from fieldhand.visible import find_hidden, visible

MAX_NAME = 80
#: Scripts that are written together in one name.
_TOGETHER = (frozenset({"CJK", "HIRAGANA", "KATAKANA"}), frozenset({"CJK", "HANGUL"}), frozenset({"CJK", "BOPOMOFO"}))
#: Letters that look like others, as they are written; what they look like.
_LOOKS_LIKE = str.maketrans(
    {
        **dict(zip("АВЕЅІЈКМНОРСТУХԚԜӀ", "ABESIJKMHOPCTYXQWI", strict=True)),
        **dict(zip("авегѕіјкмнопрстухԁԛԝһӏьз", "abersijkmhonpctyxdqwhlb3", strict=True)),
        **dict(zip("ΑΒΕΖΗΙΚΜΝΟΡΤΥΧ", "ABEZHIKMNOPTYX", strict=True)),
        **dict(zip("αγεηικνορτυχω", "ayenikvoptuxw", strict=True)),
        **dict(zip("ՕՍօսհոցքզ", "OUouhngpq", strict=True)),
        **dict(zip("ɑɡıɩℓøłđħŧſðþŁØĐÐ", "agiiloldhtsdpLODD", strict=True)),
    }
)
#: After case folding: what is told apart by a good font alone.
_HARDLY_APART = str.maketrans(dict(zip("l1|!ǀǃ0", "iiiiiio", strict=True)))
_LIKE_PAIRS = (("rn", "m"), ("vv", "w"), ("æ", "ae"), ("œ", "oe"), ("ci", "d"))


def clean_name(name: str, source: str = "--name") -> str:
    """Return the name of a key in its one form (NFC), without spaces around it.

    Raises:
        KeyFileError: It can be taken for another one, is empty or too long; the message names the character.
    """
    name = unicodedata.normalize("NFC", name.strip(" \t\r\n"))
    why = _fault(name)
    if why:
        raise KeyFileError(
            f"this is no name for a key: {why}",
            where=source,
            advice=f"give one line of at most {MAX_NAME} characters, with letters of one script, digits, single spaces",
        )
    return name


def skeleton(name: str) -> str:
    """Return what is left of a name when everything is taken away that a person may overlook."""
    plain = unicodedata.normalize("NFKD", name).translate(_LOOKS_LIKE).casefold().translate(_HARDLY_APART)
    text = "".join(c for c in plain if unicodedata.category(c)[0] in "LN")
    for pair, one in _LIKE_PAIRS:
        text = text.replace(pair, one)
    return text


def _fault(name: str) -> str:
    """Return why a text is no name; empty if it is one."""
    if not name:
        return "it is empty"
    if len(name) > MAX_NAME:
        return f"it has more than {MAX_NAME} characters"
    hidden = find_hidden(name)
    if hidden is not None:
        return f"it holds a hidden character ({hidden.name})"
    if unicodedata.normalize("NFKC", name) != name:
        return f"it holds a character that stands for another one ({visible(_compatible(name))})"
    if "  " in name:
        return "it holds two spaces in a row"
    scripts: set[str] = set()
    before = ""
    for character in name:
        kind = unicodedata.category(character)
        if kind[0] == "L":
            scripts.add(_script(character))
        elif kind[0] == "M":
            if before not in ("L", "M"):
                return f"it holds a mark without a letter ({_named(character)})"
        elif kind[0] == "N" and not character.isascii():
            return f"it holds a digit that is none of 0 to 9 ({_named(character)})"
        elif kind[0] == "Z" and character != " ":
            return f"it holds a space that is none ({_named(character)})"
        before = kind[0]
    if not any(c.isalnum() for c in name):
        return "it holds no letter and no digit"
    if len(scripts) > 1 and not any(scripts <= together for together in _TOGETHER):
        return f"it mixes the scripts {' and '.join(sorted(s.title() for s in scripts))}"
    return ""


def _script(letter: str) -> str:
    """Return the script of a letter, as its Unicode name begins."""
    return unicodedata.name(letter, "unknown").split()[0].partition("-")[0]


def _named(character: str) -> str:
    return f"U+{ord(character):04X} {unicodedata.name(character, '')}".strip()


def _compatible(name: str) -> str:
    return next(_named(c) for c in name if unicodedata.normalize("NFKC", c) != c)
