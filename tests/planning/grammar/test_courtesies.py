"""Many ways to say the same: synonyms, greetings, thanks, names and reasons around one command."""

from __future__ import annotations

import pytest

from fieldhand.planning.english.planner import EnglishPlanner
from fieldhand.planning.planner import Planned
from fieldhand.robot.loader import load_robot
from fieldhand.site.loader import open_site
from planning.english.outlines import outline

PLANNER = EnglishPlanner(suggests=False)

#: Requests for the CO2 at tree 4.
SAME = [
    "co2 @ tree 4",
    "co2 at tree no. 4 pls, thx",
    "CO2 at the plant with id 4",
    "CO2 at specimen 4",
    "carbonic gas at tree 4",
    "the carbon dioxide in the air at tree 4",
    "Thou shalt take CO2 at tree 4.",
    "Canst thou take CO2 at tree 4?",
    "give me the CO2 at tree 4",
    "give tree 4 a CO2 reading",
    "CO2 at tree 4, gracias",
    "S'il vous plaît, CO2 at tree 4.",
    "CO2 at tree 4, por favor",
    "CO2 at tree 4, bitte, danke schön",
    "CO2 at tree 4, dziękuję",
    "Yes: CO2 at tree 4, no less.",
    "Righto, sonny: CO2 at tree 4, quick as you like.",
    "CO2 at tree 4, if it please you, and thank you dear",
    "Heck, just get CO2 at tree 4.",
    "CO2 at tree 4, naturally.",
    "CO2, naturally, at tree 4.",
    "CO2 at tree 4, as it were. Yours sincerely",
    "CO2 at tree 4. Kind regards, the office.",
    "CO2 at tree 4. Regards, Maria",
    "CO2 at tree 4, thanks, Maria",
    "Lo! CO2 at tree 4.",
    "CO2 at tree 4, without further ado.",
    "Roger. CO2 at tree 4. Over.",
    "Here's the thing: CO2 at tree 4.",
    "okay robot comma CO2 at tree 4 full stop",
    "CO2 at tree 4 new line thanks",
    "Ramon says CO2 at tree 4.",
    "Mr Henderson asks for CO2 at tree 4.",
    "Dr. Lopez would like CO2 at tree 4.",
    "Maria at the office needs CO2 at tree 4.",
    "The boss wants CO2 at tree 4.",
    "As Ramon would say, CO2 at tree 4.",
    "Piotr is ill. CO2 at tree 4.",
    "CO2 at tree 4 (the boss is mad for it).",
    "So my foreman's superstitious, which is why I'm telling you: CO2 at tree 4.",
    "CO2 at tree 4, given the heat.",
    "CO2 at tree 4 on account of the heat.",
    "CO2 at tree 4, seeing as it's sunny.",
    "With the heat we've had, CO2 at tree 4.",
    "Now that the pickers have left, CO2 at tree 4.",
    "For the sake of replication, CO2 at tree 4.",
    "CO2 at tree 4, for old times' sake.",
    "CO2 at tree 4, if I'm not mistaken.",
    "CO2 at tree 4, that poor thing.",
    "Being curious, I'd like CO2 at tree 4.",
    "Long day, eh? CO2 at tree 4.",
    "Re irrigation trial: CO2 at tree 4.",
]
#: Requests that drive to tree 4 first.
DRIVEN = [
    "Trot over to tree 4 and nab a CO2 reading.",
    "Mosey on over to tree 4 and have a sniff of the CO2.",
    "Betake thyself to tree 4 and procure a CO2 sample.",
    "Hop along to tree 4, bag us a CO2.",
    "Get thee to tree 4 and take there the CO2.",
    "Swing round to tree 4; ascertain the CO2.",
    "Convey thyself unto tree 4 and there measure the CO2.",
    "Be so good as to pop across to tree 4 for a CO2 reading.",
    "Re: tree 4. Take CO2 there.",
]
#: Other requests with synonyms.
OTHERS = [
    ("infrared of tree 4", "picture @ TreeIs(4)"),
    ("IR tree 4", "picture @ TreeIs(4)"),
    ("tree 4 must be thermally photographed", "picture @ TreeIs(4)"),
    ("take heat pics of trees 4 and 5", "for UnionOf(TreeIs(4)+TreeIs(5)): [picture]"),
    ("pictures of the three plants closest to the water", "for Nearest(InZone(pond), 3): [picture]"),
    ("pictures of the two eldest trees", "for Top(age_years, 2): [picture]"),
    ("give trees 4 and 5 a picture each", "for UnionOf(TreeIs(4)+TreeIs(5)): [picture]"),
    ("CO2 at tree 4, thanks, and tree 5", "for UnionOf(TreeIs(4)+TreeIs(5)): [co2]"),
    ("CO2 at every tree within about 20 m of the charger", "for Within(20, Marker(charger)): [co2]"),
    ("CO2 at roughly five trees in row 3", "for Take(5, of Rows(3, 3)): [co2]"),
    ("Photograph tree 4, then back to the start, for there I wait.", "picture @ TreeIs(4) | return_to_start"),
    ("CO2 at trees 4, no, I had it backwards, 5.", "co2 @ TreeIs(5)"),
    ("CO2 at trees 4 to 6 (inclusive).", "for UnionOf(TreeIs(4)+TreeIs(5)+TreeIs(6)): [co2]"),
    ("Boss say CO2 at tree 4.", "co2 @ TreeIs(4)"),
    ("Response: CO2. Trees 4 and 5.", "for UnionOf(TreeIs(4)+TreeIs(5)): [co2]"),
    ("Row 4, every tree, CO2, whatever order burns least.", "for Rows(4, 4): [co2]"),
    ("CO2 at five Carmels, any ones you can reach cheaply.", "for Take(5, of Where(variety, eq, Carmel)): [co2]"),
    ("Rows 3 to 5, every tree, CO2, row 4 gets passed over.", "for Excluding(Rows(4, 4), of Rows(3, 5)): [co2]"),
    ("Trees 4 and 5 want their picture taken.", "for UnionOf(TreeIs(4)+TreeIs(5)): [picture]"),
    ("picture of tree 4. If it is 38 or hotter, CO2.", "picture @ TreeIs(4) = r1; if r1 >= 38 degC: [co2]"),
    ("picture of tree 4. If it is superior to 38 degrees, CO2.", "picture @ TreeIs(4) = r1; if r1 > 38 degC: [co2]"),
    ("picture of tree 4. If it's more hot than 38 degrees, CO2.", "picture @ TreeIs(4) = r1; if r1 > 38 degC: [co2]"),
]  # fmt: skip
#: Requests that ask for something else as well, or that this robot cannot do.
KEPT = [
    "Nobody wants CO2 at tree 4.",
    "Hardly anybody wants CO2 at tree 4.",
    "CO2 at tree 4, thanks, flambé tree 5",
    "CO2 at tree 4. Regards. Flambé the Carmels.",
    "CO2 at tree 4, regards, Flambé the Carmels.",
    "CO2 at tree 4. If it is about 400, take a picture.",
    "CO2 at tree 4. If it's roughly 400 ppm, take a picture.",
    "CO2 at tree 4, Ramon's plum too",
    "Ramon says spray tree 4.",
    "Ramon says no pictures. CO2 at tree 4.",
    "My foreman's plum, CO2 at tree 4.",
    "Piotr is tree 9. CO2 at tree 4.",
    "Zinfandel is dying. CO2 at tree 4 and at it.",
    "Kerman is the one I mean. CO2 at every tree.",
    "Radon is wanted. CO2 at tree 4.",
    "We wait for the crew at tree 4, then take a picture of it.",
    "I wait two minutes at each tree. CO2 at trees 4 and 5.",
    "At tree 4 I wait. CO2 there.",
    "Take CO2 at row 3 backwards.",
    "CO2 at the five oldest trees, any ones you can reach cheaply.",
    "give tree 4 a shake",
    "give tree 4 water",
    "water the plants",
    "CO2 at every tree because only the Carmels matter",
    "CO2 at every tree now that the Carmels are closed",
    "Take CO2 at tree 4, man the pumps.",
    "Take CO2 at tree 4, love the Carmels.",
    "CO2 at tree 4, bar the Carmels.",
]
#: Thermal pictures, which a robot with a colour camera cannot take.
THERMAL = [
    "IR of tree 4",
    "infrared of tree 4",
    "thermally photograph tree 4",
    "a heat image of tree 4",
    "thermals of tree 4",
]


@pytest.mark.parametrize("request_", SAME)
def test_words_around_a_command_leave_it_as_it_is(request_: str) -> None:
    outcome = PLANNER.plan(request_, open_site("demo"), load_robot("husky"))
    assert isinstance(outcome, Planned), outcome
    assert outline(outcome.task) == "co2 @ TreeIs(4)"


@pytest.mark.parametrize("request_", DRIVEN)
def test_verbs_of_motion_mean_the_same(request_: str) -> None:
    outcome = PLANNER.plan(request_, open_site("demo"), load_robot("husky"))
    assert isinstance(outcome, Planned), outcome
    assert outline(outcome.task) == "go TreeIs(4); co2"


@pytest.mark.parametrize(("request_", "plan"), OTHERS)
def test_synonyms_mean_the_same(request_: str, plan: str) -> None:
    outcome = PLANNER.plan(request_, open_site("demo"), load_robot("husky"))
    assert isinstance(outcome, Planned), outcome
    assert outline(outcome.task) == plan


@pytest.mark.parametrize("request_", KEPT)
def test_what_asks_for_something_is_no_courtesy(request_: str) -> None:
    assert not isinstance(PLANNER.plan(request_, open_site("demo"), load_robot("husky")), Planned)


@pytest.mark.parametrize("request_", THERMAL)
def test_a_colour_camera_takes_no_thermal_pictures(request_: str) -> None:
    assert not isinstance(PLANNER.plan(request_, open_site("demo"), load_robot("amiga")), Planned)
