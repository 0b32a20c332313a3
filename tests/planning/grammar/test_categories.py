"""Every category of the grammar has one type of meaning, so that no construction is given what it cannot take."""

from __future__ import annotations

import re
from collections import defaultdict

from fieldhand.planning.grammar.english import ENGLISH

#: Words of annotations that say how many meanings there are, and not of what type.
_AROUND = {"list", "None", "tuple", "Sequence", "Any"}


def test_no_category_has_both_words_and_meanings() -> None:
    types: dict[str, set[str]] = defaultdict(set)
    for constructions in ENGLISH.grammar().by_first.values():
        for one in constructions:
            said = one.compose.__annotations__["return"]
            types[one.result] |= set(re.findall(r"\w+", said)) - _AROUND
    assert "PlaceMeaning" in types["place"], "the test sees no types"
    mixed = {
        name: found for name, found in types.items() if "str" in found and found & {"PlaceMeaning", "Selector", "Said"}
    }
    assert mixed == {}
