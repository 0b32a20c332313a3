"""What a request tells beside its command: purposes, reasons, times and appositions, and what is none of them."""

# ruff: noqa: E501 - a request and its plan stand on one line each

from __future__ import annotations

import pytest

from fieldhand.approval.account import unaccounted
from fieldhand.planning.english.planner import EnglishPlanner
from fieldhand.planning.planner import Outcome, Planned
from fieldhand.robot.loader import load_robot
from fieldhand.site.loader import open_site
from planning.english.outlines import outline

DEMO = open_site("demo")
ROBOTS = {name: load_robot(name) for name in ("husky", "amiga")}
PLANNER = EnglishPlanner(suggests=False)
#: Requests that say more than a command; a robot stands before those that are not for husky.
BESIDE = [
    ("amiga> I need to know whether the drainage in the wet corner is working. Probe soil moisture at all the trees in there.", "for InZone(wet corner): [moisture]"),
    ("amiga> I want to find out whether the wet corner is draining. Measure the soil moisture at each tree there.", "for InZone(wet corner): [moisture]"),
    ("amiga> We need to know if the wet corner is too wet. Soil moisture at every tree in it.", "for InZone(wet corner): [moisture]"),
    ("We want to see how row 5 is doing: thermal pictures of all its trees.", "for Rows(5, 5): [picture]"),
    ("We want to see how row 5 is doing. Take a picture of each of its trees.", "for Rows(5, 5): [picture]"),
    ("I'd like to see how row 5 copes with the heat. Photograph every tree in it.", "for Rows(5, 5): [picture]"),
    ("I'd like to know how row 5 is doing, so take a picture of every tree in it.", "for Rows(5, 5): [picture]"),
    ("I want to know how the Carmels are doing, so take pictures of 5 Carmel trees.", "for Take(5, of Where(variety, eq, Carmel)): [picture]"),
    ("I need to see how the Carmels are doing. Photograph them.", "for Where(variety, eq, Carmel): [picture]"),
    ("Compare the northern half and the southern half: take five CO2 readings in each.", "for UnionOf(Half(north)+Half(south)): [co2 x5]"),
    ("For the irrigation set: take a picture of tree 4.", "picture @ TreeIs(4)"),
    ("For the irrigation set: CO2 at trees 4 and 5.", "for UnionOf(TreeIs(4)+TreeIs(5)): [co2]"),
    ("For the variety comparison I need pictures of five Carmels and five Nonpareils.", "for UnionOf(Take(5, of Where(variety, eq, Carmel))+Take(5, of Where(variety, eq, Nonpareil))): [picture]"),
    ("For the variety comparison I need a picture of tree 4.", "picture @ TreeIs(4)"),
    ("For the comparison, take CO2 at tree 4 and, as a control, at tree 9.", "co2 @ TreeIs(4); co2 @ TreeIs(9)"),
    ("Take CO2 at tree 4 and at tree 9 as a control.", "co2 @ TreeIs(4); co2 @ TreeIs(9)"),
    ("As a control, take a picture of tree 4.", "picture @ TreeIs(4)"),
    ("Take a picture of tree 4 as a control.", "picture @ TreeIs(4)"),
    ("Take a picture of every tree in row 3, but not of row 4, because we did that row yesterday.", "for Excluding(Rows(4, 4), of Rows(3, 3)): [picture]"),
    ("The lab wants a CO2 sample from tree 4.", "co2 @ TreeIs(4)"),
    ("What's the air temperature at tree 4?", "air @ TreeIs(4)"),
    ("My consultant wants a picture of tree 4.", "picture @ TreeIs(4)"),
    ("My consultant wants to see tree 4. Take a picture of it.", "go TreeIs(4); picture"),
    ("My consultant wants to know how row 5 is doing. Take a picture of every tree in it.", "for Rows(5, 5): [picture]"),
    ("We are testing how much the sensors drift, so please take ten CO2 readings at tree 30.", "co2 x10 @ TreeIs(30)"),
    ("We are testing how much the sensors drift. Take ten CO2 readings at tree 30.", "co2 x10 @ TreeIs(30)"),
    ("amiga> I am looking for borer damage: take a picture of the trunk of trees 1 to 6.", "for UnionOf(TreeIs(1)+TreeIs(2)+TreeIs(3)+TreeIs(4)+TreeIs(5)+TreeIs(6)): [picture(view trunk)]"),
    ("I'm looking for signs of mites. Take a picture of trees 1 to 6.", "for UnionOf(TreeIs(1)+TreeIs(2)+TreeIs(3)+TreeIs(4)+TreeIs(5)+TreeIs(6)): [picture]"),
    ("I'm checking for leaks, so take a picture of tree 4.", "picture @ TreeIs(4)"),
    ("We're trying to find out why the leaves curl. Take a picture of tree 4.", "picture @ TreeIs(4)"),
    ("I want to find out why the leaves curl: take a picture of tree 4.", "picture @ TreeIs(4)"),
    ("I wonder whether tree 4 is sick. Photograph it.", "go TreeIs(4); picture"),
    ("Take a picture of tree 4 this morning.", "picture @ TreeIs(4) | day=today not_before=sunrise done_by=12:00"),
    ("This morning, take a picture of tree 4.", "picture @ TreeIs(4) | day=today not_before=sunrise done_by=12:00"),
    ("Take a picture of tree 4 today.", "picture @ TreeIs(4) | day=today"),
    ("Today I need a picture of tree 4.", "picture @ TreeIs(4)"),
    ("Take a picture of tree 4 now.", "picture @ TreeIs(4)"),
    ("Take a picture of tree 4 this afternoon.", "picture @ TreeIs(4) | day=today not_before=12:00 done_by=18:00"),
    ("Take a picture of tree 4 before lunch.", "picture @ TreeIs(4)"),
    ("After breakfast, take a picture of tree 4.", "picture @ TreeIs(4)"),
    ("Take a picture of tree 4 right now.", "picture @ TreeIs(4)"),
    ("Take a picture of tree 4 before the crew needs the machine back.", "picture @ TreeIs(4)"),
    ("Take a picture of tree 4 before the crew arrives.", "picture @ TreeIs(4)"),
    ("Take a picture of every tree in rows 3 to 5 except row 4 because the pruning crew is in there.", "for Excluding(Rows(4, 4), of Rows(3, 5)): [picture]"),
    ("Take a picture of tree 4, that's the short one.", "picture @ TreeIs(4)"),
    ("Take a picture of tree 4, the one by the road.", "picture @ TreeIs(4)"),
    ("Take a picture of tree 4, which is the tall one by the road.", "picture @ TreeIs(4)"),
    ("Take a picture of tree 4. If it is above 35 degrees, measure CO2 there, otherwise skip the rest and come home.", "picture @ TreeIs(4) = r1; if r1 > 35 degC: [co2] else [stop] | return_to_start"),
    ("Photograph trees 4, 5 and 6. If one is hotter than 38 degrees, skip the rest and come home.", "for UnionOf(TreeIs(4)+TreeIs(5)+TreeIs(6)): [picture = r1; if r1 > 38 degC: [stop]] | return_to_start"),
    ("My agronomist wants to know whether the Carmels are under stress. Take a picture of each of them.", "for Where(variety, eq, Carmel): [picture]"),
    ("The lab wants to find out what the northern half is short of: CO2 at every tree in it.", "for Half(north): [co2]"),
    ("We're curious whether row 5 is coping. Photograph every tree there, please.", "for Rows(5, 5): [picture]"),
    ("I wonder how row 5 is getting on. Take a picture of every tree in it.", "for Rows(5, 5): [picture]"),
    ("We wonder whether the wet corner has dried up. Take a picture of all its trees.", "for InZone(wet corner): [picture]"),
    ("To see how row 5 is doing, take a picture of every tree in it.", "for Rows(5, 5): [picture]"),
    ("To find out whether row 5 is doing well, take a picture of every tree in row 5.", "for Rows(5, 5): [picture]"),
    ("In order to see how the Carmels are coping, photograph five of them.", "for Take(5, of Where(variety, eq, Carmel)): [picture]"),
    ("The question is whether the Carmels need water. Take a picture of five Carmels.", "for Take(5, of Where(variety, eq, Carmel)): [picture]"),
    ("The aim is to find out how the heat spreads. Take a picture of trees 4, 9 and 30.", "for UnionOf(TreeIs(4)+TreeIs(9)+TreeIs(30)): [picture]"),
    ("Our goal is to see how row 5 is doing: photograph each of its trees.", "for Rows(5, 5): [picture]"),
    ("This is to check whether the drip lines work. Photograph every tree in row 3.", "for Rows(3, 3): [picture]"),
    ("Photograph every tree in row 5. I want to see how it is doing.", "for Rows(5, 5): [picture]"),
    ("Photograph every tree in row 5, I want to know how row 5 is doing.", "for Rows(5, 5): [picture]"),
    ("Take a picture of tree 4; we want to know why its leaves curl.", "picture @ TreeIs(4)"),
    ("We are comparing the Carmels with the Nonpareils. Take a picture of three Carmels and three Nonpareils.", "for UnionOf(Take(3, of Where(variety, eq, Carmel))+Take(3, of Where(variety, eq, Nonpareil))): [picture]"),
    ("We want to compare row 3 with row 9. Take pictures of every tree in row 3 and in row 9.", "for UnionOf(Rows(3, 3)+Rows(9, 9)): [picture]"),
    ("To compare rows 3 and 9, take a picture of every tree in rows 3 and 9.", "for UnionOf(Rows(3, 3)+Rows(9, 9)): [picture]"),
    ("We are looking for frost damage. Photograph every tree in row 1.", "for Rows(1, 1): [picture]"),
    ("I'm on the lookout for beetles, so please photograph tree 4.", "picture @ TreeIs(4)"),
    ("We want to check for sunburn: take a picture of the three westernmost trees.", "for Extreme(west, 3): [picture]"),
    ("I'm checking whether the sprinkler by tree 4 works. Take a picture of tree 4.", "picture @ TreeIs(4)"),
    ("I need to know how the new emitters work. Take a picture of trees 4 and 9.", "for UnionOf(TreeIs(4)+TreeIs(9)): [picture]"),
    ("My students want to see how CO2 changes through the rows. Take CO2 at the first tree of every row.", "for InRow(1, 1, of Rows): [co2]"),
    ("I am trying to find out whether tree 4 is dying. Photograph it.", "go TreeIs(4); picture"),
    ("Hi robot, I want to know how row 5 is doing, so please take a picture of every tree in it. Thanks!", "for Rows(5, 5): [picture]"),
    ("We want to see how the trees in row 5 are doing. Photograph them.", "for Rows(5, 5): [picture]"),
    ("I want to know how the oldest tree is doing. Take a picture of it.", "go Top(age_years, 1); picture"),
    ("We want to know how the trees are doing. Take a picture of row 3, every tree.", "for Rows(3, 3): [picture]"),
    ("I need to see how the almonds near the charger look. Take a picture of the three trees nearest the charger.", "for Nearest(Marker(charger), 3): [picture]"),
    ("We are wondering whether the five oldest trees are worth keeping. Photograph the five oldest trees.", "for Top(age_years, 5): [picture]"),
    ("I'd like to find out why the Carmels yield so little - photograph five of them.", "for Take(5, of Where(variety, eq, Carmel)): [picture]"),
    ("This afternoon, I need CO2 at trees 4 and 5.", "for UnionOf(TreeIs(4)+TreeIs(5)): [co2] | day=today not_before=12:00 done_by=18:00"),
    ("I need a picture of tree 4 before lunch.", "picture @ TreeIs(4)"),
    ("Before lunch take a picture of tree 4.", "picture @ TreeIs(4)"),
    ("After lunch, take a picture of tree 4. Then measure CO2 there.", "picture @ TreeIs(4); co2"),
    ("Measure CO2 at trees 4 and 9 this evening.", "for UnionOf(TreeIs(4)+TreeIs(9)): [co2] | day=today not_before=18:00 done_by=22:00"),
    ("This morning please photograph every tree in row 5.", "for Rows(5, 5): [picture] | day=today not_before=sunrise done_by=12:00"),
    ("Photograph every tree in row 5 this morning, please.", "for Rows(5, 5): [picture] | day=today not_before=sunrise done_by=12:00"),
    ("Take a picture of every tree in rows 3 to 5 except row 4, because we did that row yesterday.", "for Excluding(Rows(4, 4), of Rows(3, 5)): [picture]"),
    ("Skip row 4 because we did that row yesterday. Take a picture of every tree in rows 3 to 5.", "for Excluding(Rows(4, 4), of Rows(3, 5)): [picture]"),
    ("Photograph the oldest tree because it is the one my grandfather planted.", "picture @ Top(age_years, 1)"),
    ("Take a picture of tree 4 because the tree next to it died.", "picture @ TreeIs(4)"),
    ("Take a picture of tree 4, since row 5 was sprayed last week.", "picture @ TreeIs(4)"),
    ("Take a picture of tree 4 because it looked sick yesterday.", "picture @ TreeIs(4)"),
    ("Take a picture of tree 4 before the pickers arrive.", "picture @ TreeIs(4)"),
    ("Before the workers come, take a picture of tree 4.", "picture @ TreeIs(4)"),
    ("Take a picture of tree 4 before the kids are out of school.", "picture @ TreeIs(4)"),
    ("Take a picture of tree 4, the one with the broken stake.", "picture @ TreeIs(4)"),
    ("Take a picture of tree 4, which is the crooked one.", "picture @ TreeIs(4)"),
    ("Take a picture of tree 4, the big one beside the ditch.", "picture @ TreeIs(4)"),
    ("Take CO2 at tree 4 and, as a control, at tree 9.", "co2 @ TreeIs(4); co2 @ TreeIs(9)"),
    ("Take CO2 at tree 4, and at tree 9 as a reference.", "co2 @ TreeIs(4); co2 @ TreeIs(9)"),
    ("As a check, take CO2 at tree 4.", "co2 @ TreeIs(4)"),
    ("For the flower series: take a picture of trees 4 and 5.", "for UnionOf(TreeIs(4)+TreeIs(5)): [picture]"),
    ("Take a picture of tree 4, the crooked one by the ditch, and measure CO2 at tree 9.", "picture @ TreeIs(4); co2 @ TreeIs(9)"),
    ("I want to know how dry it is under the yellow trees. Photograph each of them, but skip those inside the wet corner.", "for Excluding(InZone(wet corner), of Where(leaf_color, eq, yellow)): [picture]"),
    ("amiga> I want to know how dry it is under the yellow trees. Take a moisture reading at each of them, but skip those inside the wet corner.", "for Excluding(InZone(wet corner), of Where(leaf_color, eq, yellow)): [moisture]"),
    ("Take a picture of trees 4 to 9, and as soon as one is above 38 degrees skip the rest and come home.", "for UnionOf(TreeIs(4)+TreeIs(5)+TreeIs(6)+TreeIs(7)+TreeIs(8)+TreeIs(9)) until r1 > 38 degC: [picture = r1] | return_to_start"),
    ("Photograph the yellow trees. Skip the rest.", "for Where(leaf_color, eq, yellow): [picture]"),
]  # fmt: skip
#: Requests that restrict the work, ask for something else as well, or have no command.
KEPT = [
    "Photograph trees 4 and 9, the one by the road.",
    "Photograph tree 4, that's the one in row 9.",
    "Photograph every tree because we leave out row 5.",
    "Wait for the crew, then take a picture of tree 4.",
    "Take a picture of tree 4 if somebody is in the row.",
    "If somebody is in the row, skip it. Take a picture of tree 4.",
    "Get a picture of the tallest tree.",
    "Take a picture of tree 4 this week.",
    "Take a picture of tree 4 first and of tree 5 this evening.",
    "Take a picture of tree 4, and after that one of tree 5 this evening.",
    "Photograph the trees that were yellow this morning.",
    "Photograph the trees where the CO2 was high this morning.",
    "Take a picture of tree 4 later today.",
    "Every morning after breakfast, take a picture of tree 4.",
    "Take a picture of tree 4, the one in row 9.",
    "Take a picture of tree 4, the yellow one.",
    "I want to know how row 5 is doing. Take a picture of 5 trees.",
    "I want to know how the Carmels are doing. Take five pictures.",
    "How is row 5 doing?",
    "I want to know how row 5 is doing.",
    "Which trees are yellow?",
    "We want to compare rows 3 and 5.",
    "I need to know whether the trees are flambéed and flambé them. Take a picture of tree 4.",
    "I want to know whether tree 4 is sick, but only if it is yellow. Take a picture of tree 4.",
    "I am looking for the yellow trees. Take a picture of tree 4.",
    "My consultant wants a video of tree 4.",
    "We did row 4 yesterday. Take a picture of every tree in rows 3 to 5.",
    "Take a picture of tree 4 before the battery is empty.",
    "Compare tree 4 with last year. Take a picture of it.",
    "We want to see how row 5 is doing. Take a picture of the first tree.",
    "I want to know how the Carmels are doing. Take a picture of five trees.",
    "We are looking for the oldest tree. Take a picture of tree 4.",
    "We want to compare row 3 with row 9. Take pictures of every tree in row 3.",
    "I want to know how row 5 is doing and whether tree 9 is sick. Take a picture of it.",
    "I want to know how row 5 is doing, but skip the yellow ones. Take a picture of every tree in it.",
    "I want to know how row 5 is doing, flambé tree 9. Take a picture of every tree in row 5.",
    "I want to know how row 5 is doing and spray it. Take a picture of every tree in it.",
    "I want to know how row 5 is doing, not row 6. Photograph every tree in it.",
    "I want to know whether row 5 is dry, without entering it. Photograph every tree in row 4.",
    "I want to know how much nitrate there is in row 5. Take a picture of every tree in it.",
    "I want to know how row 5 is doing in 20 minutes. Take a picture of every tree in it.",
    "I want to know how row 5 is doing before noon. Take a picture of every tree in it.",
    "We need to know whether only the yellow trees suffer. Photograph every tree.",
    "Compare the CO2 at tree 4 and tree 9 and take a picture where it is higher.",
    "Compare tree 4 and tree 9.",
    "To see how row 5 is doing, wait. Take a picture of tree 4.",
    "My boss wants to know how many trees are yellow. Count them.",
    "My boss wants to know whether the Carmels are sick. If they are, photograph them.",
    "I want to see how the robot drives through row 5. Take a picture of tree 4.",
    "I want to know how tree 4 is doing and then photograph tree 9.",
    "Check whether tree 4 is sick. Photograph tree 9.",
    "I want to check whether the gate is open and photograph tree 4.",
    "I want to know how row 5 is doing. Take a picture of 5 trees in row 9.",
    "I want to know how tree 4 is doing. Take a picture of the first 4 trees of row 9.",
    "Hello robot, I want to know how row 5 is doing. Take a picture of tree 4.",
    "Take a picture of tree 4 now and of tree 5 this afternoon.",
    "Take a picture of tree 4. Measure CO2 at tree 5 this afternoon.",
    "Take a picture of tree 4 this morning and this afternoon.",
    "Take a picture of tree 4 before lunch and again after lunch.",
    "Take a picture of tree 4, then this afternoon of tree 5.",
    "Take a picture of the trees we pruned this morning.",
    "Photograph the trees that were photographed this morning.",
    "Take a picture of tree 4 tomorrow before lunch.",
    "Every day before lunch take a picture of tree 4.",
    "Take a picture of tree 4 before the end of the month.",
    "Take a picture of tree 4 this month.",
    "Take a picture of the trees from this morning.",
    "Take a picture of tree 4 because only the yellow trees matter.",
    "Take a picture of tree 4 because I need CO2 at tree 9.",
    "Take a picture of tree 4 because it is old and photograph tree 9.",
    "Take a picture of tree 4 because it is old and flambé tree 9.",
    "Take a picture of every tree because we do not want row 4.",
    "Take a picture of tree 4 before the crew gets to row 5.",
    "Take a picture of tree 4 before the crew and tree 5 after it.",
    "Stop before the crew.",
    "Take a picture of tree 4 when the crew arrives.",
    "Take a picture of tree 4 until the crew arrives.",
    "Take a picture of tree 4, the next one.",
    "Take a picture of tree 4, the one to the north.",
    "Take a picture of tree 4, not the one by the road.",
    "Take a picture of the one by the road.",
    "Take a picture of the tallest one.",
    "Take CO2 at tree 4 as a video.",
    "Skip the rest.",
    "Take a picture of tree 4, the crooked one.",
    "I want to compare both ends of row 5. Take a picture of each.",
    "I want to compare the ends of row 5. Take a picture of each.",
    "We want to see how the first tree of row 5 is doing. Take a picture of it, and of the rest.",
    "We want to see how the outer trees of row 5 are doing. Photograph them.",
    "We want to see how every other tree of row 5 is doing. Photograph it.",
    "We want to see how the southern part of row 5 is doing. Photograph every tree in it.",
    "We want to see how most of row 5 is doing. Photograph every tree in it.",
    "We want to see how one of the Carmels is doing. Photograph it.",
    "We want to see how some of the Carmels are doing. Photograph them.",
    "We want to see how half of row 5 is doing. Photograph each of its trees.",
    "Photograph every tree in row 3. If one is above 38 degrees, skip the rest of the row.",
    "Photograph the rows 3 and 4, every tree. If one is above 38 degrees, skip the rest of that row and go on with the next.",
    "Skip the rest of row 4. Photograph every tree in row 5.",
    "We want to see how the gnarled trees of row 5 are doing. Photograph them.",
    "We want to see how the best of row 5 are doing. Photograph them.",
    "We want to see how the gaps in row 5 are doing. Photograph them.",
    "We want to see how the tall Carmels are doing. Photograph them.",
    "We want to see how the trees in row 5 that look sick are doing. Photograph them.",
    "We want to see how the Carmels with red leaves are doing. Photograph them.",
    "We want to see how the Carmels planted by my father are doing. Photograph them.",
    "We want to see how the Carmels by the road are doing. Photograph them.",
    "We want to see how the trees in row 5 are doing that look sick. Photograph them.",
    "We want to see how the trees in row 5 are doing, the sick ones. Photograph them.",
    "We want to see how the trees in row 5 are doing, mostly the sick ones. Photograph them.",
]  # fmt: skip


def outcome_of(request: str) -> Outcome:
    robot, arrow, said = request.partition("> ")
    return PLANNER.plan(said if arrow else request, DEMO, ROBOTS[robot if arrow else "husky"])


@pytest.mark.parametrize(("request_", "plan"), BESIDE)
def test_what_is_told_beside_a_command_leaves_the_plan_as_it_is(request_: str, plan: str) -> None:
    outcome = outcome_of(request_)
    assert isinstance(outcome, Planned), outcome
    assert outline(outcome.task) == plan


@pytest.mark.parametrize("request_", KEPT)
def test_what_restricts_the_work_or_asks_for_more_is_never_left_out(request_: str) -> None:
    assert not isinstance(outcome_of(request_), Planned)


@pytest.mark.parametrize(
    ("request_", "told"),
    [
        ("After lunch, take a picture of tree 4.", "After lunch"),
        ("I need a picture of tree 4 before breakfast.", "before breakfast"),
    ],
)
def test_the_time_of_a_mission_has_to_be_confirmed_as_the_one_of_its_approval(request_: str, told: str) -> None:
    outcome = outcome_of(request_)
    assert isinstance(outcome, Planned)
    said = f"'{told}' is taken as a remark: the mission starts when it is approved."
    assert said in outcome.task.command.warnings


@pytest.mark.parametrize(
    "request_",
    [
        "We want to see how row 5 is thriving. Photograph every tree in it.",
        "Take a picture of tree 4, the one beside the boulder.",
        "Take a picture of tree 4 because row 5 flourished yesterday.",
        "Take a picture of tree 4 before the pickers arrive.",
    ],
)
def test_what_is_told_has_to_be_confirmed(request_: str) -> None:
    outcome = outcome_of(request_)
    assert isinstance(outcome, Planned)
    assert list(unaccounted(outcome.task))
