"""Groups of the grammar's terminals."""

from __future__ import annotations

VERBS = frozenset({"TAKE", "MEASURE", "ACTV", "GO", "VISIT", "RETURN", "GOHOME", "STOP", "REPEAT"})
#: What begins a part.
STARTS = VERBS | {
    "IF",
    "WHERE",
    "UNLESS",
    "UNTIL",
    "WHETHER",
    "IFSO",
    "FITS",
    "OTHERWISE",
    "TRY",
    "BUDGET",
    "THEN",
    "NOORDER",
    "INORDER",
    "ORDERED",
    "DISTINCT",
}
RELATIONS = frozenset(
    {"OF", "AT", "FROM", "NEXTTO", "NEAR", "WITHIN", "BEYOND", "INSIDE", "OUTSIDE", "EXCEPT", "WITH", "FOR"}
    | {"ALONG", "SPREAD"}
)
QUANTITY = frozenset({"DET", "EACH", "ANY", "ANOTHER", "NUM", "MORE", "ASMANY", "UPTO"})
#: Heads of noun phrases that are places.
PLACES = frozenset(
    {"TREE", "CORNER", "MIDDLE", "EDGE", "HALF", "QUARTER", "SIDE", "START", "FINISH", "CHARGER", "PLOT", "PLACE"}
    | {"ZONE", "DIR", "MOST", "IDS", "THERE", "IT"}
    | {"ROW", "ROWIDS", "BLOCKIDS", "EVERYNTH", "STEP", "OPPOSITE", "OVER"}
)
#: Words that go on with a noun phrase: a "there" of several words is none before them ("of each | tree in ...").
CONTINUES = (
    RELATIONS
    | (PLACES - {"THERE"})
    | QUANTITY
    | {"WHICH", "ATTRVAL", "ATTR", "CMP", "SUPER", "ORD", "LAST"}
    | {"NEAREST", "FARTHEST", "FAR", "NEARBY", "OTHER", "ADJACENT", "NUMBERED", "NOT", "ISNOT"}
)
#: What a condition goes on with ("if it is not | low").
TESTS = frozenset({"CMP", "LEVEL", "BETWEEN", "NUM", "ATTRVAL", "ATTR", "DIR", "NOUN", "READING", "NOT", "UPTO"})
