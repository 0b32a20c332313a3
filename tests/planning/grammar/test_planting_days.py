"""Requests that choose plants by the day on which they were sown or planted."""

from __future__ import annotations

import pytest

from fieldhand.errors import PlaceError
from fieldhand.places import selectors as s
from fieldhand.places.context import Context
from fieldhand.places.resolution import resolve
from fieldhand.robot.loader import load_robot
from fieldhand.robot.model import RobotProfile
from fieldhand.site.model import Site
from planning.grammar.field_requests import name, require_plan, require_question, require_refusal
from support.sites.gardens import box, mark
from support.sites.points import read

SOWN = {1: ("pea", "2026-02-27"), 2: ("pea", "2026-04-10"), 3: ("fennel", "2026-04-10"), 4: ("sweetcorn", "2026-05-20")}


def plot(**years: str) -> Site:
    """Four beds of six plants, sown on three days."""
    plants = [
        mark(
            10.0 + 3.0 * row, 8.0 + 2.0 * k, kind="plant", id=f"P{row}{k}", row=row, crop=crop,
            sown=years.get(f"row{row}", "2026") + day[4:],
        )
        for row, (crop, day) in SOWN.items()
        for k in range(6)
    ]  # fmt: skip
    return read(box(0, 0, 60, 40, kind="boundary", name="plot"), mark(3, 3, kind="start", name="door"), *plants)


def orchard() -> Site:
    """Two rows of trees with the years in which they were planted."""
    trees = [
        mark(10.0 + 6.0 * row, 8.0 + 4.0 * k, kind="tree", id=f"T{row}{k}", row=row, planted=2000 + 10 * row + k % 2)
        for row in (1, 2)
        for k in range(6)
    ]
    return read(box(0, 0, 60, 40, kind="boundary", name="orchard"), mark(3, 3, kind="start", name="door"), *trees)


PLOT, TWO_YEARS, ORCHARD = plot(), plot(row1="2025"), orchard()
AMIGA, HUSKY = load_robot("amiga"), load_robot("husky")
BEFORE = "for Where(sown, lt, 2026-04-01): [picture]"
IN_APRIL = "Where(sown, le, 2026-04-30, of Where(sown, ge, 2026-04-01))"
IN_BEDS = (
    "for UnionOf(InRow(1, 1, of Rows(of Where(sown, lt, 2026-04-01)))"
    "+InRow(-1, -1, of Rows(of Where(sown, lt, 2026-04-01)))) given: [picture(view ground)]"
)

PLANNED = [
    (PLOT, AMIGA, "photograph the plants sown before April", BEFORE),
    (PLOT, AMIGA, "photograph every plant that was sown before 1 April", BEFORE),
    (PLOT, AMIGA, "take a picture of all plants sown before 2026-04-01", BEFORE),
    (PLOT, AMIGA, "photograph all plants that we planted before the 1st of April", BEFORE),
    (PLOT, AMIGA, "photograph the plants seeded earlier than April 2026", BEFORE),
    (PLOT, AMIGA, "photograph the plants sown in April", f"for {IN_APRIL}: [picture]"),
    (PLOT, AMIGA, "photograph the beds sown in April", f"for Rows(of {IN_APRIL}): [picture]"),
    (PLOT, AMIGA, "photograph all the April-sown beds", f"for Rows(of {IN_APRIL}): [picture]"),
    (
        PLOT,
        AMIGA,
        "photograph the April-sown peas",
        "for Where(sown, le, 2026-04-30, of Where(sown, ge, 2026-04-01, of Where(crop, eq, pea))): [picture]",
    ),
    (
        PLOT,
        AMIGA,
        "photograph the peas sown on 10 April",
        "for Where(sown, eq, 2026-04-10, of Where(crop, eq, pea)): [picture]",
    ),
    (
        PLOT,
        AMIGA,
        "photograph the peas sown on the 10th of April 2026",
        "for Where(sown, eq, 2026-04-10, of Where(crop, eq, pea)): [picture]",
    ),
    (PLOT, AMIGA, "read nitrate at every plant sown after 10 April", "for Where(sown, gt, 2026-04-10): [nitrate]"),
    (PLOT, AMIGA, "read nitrate at every plant sown since April", "for Where(sown, ge, 2026-04-01): [nitrate]"),
    (
        PLOT,
        AMIGA,
        "read nitrate at every plant sown no later than 10 April",
        "for Where(sown, le, 2026-04-10): [nitrate]",
    ),
    (
        PLOT,
        AMIGA,
        "read nitrate at every plant sown on 10 April or later",
        "for Where(sown, ge, 2026-04-10): [nitrate]",
    ),
    (
        PLOT,
        AMIGA,
        "read nitrate at every plant that was sown between 1 February and 15 April",
        "for Where(sown, le, 2026-04-15, of Where(sown, ge, 2026-02-01)): [nitrate]",
    ),
    (
        PLOT,
        AMIGA,
        "read nitrate at every plant sown in February",
        "for Where(sown, le, 2026-02-28, of Where(sown, ge, 2026-02-01)): [nitrate]",
    ),
    (
        PLOT,
        AMIGA,
        "In every bed that was sown before April, photograph the ground at the first plant and at the last plant.",
        IN_BEDS,
    ),
    (
        PLOT,
        AMIGA,
        "photograph the last-sown peas",
        "for Where(sown, eq, 2026-04-10, of Where(crop, eq, pea)): [picture]",
    ),
    (
        PLOT,
        AMIGA,
        "photograph the peas that were sown first",
        "for Where(sown, eq, 2026-02-27, of Where(crop, eq, pea)): [picture]",
    ),
    (PLOT, AMIGA, "photograph the plants that were sown most recently", "for Where(sown, eq, 2026-05-20): [picture]"),
    (PLOT, AMIGA, "photograph every plant of the bed that was sown last", "for Rows(4, 4): [picture]"),
    (PLOT, AMIGA, "photograph every plant of the earliest sown bed", "for Rows(1, 1): [picture]"),
    (
        TWO_YEARS,
        AMIGA,
        "photograph the plants sown in May 2026",
        "for Where(sown, le, 2026-05-31, of Where(sown, ge, 2026-05-01)): [picture]",
    ),
    (ORCHARD, HUSKY, "photograph the trees planted before 2020", "for Where(planted, lt, 2020): [picture]"),
    (ORCHARD, HUSKY, "photograph the trees planted in 2011", "for Where(planted, eq, 2011): [picture]"),
    (ORCHARD, HUSKY, "photograph the trees planted after 2015", "for Where(planted, gt, 2015): [picture]"),
]

ASKED = [
    (TWO_YEARS, AMIGA, "photograph the plants sown after April", 2),
    (PLOT, AMIGA, "photograph the plants sown by April", 2),
]

REFUSED = [
    (PLOT, AMIGA, "photograph the plants in April", "in April"),
    (PLOT, AMIGA, "photograph the plants sown last week", "last week"),
    (PLOT, AMIGA, "photograph the plants sown on 31 April", "April"),
    (PLOT, AMIGA, "photograph the peas sown in May", "nothing on this site matches"),
    (PLOT, AMIGA, "photograph the plants grafted in April", "in April"),
]


@pytest.mark.parametrize(("site", "robot", "request_", "plan"), PLANNED, ids=name)
def test_plants_are_chosen_by_when_they_were_sown(site: Site, robot: RobotProfile, request_: str, plan: str) -> None:
    require_plan(site, robot, request_, plan)


@pytest.mark.parametrize(("site", "robot", "request_", "ways"), ASKED, ids=name)
def test_days_that_may_be_several_are_asked_about(site: Site, robot: RobotProfile, request_: str, ways: int) -> None:
    require_question(site, robot, request_, ways)


@pytest.mark.parametrize(("site", "robot", "request_", "why"), REFUSED, ids=name)
def test_other_days_are_refused(site: Site, robot: RobotProfile, request_: str, why: str) -> None:
    require_refusal(site, robot, request_, why)


def test_dates_are_compared_and_ranked_as_days() -> None:
    def rows(selector: s.Selector) -> set[str]:
        return {place.id[1] for place in resolve(selector, PLOT, Context(here=PLOT.start))}

    assert rows(s.Where(attribute="sown", test="le", value="2026-04-10")) == {"1", "2", "3"}
    assert rows(s.Where(attribute="sown", test="gt", value="2026-04-10")) == {"4"}
    assert rows(s.Top(attribute="sown", count=6, lowest=True)) == {"1"}


@pytest.mark.parametrize("value", ["2026-02-30", "soon"])
def test_a_date_is_compared_with_a_date_only(value: str) -> None:
    with pytest.raises(PlaceError, match="cannot be above or below"):
        resolve(s.Where(attribute="sown", test="lt", value=value), PLOT, Context(here=PLOT.start))
