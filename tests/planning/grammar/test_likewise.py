"""Places that are named by others before them: the opposite side, another of its kind, the best of those ranked."""

from __future__ import annotations

import pytest

from fieldhand.planning.grammar.reader import composed
from fieldhand.planning.planner import Planned
from fieldhand.robot.loader import load_robot
from fieldhand.site.loader import open_site
from planning.english.outlines import outline

SITE, HUSKY = open_site("demo"), load_robot("husky")


@pytest.mark.parametrize(
    ("request_", "plan"),
    [
        ("Photograph 3 trees in the northern half and two in the opposite half.", "for Take(2, of Half(south))"),
        ("Photograph two trees in the north-west quarter, then 2 in the opposite quarter.", "of Quarter(se)"),
        ("Photograph the south-west corner, then the opposite corner.", "picture @ Corners(ne)"),
        ("CO2 at the north-west corner, then at the north-east one.", "co2 @ Corners(ne)"),
        ("CO2 at trees 4 and 9. Then take a picture of the northern one.", "Extreme(north, of UnionOf(TreeIs(4)+"),
        ("Sort the yellow trees by age and take CO2 at the oldest 3.", "Top(age_years, 3, of Where(leaf_color,"),
        ("Rank the trees by yield. Photograph the top 5, then the worst three.", "for Top(yield_kg, 3, True)"),
        ("Photograph the trees within 10 m of the charger and go back to it.", "go Marker(charger) | stay"),
        ("Go to tree 4, take a picture, then repeat that three more times.", "3 times: [go TreeIs(4); picture]"),
    ],
)  # fmt: skip
def test_the_last_one_of_its_kind_is_meant(request_: str, plan: str) -> None:
    outcome = composed(request_, SITE, HUSKY)
    assert isinstance(outcome, Planned)
    assert plan in outline(outcome.task)


@pytest.mark.parametrize(
    "request_",
    [
        "Photograph three trees in row 3 and two in the other half.",
        "CO2 at the northernmost tree of the northern half, then at the southern one.",
        "Photograph the southern one.",
        "Rank the trees by yield and photograph the oldest 3.",
        "Rank the trees by yield and photograph tree 4.",
        "Photograph tree 4 and come back to it.",
        "Photograph tree 4, then CO2 at tree 9, then do it two more times.",
    ],
)  # fmt: skip
def test_what_nothing_before_decides_is_not_guessed(request_: str) -> None:
    assert not isinstance(composed(request_, SITE, HUSKY), Planned)


@pytest.mark.parametrize("who", ["Nobody", "My professor hardly", "My professor never", "Not my professor"])
def test_only_a_person_who_wants_it_is_a_remark(who: str) -> None:
    assert not isinstance(composed(f"{who} wants pictures of tree 4.", SITE, HUSKY), Planned)
    assert isinstance(composed("My professor wants pictures of tree 4.", SITE, HUSKY), Planned)
