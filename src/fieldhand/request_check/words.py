"""Word lists of this check: numbers, units, the compass, and common words of requests.

The lists are small and deliberately independent of the English planner's. A missing word makes the check report less,
never something wrong.
"""

from __future__ import annotations

import re
import unicodedata
from collections.abc import Sequence
from dataclasses import dataclass

from fieldhand.language import language_of_request
from fieldhand.request_check import spanish
from fieldhand.terms import Side


def words_in(text: str) -> frozenset[str]:
    """Return the words of a list separated by spaces."""
    return frozenset(text.split())


def _in_order(text: str) -> tuple[str, ...]:
    return tuple(text.split())


_UNITS = _in_order("""
    zero one two three four five six seven eight nine ten eleven twelve thirteen fourteen fifteen sixteen seventeen
    eighteen nineteen
    """)
_TENS = _in_order("twenty thirty forty fifty sixty seventy eighty ninety")
NUMBERS = {word: float(n) for n, word in enumerate(_UNITS)} | {w: 20.0 + 10 * n for n, w in enumerate(_TENS)}
ORDINALS = {
    word: n
    for n, word in enumerate(
        _in_order("""
            first second third fourth fifth sixth seventh eighth ninth tenth eleventh twelfth thirteenth fourteenth
            fifteenth sixteenth seventeenth eighteenth nineteenth
            """),
        start=1,
    )
}
ORDINALS |= {f"{word[:-1]}ieth": 20 + 10 * n for n, word in enumerate(_TENS)} | {"hundredth": 100}
#: Words for a number of things without a noun.
MULTIPLES = {
    "once": 1,
    "twice": 2,
    "thrice": 3,
    "couple": 2,
    "pair": 2,
    "brace": 2,
    "both": 2,
    "dozen": 12,
    "double": 2,
    "triple": 3,
}
#: Words that leave a number open; "as many as" is handled separately.
VAGUE = re.compile(r"\b(?:few|several|some(?! other)|handful|(?<!as )many|multiple|various|plenty|lots)\b")

LENGTHS = {
    **dict.fromkeys(["m", "metre", "metres", "meter", "meters"], 1.0),
    **dict.fromkeys(["km", "kilometre", "kilometres", "kilometer", "kilometers"], 1000.0),
    **dict.fromkeys(["cm", "centimetre", "centimetres", "centimeter", "centimeters"], 0.01),
    **dict.fromkeys(["ft", "foot", "feet"], 0.3048),
    **dict.fromkeys(["yd", "yds", "yard", "yards"], 0.9144),
    **dict.fromkeys(["mile", "miles"], 1609.344),
}
TIMES = {
    **dict.fromkeys(["s", "sec", "secs", "seconds"], 1.0),
    **dict.fromkeys(["min", "mins", "minute", "minutes"], 60.0),
    **dict.fromkeys(["h", "hr", "hrs", "hour", "hours"], 3600.0),
}
#: Words of speeds of one token, in metres per second.
SPEEDS = {
    **dict.fromkeys(["mph"], 0.44704), **dict.fromkeys(["kmh", "kph"], 1 / 3.6), "mps": 1.0, "fps": 0.3048,
}  # fmt: skip
AGES = words_in("""
    year years yr yrs month months kg kilo kilos kilogram kilograms lb lbs pound pounds g t ton tons
    l litre litres liter liters
    """)
DEGREES = words_in("c f celsius fahrenheit centigrade degree degrees deg °")
PERCENT = frozenset(["%", "percent", "pct"])

_COMPASS: tuple[Side, ...] = ("north", "east", "south", "west")
#: Compass words and their sides; a corner has two.
COMPASS: dict[str, frozenset[Side]] = {}
for _side in _COMPASS:
    for _form in ("", "s", "ern", "ernmost", "most", "erly", "ward", "wards", "bound", "erlymost"):
        COMPASS[_side + _form] = frozenset({_side})
_NORTH_SOUTH: tuple[Side, ...] = ("north", "south")
_EAST_WEST: tuple[Side, ...] = ("east", "west")
for _a in _NORTH_SOUTH:
    for _b in _EAST_WEST:
        _two: frozenset[Side] = frozenset({_a, _b})
        for _form in ("", "ern", "ernmost", "erly"):
            COMPASS[_a + _b + _form] = _two
        COMPASS[_a[0] + _b[0]] = _two
#: Words for sides of a picture or slope, which name no compass side.
VAGUE_SIDES = words_in("""
    left right top bottom upper uphill downhill front back rear sunny shady up down opposite
    across clockwise anticlockwise counterclockwise perimeter outer outermost edges border borders corners
    """)

TREES = words_in("""
    tree trees vine vines plant plants palm palms bush bushes spot spots place places point points stops location
    locations site sites position positions ones them these those
    """)
READINGS = words_in("readings measurements samples")
CORNERS = frozenset({"corner", "corners"})
#: Words for the legs of a zigzag.
LEGS = words_in("leg legs segment segments stroke strokes")
ROWS = frozenset({"row", "rows"})
#: Words that end the noun phrase that a number counts.
ENDS_PHRASE = words_in("""
    . , ; : ! ? ( ) and or then but if when where unless at in on to from with without while is are by per each
    every for that which who as until within after before along except outside inside taking take takes starting
    """)
CONDITIONAL = words_in("if when where unless until whenever wherever otherwise provided should once while")
BELOW = words_in("below under less lower fewer beneath colder cooler drier younger shorter smaller <")
ABOVE = words_in("""
    above over more greater higher exceeds exceed exceeding hotter warmer older taller larger bigger heavier >
    """)
NEGATIONS = words_in("""
    not no never without don't doesn't isn't aren't nor skip avoid except excluding instead rather neither unless
    cannot can't won't nothing none do-not besides
    """)

#: Common words of requests without content for a plan. A word in no list is unknown; in a request with unknown words,
#: no part of the plan is reported as invented.
PLAIN = words_in("""
    a an the this that these those it its it's he she they them their my our your i we you me us one ones any all
    each every both either another other others different some same such own new next last final near nearby nearest
    closest far farthest furthest away around beside between inside outside within of off on in into at to toward
    towards from by with without up down over under along across through for as so than then there here where when
    while if unless otherwise else and or but not no nor also too only just again more most less least few many much
    once twice after afterwards before finally lastly first second third until till during is are be been being was
    were am do does did done doing has have had can could will would shall should may might must let please go goes
    going went drive drives driving head move travel visit visiting return returning come coming back get gets
    getting take takes taking taken make measure measures measuring measured measurement measurements read reads
    reading readings check checks checking sample samples sampling record recording collect collecting capture
    capturing inspect inspecting survey monitor test scan probe report find finding look stop stops stopping finish
    finished end ends ending start starts starting begin beginning complete continue proceed carry repeat repeating
    process procedure thing steps step mission robot send tree trees vine vines plant plants orchard farm field
    block blocks site plot grove vineyard row rows corner corners edge edges side sides half halves quarter quarters
    part section area region zone middle centre center end ends boundary spot place point location position marker gate
    home base starting charger charging station dock possible battery charge energy power budget reserve left
    remaining remain remains keep keeping use uses using used spend time allows allow permits permit minutes minute
    seconds second hours hour metres metre meters meter feet percent degrees degree celsius fahrenheit most least
    low lower lowest high higher highest below above less greater value values level result it'll very still yet
    even order given turn apart spaced distance trees' quickly carefully slowly what which whose who how whether see
    show shows shown give send random somewhere number numbered id older younger oldest youngest old young age aged
    years year best worst first-most
    """)

_TOKEN = re.compile(
    r"\d+(?:,\d{3})+(?:\.\d+)?(?!\d)|\d+(?:\.\d+)?|[^\W\d_][^\W_]*(?:['\u2019][^\W\d_]+)?|[^\s]", re.UNICODE
)


_HALF_A_DOZEN = re.compile(r"\bhalf[ -](?:a[ -])?dozen\b")


@dataclass(frozen=True, kw_only=True)
class Token:
    """A word, number or sign of the request.

    Attributes:
        text: Text in lower case.
        sentence: Number of its sentence.
        joined: True if it follows the previous token without a space.
        typed: Text as the request has it, if that is another language's word; empty otherwise.
    """

    text: str
    sentence: int
    joined: bool
    typed: str = ""


def tokens(request: str) -> tuple[Token, ...]:
    """Return the words, numbers and signs of a request in order; in "33C", the second token is ``joined``."""
    text = unicodedata.normalize("NFKC", request).lower().replace("\N{RIGHT SINGLE QUOTATION MARK}", "'")
    text = _HALF_A_DOZEN.sub("six", text)
    found: list[Token] = []
    sentence, last = 0, -1
    for match in _TOKEN.finditer(text):
        found.append(Token(text=match.group(), sentence=sentence, joined=match.start() == last))
        last = match.end()
        sentence += match.group() in (".", "!", "?", ";")
    return tuple(found)


def tokens_of_request(request: str) -> tuple[Token, ...]:
    """Return the tokens of a request in any language that is read; those of Spanish with English words for them."""
    if language_of_request(request) != "es":
        return tokens(request)
    corrected = tokens(spanish.with_decimal_points(request))
    found: list[Token] = []
    for start, end, words in spanish.english_words([token.text for token in corrected]):
        typed = " ".join(token.text for token in corrected[start:end])
        first = corrected[start]
        for k, word in enumerate(words):
            other = word if word == typed else typed if k == 0 else " "
            found.append(Token(text=word, sentence=first.sentence, joined=first.joined and k == 0, typed=other))
    return tuple(found)


def quoted(tokens: Sequence[Token]) -> str:
    """Return tokens as the request has them."""
    return " ".join(token.typed or token.text for token in tokens if token.typed != " ")


def is_number(text: str) -> bool:
    """Return True if a token is written in digits."""
    return text[:1].isdecimal() and text.replace(",", "").replace(".", "", 1).isdecimal() and text.isascii()


def singular(word: str) -> str:
    """Return a noun without its plural ending, accurately enough to compare nouns."""
    for ending, instead in (
        ("leaves", "leaf"),
        ("ies", "y"),
        ("atoes", "ato"),
        ("sses", "ss"),
        ("xes", "x"),
        ("ches", "ch"),
        ("shes", "sh"),
    ):
        if word.endswith(ending):
            return word.removesuffix(ending) + instead
    return word.removesuffix("s") if word.endswith("s") and not word.endswith(("ss", "us")) and len(word) > 3 else word
