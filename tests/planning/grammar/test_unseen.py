"""Requests that were written without sight of the grammar, and their plans."""

# ruff: noqa: E501 - a request and its plan stand on one line each

from __future__ import annotations

import pytest

from fieldhand.approval.account import unaccounted
from fieldhand.planning.grammar.reader import composed
from fieldhand.planning.planner import Planned
from fieldhand.request_check import mismatches
from fieldhand.robot.loader import load_robot
from fieldhand.site.loader import open_site
from fieldhand.site.model import Site
from planning.english.outlines import outline
from planning.english.vineyards import vineyard

HUSKY = load_robot("husky")
PLANNED = {
    "demo": [
        ("Take pictures in row 4, at the yellow trees.", "for Where(leaf_color, eq, yellow, of Rows(4, 4)): [picture]"),
        ("Take CO2 readings in the northern half, at the three oldest trees.", "for Top(age_years, 3, of Half(north)): [co2]"),
        ("Take one picture in every row, at the first tree.", "for InRow(1, 1, of Rows): [picture]"),
        ("Photograph tree 3 and then go home.", "picture @ TreeIs(3) | return_to_start"),
        ("Measure CO2 at the tree nearest to the charger and the tree furthest from it.", "for UnionOf(Nearest(Marker(charger))+Farthest(Marker(charger))): [co2]"),
        ("Measure CO2 at all Nonpareil trees that yielded less than 5 kg.", "for Where(yield_kg, lt, 5, of Where(variety, eq, Nonpareil)): [co2]"),
        ("Photograph trees 1 through 4 except 2.", "for Excluding(TreeIs(2), of UnionOf(TreeIs(1)+TreeIs(2)+TreeIs(3)+TreeIs(4))): [picture]"),
        ("Go along row 4 and take a picture of each tree whose leaves are not green.", "for Where(leaf_color, ne, green, of Rows(4, 4)): [picture]"),
        ("Photograph the trees that are 8 years or older.", "for Where(age_years, ge, 8): [picture]"),
        ("CO2 at every tree with a yield of 10 kg or more", "for Where(yield_kg, ge, 10): [co2]"),
        ("I want CO2 in row 6, except where the tree is younger than 4 years.", "for Excluding(Where(age_years, lt, 4), of Rows(6, 6)): [co2]"),
        ("Take CO2 at every tree in row 3 but the yellow ones.", "for Excluding(Where(leaf_color, eq, yellow, of Rows(3, 3)), of Rows(3, 3)): [co2]"),
        ("Photograph row 6, every tree, except the last two in the row.", "for Excluding(InRow(-2, -1, of Rows(6, 6)), of Rows(6, 6)): [picture]"),
    ],
    "vineyard": [
        ("Take thermal pictures in row 12 of the North block, at the vines with vigor below 0.35.", "for Where(vigor, lt, 0.35, of Rows(12, 12, of InBlock(North))): [picture] | return_to_start"),
        ("Measure CO2 at the vine nearest the pond and at the vine furthest from it.", "co2 @ Nearest(InZone(pond)); co2 @ Farthest(InZone(pond)) | return_to_start"),
        ("Measure CO2 at every Syrah vine with vigor between 0.3 and 0.4.", "for Where(vigor, le, 0.4, of Where(vigor, ge, 0.3, of Where(variety, eq, Syrah))): [co2] | return_to_start"),
        ("Take a CO2 reading wherever vigor is under 0.35 in the South block.", "for Where(vigor, lt, 0.35, of InBlock(South)): [co2] | return_to_start"),
    ],
}  # fmt: skip
#: What the grammar leaves to a question or a refusal, and why.
NOT_PLANNED = {
    "Measure CO2 at tree 5. If it is hot, photograph it.": "CO2 is not hot",
    "If the air temperature at the start is above 30 degrees, photograph every tree in row 2; otherwise measure CO2 there.": "there: at the start, or in row 2?",
}


def site_of(name: str) -> Site:
    return open_site("demo") if name == "demo" else vineyard()


@pytest.mark.parametrize(
    ("site", "request_", "plan"), [(site, *case) for site, cases in PLANNED.items() for case in cases]
)
def test_it_is_planned_with_every_word(site: str, request_: str, plan: str) -> None:
    outcome = composed(request_, site_of(site), HUSKY)
    assert isinstance(outcome, Planned), outcome
    assert outline(outcome.task) == plan
    assert unaccounted(outcome.task) == ()
    assert mismatches(outcome.task, site_of(site), HUSKY) == ()


@pytest.mark.parametrize("request_", NOT_PLANNED)
def test_what_may_mean_something_else_is_not_planned(request_: str) -> None:
    assert not isinstance(composed(request_, site_of("demo"), HUSKY), Planned)
