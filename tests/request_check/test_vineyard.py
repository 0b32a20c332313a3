"""The check on a vineyard whose blocks are called North and South: it compares what a plan comes to, not its words."""

from __future__ import annotations

from functools import cache

import pytest

from fieldhand.planning.llm.review import read_draft
from fieldhand.request_check import PlanMismatch, mismatches
from fieldhand.robot.capabilities import capabilities_of
from fieldhand.robot.loader import load_robot
from fieldhand.site.model import Site
from fieldhand.task.build import make_task
from fieldhand.task.codec import TaskDraft
from support.sites.points import point, read

LON, LAT = -122.2869, 38.2989
HUSKY = load_robot("husky")
PICTURE = "<body><act><take_thermal_picture/></act></body>"
CO2 = "<body><act><read_co2/></act></body>"


@cache
def vineyard() -> Site:
    """Two blocks of 6 rows of 8 vines, 200 m apart, a start and a gate."""
    vines = [
        point(
            LON + 3e-5 * row,
            LAT + 1.7e-5 * k + (0.002 if block == "North" else 0.0),
            id=f"{block[0]}{row * 8 + k + 1}",
            block=block,
            variety=("Merlot", "Syrah")[row % 2],
        )
        for block in ("North", "South")
        for row in range(6)
        for k in range(8)
    ]
    return read(*vines, point(LON, LAT - 2e-4, kind="start"), point(LON - 2e-4, LAT, kind="gate", name="gate"))


def doubts(request: str, plan: str, constraints: str = "") -> tuple[PlanMismatch, ...]:
    document = f"<task><task-composition><plan>{plan}</plan></task-composition>{constraints}</task>"
    draft = read_draft(document, capabilities_of(HUSKY))
    assert isinstance(draft, TaskDraft), draft
    task = make_task(request=request, plan=draft.plan, measures={}, constraints=draft.constraints, nominal="stay")
    return mismatches(task, vineyard(), HUSKY)


IN_NORTH = '<in-block block="North"/>'
RIGHT = [
    (
        "Take a picture of the third vine from the south in row 2 of the north block.",
        '<act><take_thermal_picture/><at><in-row first="3" last="3" counted-from="south"><rows first="2" last="2">'
        f"{IN_NORTH}</rows></in-row></at></act>",
    ),
    (
        "Take pictures of the second row from the east in the south block.",
        '<for-each><select><rows first="2" last="2" counted-from="east"><in-block block="South"/></rows></select>'
        f"{PICTURE}</for-each>",
    ),
    (
        "Check CO2 at S7; if it is above 450 ppm, check the vines before and after it.",
        '<sequence><act reading="a"><read_co2/><at><tree-is tree="S7"/></at></act><if><condition><compare reading="a" '
        'test="gt"><co2 value="450" unit="ppm"/></compare></condition><then><for-each><select><union>'
        '<along-row trees="1" towards="up"><tree-is tree="S7"/></along-row>'
        '<along-row trees="1" towards="down"><tree-is tree="S7"/></along-row>'
        f"</union></select>{CO2}</for-each></then></if></sequence>",
    ),
    (
        "Take a picture of vine N8 in the north block.",
        '<act><take_thermal_picture/><at><tree-is tree="N8"/></at></act>',
    ),
    (
        "Measure CO2 at 3 vines, N12 and its neighbours.",
        '<sequence><act><read_co2/><at><tree-is tree="N12"/></at></act><for-each><select><nearest count="2" '
        f'adjacent="true"><to><tree-is tree="N12"/></to></nearest></select>{CO2}</for-each></sequence>',
    ),
    (
        "Take a picture of the northernmost Merlot, from there go north to south.",
        '<for-each order="given"><select><ordered by="north_to_south"><where attribute="variety" test="eq" '
        f'value="Merlot"/></ordered></select>{PICTURE}</for-each>',
    ),
    (
        "Take pictures of the vines along the edge of the south block.",
        "<for-each><select><union>"
        + "".join(
            f'<edge side="{side}"><in-block block="South"/></edge>' for side in ("north", "east", "south", "west")
        )
        + f"</union></select>{PICTURE}</for-each>",
    ),
    (
        "Measure CO2 in each corner of the south block; if the first one is above 900 ppm, stop.",
        '<sequence><act reading="a"><read_co2/><at><corners which="nw"><in-block block="South"/></corners></at></act>'
        '<if><condition><compare reading="a" test="gt"><co2 value="900" unit="ppm"/></compare></condition><then><stop/>'
        '</then></if><for-each><select><corners which="ne se sw"><in-block block="South"/></corners></select>'
        f"{CO2}</for-each></sequence>",
    ),
    (
        "Take pictures of 3 vines of a row, every second one.",
        f'<for-each><select><every-nth nth="2"><successive count="5"/></every-nth></select>{PICTURE}</for-each>',
    ),
    (
        "Measure CO2 at N12 and at 4 vines next to it in that row, every second one.",
        '<sequence><act label="a"><read_co2/><at><tree-is tree="N12"/></at></act><for-each><select><every-nth nth="2">'
        f"<excluding><places><here/></places><of><row-of/></of></excluding></every-nth></select>{CO2}</for-each>"
        "</sequence>",
    ),
    (
        "Take 8 pictures, two at each end of rows 2 and 3 of the south block.",
        '<for-each><select><union><in-row first="1" last="1"><rows first="2" last="3"><in-block block="South"/></rows>'
        '</in-row><in-row first="-1" last="-1"><rows first="2" last="3"><in-block block="South"/></rows></in-row>'
        '</union></select><body><act count="2"><take_thermal_picture/></act></body></for-each>',
    ),
    (
        "Take a picture of one vine of each variety in the south block.",
        "<for-each><select><union>"
        + "".join(
            f'<take count="1"><where attribute="variety" test="eq" value="{name}"><in-block block="South"/></where>'
            "</take>"
            for name in ("Merlot", "Syrah")
        )
        + f"</union></select>{PICTURE}</for-each>",
    ),
    (
        "Go to the gate and take a picture of the vine nearest to it.",
        '<sequence><go-to><gate-is gate="gate"/></go-to><act><take_thermal_picture/><at><nearest><to><here/></to>'
        "</nearest></at></act></sequence>",
    ),
]


@pytest.mark.parametrize(("request_", "plan"), RIGHT, ids=[request[:40] for request, _ in RIGHT])
def test_a_right_plan_for_a_vineyard_is_not_doubted(request_: str, plan: str) -> None:
    assert doubts(request_, plan) == ()


SPEED = '<act><take_thermal_picture/><at><tree-is tree="N1"/></at></act>'


@pytest.mark.parametrize(
    ("request_", "constraints", "doubted"),
    [
        ("Take a picture of N1, driving at 1.8 km per hour at most.", '<constraints speed-m-s="0.5"/>', False),
        ("Take a picture of N1 at 0.5 m/s at most.", '<constraints speed-m-s="0.5"/>', False),
        ("Take a picture of N1 at 0.5 m/s at most.", '<constraints speed-m-s="0.7"/>', True),
        ("Take a picture of N1 at 0.5 m/s at most.", "", True),
        ("Take a picture of N1.", '<constraints speed-m-s="0.7"/>', True),
    ],
)
def test_a_speed_is_no_distance_and_is_the_one_that_is_said(request_: str, constraints: str, doubted: bool) -> None:
    assert bool(doubts(request_, SPEED, constraints)) == doubted


WRONG = [
    (
        "Take a picture of the third vine in row 2 of the north block.",
        '<act><take_thermal_picture/><at><in-row first="3" last="3"><rows first="2" last="2"><in-block block="South"/>'
        "</rows></in-row></at></act>",
        "'north'",
    ),
    (
        "Take a picture of vine N8 in the south block.",
        '<act><take_thermal_picture/><at><tree-is tree="N8"/></at></act>',
        "'south'",
    ),
    (
        "Measure CO2 at 4 vines, N12 and its neighbours.",
        '<sequence><act><read_co2/><at><tree-is tree="N12"/></at></act><for-each><select><nearest count="2" '
        f'adjacent="true"><to><tree-is tree="N12"/></to></nearest></select>{CO2}</for-each></sequence>',
        "no steps of the plan add up to 4",
    ),
    (
        "Go to the gate and take a picture of N1.",
        '<act><take_thermal_picture/><at><tree-is tree="N1"/></at></act>',
        "gate",
    ),
    (
        "Take pictures of 4 vines of a row, every second one.",
        f'<for-each><select><every-nth nth="2"><successive count="5"/></every-nth></select>{PICTURE}</for-each>',
        "no steps of the plan add up to 4",
    ),
    ("Take a picture of every vine.", '<sequence><go-to><gate-is gate="gate"/></go-to></sequence>', "gate"),
    (
        "Take a picture of every Merlot in the north block.",
        f'<for-each><select><where attribute="variety" test="eq" value="Syrah">{IN_NORTH}</where></select>{PICTURE}'
        "</for-each>",
        "merlot",
    ),
    (
        "Take a picture of vine N48.",
        '<act><take_thermal_picture/><at><tree-is tree="N4"/></at></act>',
        "the plan names tree 'N4'",
    ),
    (
        "Take pictures of N1, N12 and N2.",
        f'<for-each><select><union><tree-is tree="N1"/><tree-is tree="N2"/></union></select>{PICTURE}</for-each>',
        "the request names tree N12",
    ),
    (
        "Take pictures of row 5 of the north block.",
        f'<for-each><select><rows first="6" last="6">{IN_NORTH}</rows></select>{PICTURE}</for-each>',
        "the plan names row 6",
    ),
    (
        "Take pictures of rows 3 to 5 of the north block.",
        f'<for-each><select><rows first="3" last="6">{IN_NORTH}</rows></select>{PICTURE}</for-each>',
        "the plan names row 6",
    ),
]


@pytest.mark.parametrize(("request_", "plan", "says"), WRONG, ids=[request[:40] for request, _, _ in WRONG])
def test_a_wrong_plan_for_a_vineyard_is_doubted(request_: str, plan: str, says: str) -> None:
    assert any(says in found.what for found in doubts(request_, plan))
