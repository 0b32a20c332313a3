"""Work along paths in English: rows, aisles, areas, edges; verbs are those of the robot's implements."""

from __future__ import annotations

import pytest

from fieldhand.planning.english.planner import EnglishPlanner
from fieldhand.planning.planner import Clarify, Planned, Refused
from fieldhand.robot.loader import load_robot
from fieldhand.site.loader import open_site
from planning.english.outlines import outline

ROWS = "spray rows Rows(3, 8)"
CASES = {
    "spray rows 3 to 8": ROWS,
    "Please spray rows 3 to 8 at 300 l/ha.": f"{ROWS}, rate_l_ha 300",
    "spray rows 3 to 8 with 250 l/ha": f"{ROWS}, rate_l_ha 250",
    "could you spray row 4 please": "spray rows Rows(4, 4)",
    "spray rows 2 and 5 on both sides": "spray rows UnionOf(Rows(2, 2)+Rows(5, 5)), both",
    "spray row 2 from both sides": "spray rows Rows(2, 2), both",
    "spray row 2 from both sides with 400 l/ha": "spray rows Rows(2, 2), rate_l_ha 400, both",
    "spray row 2 from the west side": "spray rows Rows(2, 2), west",
    "spray both sides of rows 2 and 3 at 400 l/ha": ("spray rows UnionOf(Rows(2, 2)+Rows(3, 3)), rate_l_ha 400, both"),
    "spray the west side of row 4 at 300 l/ha": "spray rows Rows(4, 4), rate_l_ha 300, west",
    "spray rows 3 to 8 at 300 l/ha on the west side": f"{ROWS}, rate_l_ha 300, west",
    "spray every row": "spray rows Rows",
    "spray rows 3 to 8 except row 5": "spray rows Excluding(Rows(5, 5), of Rows(3, 8))",
    "drive down rows 3 to 8 and spray": ROWS,
    "drive down rows 3 to 8 and spray them": ROWS,
    "drive along rows 3 to 8": "drive rows Rows(3, 8)",
    "drive through every second aisle": "drive aisles Trees, every 2",
    "mow between rows 3 and 6": "mow aisles Rows(3, 6)",
    "mow the aisles between rows 3 and 6": "mow aisles Rows(3, 6)",
    "mow every second aisle between rows 3 and 6": "mow aisles Rows(3, 6), every 2",
    "run the mower between rows 3 and 6": "mow aisles Rows(3, 6)",
    "mow every second aisle": "mow aisles Trees, every 2",
    "mow every other aisle": "mow aisles Trees, every 2",
    "mow the aisles": "mow aisles Trees",
    "mow the wet corner": "mow area InZone(wet corner)",
    "mow the wet corner twice": "mow area InZone(wet corner), 2 laps",
    "cover the wet corner with the mower": "mow area InZone(wet corner)",
    "mow everything but the wet corner": "mow area Excluding(InZone(wet corner))",
    "mow the orchard": "mow area Trees",
    "mow around the pond": "mow perimeter InZone(pond)",
    "mow the headlands": "mow headlands Trees",
    "film along row 7": "film rows Rows(7, 7)",
    "film every other row": "film rows Rows(2)",
    "make a video of row 4": "film rows Rows(4, 4)",
    "patrol the property line": "drive perimeter Trees",
    "patrol the fence": "drive perimeter Trees",
    "patrol the boundary twice": "drive perimeter Trees, 2 laps",
    "drive around the pond": "drive perimeter InZone(pond)",
    "drive around the orchard once": "drive perimeter Trees",
    "spray as many rows as you can": "spray rows Rows, optional",
    "spray rows 3 to 8, as much as you can": f"{ROWS}, optional",
    "mow as many aisles as you can within 10 minutes": "mow aisles Trees, optional | duration_s 600",
    "spray rows 3 to 8 if the battery allows": f"maybe [{ROWS}]",
    "spray row 4, then mow between rows 3 and 4": "spray rows Rows(4, 4); mow aisles Rows(3, 4)",
    "take a picture of tree 4 and then spray row 3": "picture @ TreeIs(4); spray rows Rows(3, 3)",
    "spray row 3 and return to the start": "spray rows Rows(3, 3) | return_to_start",
    "take a soil moisture reading at tree 4. If it is below 20 percent, spray row 3": (
        "moisture @ TreeIs(4) = r1; if r1 < 20 percent: [spray rows Rows(3, 3)]"
    ),
    "take pictures of row 3": "for Rows(3, 3): [picture]",
    "drive along row 3 and take a picture of every tree": "for Rows(3, 3): [picture]",
}
REFUSED = {
    "spray": "it does not say where",
    "spray tree 4": "along a path, not at single trees",
    "spray the yellow trees": "along a path, not at single trees",
    "spray rows 3 to 8 at 2000 l/ha": "is not between 50 and 800 l/ha",
    "spray row 40": "there is no row '40'",
    "don't spray row 4": "is a prohibition",
}


@pytest.mark.parametrize(("request_", "expected"), CASES.items())
def test_work_along_paths_is_planned(request_: str, expected: str) -> None:
    planned = EnglishPlanner().plan(request_, open_site("demo"), load_robot("tractor"))
    assert isinstance(planned, Planned), planned
    assert outline(planned.task) == expected


@pytest.mark.parametrize(("request_", "reason"), REFUSED.items())
def test_what_is_not_possible_is_refused_with_its_reason(request_: str, reason: str) -> None:
    refused = EnglishPlanner().plan(request_, open_site("demo"), load_robot("tractor"))
    assert isinstance(refused, Refused)
    assert reason in refused.reasons[0].what


@pytest.mark.parametrize("request_", ["spray rows 3 to 8", "mow the wet corner", "mow"])
def test_a_robot_without_the_implement_refuses_and_says_what_it_can_do(request_: str) -> None:
    refused = EnglishPlanner().plan(request_, open_site("demo"), load_robot("husky"))
    assert isinstance(refused, Refused)
    verb = request_.partition(" ")[0]
    assert refused.reasons[0].what == f"husky cannot {verb}: no action '{verb}'"
    assert "husky can take a thermal picture" in refused.reasons[0].advice


@pytest.mark.parametrize(
    "request_", ["drive along rows 3 to 8", "patrol the fence twice", "drive between rows 3 and 5"]
)
def test_any_robot_drives_along_paths(request_: str) -> None:
    planned = EnglishPlanner().plan(request_, open_site("demo"), load_robot("husky"))
    assert isinstance(planned, Planned)
    assert outline(planned.task).startswith("drive ")


def test_mowing_rows_asks_for_rows_or_aisles() -> None:
    asked = EnglishPlanner().plan("mow rows 3 to 8", open_site("demo"), load_robot("tractor"))
    assert isinstance(asked, Clarify)
    assert asked.choices == ("Mow along rows 3 to 8.", "Mow along the aisles between rows 3 and 8.")
