"""Names of keys, restricted so that a person deciding about trust cannot confuse them.

A name is one line of letters of one script, digits 0 to 9, single spaces and punctuation. Letters of two scripts,
which may look alike (Latin and Cyrillic a), hidden characters, and compatibility forms of letters (full width,
circled) are refused. Only scripts in common use are accepted, and of scripts that resemble each other only the
letters of living languages, which bounds the table of similar letters. Names of one script can look alike, too:
:func:`look_alike` detects them (Unicode Technical Standards 39 and Annex 31).
"""

# ruff: noqa: RUF001
from __future__ import annotations

import re
import unicodedata

from fieldhand.errors import KeyFileError
from fieldhand.hidden_characters import find_hidden, visible

MAX_NAME = 80
#: Combinations of scripts accepted in one name.
_TOGETHER = (frozenset({"CJK", "HIRAGANA", "KATAKANA"}), frozenset({"CJK", "HANGUL"}), frozenset({"CJK", "BOPOMOFO"}))
#: Scripts in common use, by the first word of the names of their letters (Unicode Standard Annex 31, Table 5).
_SCRIPTS = frozenset({
    "LATIN", "GREEK", "CYRILLIC", "ARMENIAN", "GEORGIAN", "HEBREW", "ARABIC", "THAANA", "ETHIOPIC", "DEVANAGARI",
    "BENGALI", "GURMUKHI", "GUJARATI", "ORIYA", "TAMIL", "TELUGU", "KANNADA", "MALAYALAM", "SINHALA", "THAI", "LAO",
    "TIBETAN", "MYANMAR", "KHMER", "HANGUL", "CJK", "HIRAGANA", "KATAKANA", "BOPOMOFO",
})  # fmt: skip
#: Letters (without marks) of living languages in scripts that resemble Latin; covered by the table below.
_LETTERS = {
    "LATIN": re.compile("[A-Za-zßæœøłđðþıħŋəɓɗɖƙƴƒɛɔɣʋÆŒØŁĐÐÞĦŊƏƁƊƉƘƳƑƐƆƔƲ]"),
    "GREEK": re.compile("[\u0391-\u03a9\u03b1-\u03c9]"),
    "CYRILLIC": re.compile("[\u0402-\u044f\u0452-\u045f\u0490-\u04ff]"),
    "ARMENIAN": re.compile("[\u0531-\u0556\u0561-\u0586]"),
}
#: Letters and the letters that they resemble, from Unicode's confusables.
_LOOKS_LIKE = str.maketrans(
    {
        **dict(zip("АВЕЅІЈКМНОРСТУХԚԜӀЗӠҮЬӨӘГПФЛ", "ABESIJKMHOPCTYXQWI33YbΘƏΓΠΦΛ", strict=True)),
        **dict(zip("авегѕіјкмнопрстухԁԛԝһӏьзӡүөәфбґћҽӈӌ", "abersijkmhonpctyxdqwhlb33yθəφ6rheӊҷ", strict=True)),
        **dict(zip("ΑΒΕΖΗΙΚΜΝΟΡΤΥΧ", "ABEZHIKMNOPTYX", strict=True)),
        **dict(zip("αγεηικνορτυχωσςπβ", "ayenikvoptuxwocnß", strict=True)),
        **dict(zip("ՕՍՏՓօսհոռցքզգած", "OUSΦouhnngpqqwδ", strict=True)),
        **dict(zip("ɑɡıɩℓøłđħŧſðþŁØĐÐ", "agiiloldhtsdpLODD", strict=True)),
        **dict(zip("ŋɓɗɖƙƴƒɛɔɣʋŊƁƊƉƘƳƑƐƆƔƲ", "nbddkyfecyvNBDDKYFECYV", strict=True)),
        **dict(zip("ჿഠဝዐଠሀყ", "ooooouy", strict=True)),
        **dict(zip("ЫыЮюӔӕӇӋє", ("bI", "bi", "IO", "io", "AE", "ae", "Ӊ", "Ҷ", "e"), strict=True)),
    }
)
#: Characters that only a good font distinguishes, after case folding.
_HARDLY_APART = str.maketrans(dict(zip("l1|!ǀǃ0", "iiiiiio", strict=True)))
_LIKE_PAIRS = (("rn", "m"), ("vv", "w"), ("æ", "ae"), ("œ", "oe"), ("ci", "d"))


def clean_name(name: str, source: str = "--name") -> str:
    """Return the name of a key in normalized form (NFC), without surrounding spaces.

    Raises:
        KeyFileError: The name is ambiguous, empty or too long; the message names the offending character.
    """
    name = unicodedata.normalize("NFC", name.strip(" \t\r\n"))
    why = _fault(name)
    if why:
        raise KeyFileError(
            f"this is not a valid name for a key: {why}",
            where=source,
            advice=f"give one line of at most {MAX_NAME} characters, with letters of one script, digits, single spaces",
        )
    return name


def skeleton(name: str) -> str:
    """Return a name reduced to the features that a person is sure to notice."""
    plain = unicodedata.normalize("NFKD", name).translate(_LOOKS_LIKE).casefold().translate(_HARDLY_APART)
    text = "".join(c for c in plain if unicodedata.category(c)[0] in "LN")
    for pair, one in _LIKE_PAIRS:
        text = text.replace(pair, one)
    return text


def look_alike(one: str, other: str) -> bool:
    """Return True if a person may mistake one name for the other, ignoring case."""
    return skeleton(one) == skeleton(other) or _bare(one) == _bare(other)


def _bare(name: str) -> str:
    return "".join(c for c in unicodedata.normalize("NFKD", name).casefold() if unicodedata.category(c)[0] in "LN")


def _fault(name: str) -> str:
    """Return the reason why a text is not a valid name, or an empty string if it is valid."""
    if not name:
        return "it is empty"
    if len(name) > MAX_NAME:
        return f"it has more than {MAX_NAME} characters"
    hidden = find_hidden(name)
    if hidden is not None:
        return f"it contains a hidden character ({hidden.name})"
    if unicodedata.normalize("NFKC", name) != name:
        return f"it contains a character that is a variant of another one ({visible(_compatible(name))})"
    if "  " in name:
        return "it contains two spaces in a row"
    scripts: set[str] = set()
    before = ""
    for character in name:
        kind = unicodedata.category(character)
        if kind[0] == "L":
            scripts.add(_script(character))
        elif kind[0] == "M":
            if before not in ("L", "M"):
                return f"it contains a combining mark without a letter ({_named(character)})"
        elif kind[0] == "N" and not character.isascii():
            return f"it contains a digit other than 0 to 9 ({_named(character)})"
        elif kind[0] == "Z" and character != " ":
            return f"it contains a space character other than the plain space ({_named(character)})"
        before = kind[0]
    if not any(c.isalnum() for c in name):
        return "it contains neither a letter nor a digit"
    bare = (c for c in unicodedata.normalize("NFD", name) if unicodedata.category(c)[0] == "L")
    strange = next((c for c in bare if not _is_used(c)), "")
    if strange:
        return f"it contains a letter that no living language uses in names ({_named(strange)})"
    if len(scripts) > 1 and not any(scripts <= together for together in _TOGETHER):
        return f"it mixes the scripts {' and '.join(sorted(s.title() for s in scripts))}"
    return ""


def _is_used(letter: str) -> bool:
    """Return True for a letter, without its marks, of a script and a language in common use."""
    script = _script(letter)
    return script in _SCRIPTS and (script not in _LETTERS or _LETTERS[script].fullmatch(letter) is not None)


def _script(letter: str) -> str:
    """Return the script of a letter, as its Unicode name begins."""
    return unicodedata.name(letter, "unknown").split()[0].partition("-")[0]


def _named(character: str) -> str:
    return f"U+{ord(character):04X} {unicodedata.name(character, '')}".strip()


def _compatible(name: str) -> str:
    return next(_named(c) for c in name if unicodedata.normalize("NFKC", c) != c)
