"""Ends that are left out, plants that are clean, beds beside a crop, and days of sowing in words."""

from __future__ import annotations

import pytest

from fieldhand.planning.english.planner import EnglishPlanner
from fieldhand.planning.planner import Clarify
from fieldhand.robot.loader import load_robot
from fieldhand.site.model import Site
from planning.grammar.field_requests import name, require_plan, require_question
from support.sites.gardens import box, glasshouse, mark, read, vegetable_garden

GARDEN, GLASSHOUSE = vegetable_garden(), glasshouse()
AMIGA, TRACTOR = load_robot("amiga"), load_robot("tractor")

ENDS = "UnionOf(InRow(1, 1, of Rows(3, 3))+InRow(-1, -1, of Rows(3, 3)))"
WITHOUT_ENDS = f"for Excluding({ENDS}, of Where(crop, eq, radish, of Rows(3, 3))): [picture]"
POTATOES = "Rows(of Where(crop, eq, potato))"
EACH_WITHOUT = "for Excluding(UnionOf(InRow(1, 1, of Rows)+InRow(-1, -1, of Rows)), of Rows): [picture]"


@pytest.mark.parametrize(
    ("request_", "plan"),
    [
        ("Photograph all the radishes in bed 3 apart from the one at either end.", WITHOUT_ENDS),
        ("Photograph all the radishes in bed 3 apart from the two at the ends.", WITHOUT_ENDS),
        ("Photograph all the radishes in bed 3 except the ones at both ends.", WITHOUT_ENDS),
        ("Photograph all the radishes in bed 3 but not the plants at the ends.", WITHOUT_ENDS),
        ("Photograph every radish in bed 3 except for one at each end.", WITHOUT_ENDS),
        ("Photograph all the radishes in bed 3 except the end plants.", WITHOUT_ENDS),
        (
            "Photograph bed 3, leaving out the two at each end.",
            "for Excluding(UnionOf(InRow(1, 2, of Rows(3, 3))+InRow(-2, -1, of Rows(3, 3))), of Rows(3, 3)): [picture]",
        ),
        (
            "Photograph all plants in both potato beds except the end plants.",
            f"for Excluding(UnionOf(InRow(1, 1, of {POTATOES})+InRow(-1, -1, of {POTATOES})), of {POTATOES}):"
            " [picture]",
        ),
        ("Photograph all the plants in each bed apart from the one at either end.", EACH_WITHOUT),
        ("Photograph all the plants in each bed apart from the plants at the ends.", EACH_WITHOUT),
        (
            "Photograph each bed apart from the one at either end.",
            "for Excluding(UnionOf(Rows(1, 1)+Rows(-1, -1)), of Rows): [picture]",
        ),
    ],
    ids=name,
)
def test_ends_are_left_out(request_: str, plan: str) -> None:
    require_plan(GARDEN, AMIGA, request_, plan)


STAKED = "Where(staked, eq, True, of Where(crop, eq, aubergine))"
FROST = "Where(frost_damage, eq, True, of Where(crop, eq, squash))"
FEW = f"for UnionOf({FROST}+Take(2, of Where(frost_damage, eq, False, of Where(crop, eq, squash)))): [sample_leaf]"


@pytest.mark.parametrize(
    ("request_", "plan"),
    [
        ("Take leaf samples from all the squashes with frost damage and two without.", FEW),
        ("Leaf sample from every squash with frost damage, plus two without frost damage to compare.", FEW),
        ("Take leaf samples of every squash with frost damage and two ones without frost damage.", FEW),
        (
            "Photograph all netted plants and two unnetted ones.",
            "for UnionOf(Where(netted, eq, True)+Take(2, of Where(netted, eq, False))): [picture]",
        ),
        (
            "Photograph all netted beans.",
            "for Where(netted, eq, True, of Where(crop, eq, bean)): [picture]",
        ),
    ],
    ids=name,
)
def test_a_few_without_go_with_those_that_have_it(request_: str, plan: str) -> None:
    require_plan(GARDEN, AMIGA, request_, plan)


BOTH_BEDS = "for UnionOf(Rows(2, 2)+Rows(4, 4)): [picture]"


@pytest.mark.parametrize(
    ("request_", "plan"),
    [
        ("Photograph all plants in the bed beside the kale.", "for Rows(5, 5): [picture]"),
        ("Photograph the bed next to the potatoes.", "for Rows(3, 3): [picture]"),
        ("Photograph the bed next to bed 6.", "for Rows(5, 5): [picture]"),
        ("Photograph the bed west of bed 4.", "for Rows(3, 3): [picture]"),
        ("Photograph the row to the east of the radishes.", "for Rows(4, 4): [picture]"),
        ("Photograph the beds either side of the radishes.", BOTH_BEDS),
        ("Photograph both beds next to the radishes.", BOTH_BEDS),
    ],
    ids=name,
)
def test_beds_beside_a_crop(request_: str, plan: str) -> None:
    require_plan(GARDEN, AMIGA, request_, plan)


@pytest.mark.parametrize(
    "request_",
    [
        "Take six nitrate samples in the bed next to the radishes.",
        "Photograph the bed right beside the beans.",
        "Photograph every plant in the bed alongside the squashes.",
    ],
)
def test_a_bed_that_may_lie_on_either_side_is_asked_for(request_: str) -> None:
    require_question(GARDEN, AMIGA, request_, 2)


@pytest.mark.parametrize(
    ("request_", "question"),
    [
        ("Spray the usual rows before lunch.", "which rows?"),
        ("Mow the regular rows.", "which rows?"),
        ("Spray the northern rows.", "which rows?"),
        ("Photograph the usual plants.", "which ones?"),
        ("Soil moisture reading at the usual spots.", "which ones?"),
        ("Moisture reading at H1-3, go deeper than usual this time", "5 to 60 cm"),
        ("Moisture reading at H1-3, but push the probe in deeper than last time.", "5 to 60 cm"),
        ("Soil moisture at H1-3. Go a bit deeper this time.", "5 to 60 cm"),
        ("Soil moisture at H1-3, this time slightly shallower.", "5 to 60 cm"),
    ],
    ids=name,
)
def test_what_is_usual_is_asked_for(request_: str, question: str) -> None:
    outcome = EnglishPlanner().plan(request_, GLASSHOUSE, TRACTOR)
    assert isinstance(outcome, Clarify), outcome
    assert question in outcome.question


def _sown() -> Site:
    days = ("2026-02-10", "2026-03-01", "2026-04-05")
    return read(
        box(0, 0, 40, 30, kind="boundary", name="plot"),
        mark(2, 2, kind="start", name="gate post"),
        *(
            mark(5.0 + k, 5.0 + 3.0 * row, kind="plant", id=f"S{row}-{k}", row=row, sown=day)
            for row, day in enumerate(days, start=1)
            for k in range(6)
        ),
    )


@pytest.mark.parametrize(
    ("request_", "plan"),
    [
        ("Photograph everything sown since the first of March.", "for Where(sown, ge, 2026-03-01): [picture]"),
        ("Photograph the plants sown after April the first.", "for Where(sown, gt, 2026-04-01): [picture]"),
        ("Photograph all plants sown before the tenth of April.", "for Where(sown, lt, 2026-04-10): [picture]"),
    ],
    ids=name,
)
def test_days_of_sowing_are_spelt_out(request_: str, plan: str) -> None:
    require_plan(_sown(), AMIGA, request_, plan)


ACROSS = "for UnionOf(TreeIs(V33)+Across(TreeIs(V33), west)+Across(TreeIs(V33), east)): [picture]"


@pytest.mark.parametrize(
    "request_",
    [
        "Picture of radish V33 and the plant across from it in each bed beside it.",
        "Photograph V33 and the plant opposite it in the beds on both sides.",
        "Photograph V33 and the plants directly across from it in the neighbouring beds.",
        "Photograph V33 and the one opposite in each neighbouring bed.",
        "Photograph V33 and the plants opposite it on both sides.",
    ],
)
def test_plants_opposite_stand_on_both_sides(request_: str) -> None:
    require_plan(GARDEN, AMIGA, request_, ACROSS)
