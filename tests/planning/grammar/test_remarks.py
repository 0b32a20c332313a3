"""Remarks ask for nothing and are left out; what asks for something never is."""

# ruff: noqa: E501 - a request and its plan stand on one line each
from __future__ import annotations

import pytest
from hypothesis import given
from hypothesis import strategies as st

from fieldhand.approval.account import unaccounted
from fieldhand.planning.english.planner import EnglishPlanner
from fieldhand.planning.grammar.english import ENGLISH
from fieldhand.planning.grammar.reader import composed
from fieldhand.planning.grammar.remarks import without_remarks
from fieldhand.planning.grammar.words import edges_of
from fieldhand.planning.planner import Planned
from fieldhand.robot.loader import load_robot
from fieldhand.site.loader import open_site
from fieldhand.task.filler_words import is_filler
from planning.english.outlines import outline

ROBOT = load_robot("husky")
PLANNER = EnglishPlanner(suggests=False)
COMMAND = "take a picture of tree 4"
REMARKS = (
    "We had a leak last week.",
    "My grandfather planted this orchard.",
    "For the irrigation report,",
    "The almonds looked gloomy yesterday.",
)
REASONS = (
    ", so we can check for water stress",
    " because the foreman insists",
    " for the lab",
    " since we promised it",
)


#: Requests for a picture of tree 4 that say more, which asks for nothing.
TOLD = [
    "Good morning robot, hope you slept well and your battery is full! Take a picture of tree 4.",
    "Morning! Take a picture of tree 4.",
    "Good evening, my friend. Take a picture of tree 4.",
    "Howdy! Take a picture of tree 4.",
    "I hope you are well. Take a picture of tree 4.",
    "Take a picture of tree 4. I hope this works.",
    "Take a picture of tree 4. I owe you a beer!",
    "I trust the new tyres are fine. Take a picture of tree 4.",
    "My grandfather put in most of this orchard, you know, and he always swore by the Nonpareils. Take a picture of tree 4.",
    "My old Carmels always sulked in the heat. Take a picture of tree 4.",
    "We think the two-year-olds are suffering from the heat. Take a picture of tree 4.",
    "We think the young ones are suffering from the heat. Take a picture of tree 4.",
    "In my day we always checked the leaves by hand. Take a picture of tree 4.",
    "The neighbours complained about dust again. Take a picture of tree 4.",
    "My wife worries about the Carmels. Take a picture of tree 4.",
    "It was awfully hot out there. Take a picture of tree 4.",
    "It's been a dreadful summer. Take a picture of tree 4.",
    "This is for my thesis. Take a picture of tree 4.",
    "Our agronomist visited the orchard and she worried about the heat. Take a picture of tree 4.",
    "They have promised us rain for weeks. Take a picture of tree 4.",
    "I fret about these trees. Take a picture of tree 4.",
    "I remember planting them with my father. Take a picture of tree 4.",
    "Everybody here loves the Nonpareils. Take a picture of tree 4.",
    "I am new to this. Take a picture of tree 4.",
    "I'm a bit worried. Take a picture of tree 4.",
    "We are writing a paper about heat stress. Take a picture of tree 4.",
    "The almonds looked gloomy yesterday, and my brother thinks it is the heat. Take a picture of tree 4.",
    "I like to know how the air is by the water. Take a picture of tree 4.",
    "I wonder how they are coping. Take a picture of tree 4.",
    "How are you? Take a picture of tree 4.",
    "How is it going? Take a picture of tree 4.",
    "Are you awake? Take a picture of tree 4.",
    "Systematic design: take a picture of tree 4.",
    "Paired sampling: take a picture of tree 4.",
    "Adaptive cluster sampling: take a picture of tree 4.",
    "Stress survey: take a picture of tree 4.",
    "Morning plan: take a picture of tree 4.",
    "Background: take a picture of tree 4.",
    "For our records we need a picture of tree 4.",
    "For my mother's sake, take a picture of tree 4.",
    "Take a picture of tree 4, that's the short one.",
    "Take a picture of tree 4, my grandfather planted it.",
    "Take a picture of tree 4, there's a good fellow.",
    "Take a picture of tree 4, so we can see whether they get enough water.",
    "Take a picture of tree 4, since my boss insists.",
    "Take a picture of tree 4, fingers crossed.",
    "So sorry to bother you, take a picture of tree 4.",
    "Sorry to be a pain. Take a picture of tree 4.",
    "Oh dear. Take a picture of tree 4.",
    "As you may know, take a picture of tree 4.",
    "A picture of tree 4 is wanted.",
    "I'd be most grateful if you took a picture of tree 4.",
    "I'd appreciate it if you took a picture of tree 4.",
    "Hope all is well over there. Take a picture of tree 4, thank you kindly.",
    "Take a picture of tree 4, it's my favourite.",
    "Top of the morning to you! Take a picture of tree 4.",
    "I had a dream about this place. Take a picture of tree 4.",
    "It has been a long week. Take a picture of tree 4.",
    "My knees are killing me. Take a picture of tree 4.",
    "Our irrigation guy complained about the pressure. Take a picture of tree 4.",
    "We bought this farm from the Millers. Take a picture of tree 4.",
    "My late husband adored the Carmels. Take a picture of tree 4.",
    "They say the heat is hard on them. Take a picture of tree 4.",
    "I'm writing my dissertation about almonds. Take a picture of tree 4.",
    "My students are curious about the heat. Take a picture of tree 4.",
    "This is a pilot study. Take a picture of tree 4.",
    "Experimental protocol: take a picture of tree 4.",
    "Sampling plan: take a picture of tree 4.",
    "Work order: take a picture of tree 4.",
    "For our customer we need a picture of tree 4.",
    "Take a picture of tree 4, as my supervisor insists.",
    "Take a picture of tree 4 because I'm curious.",
    "Take a picture of tree 4, I'd love to see how it copes.",
    "Take a picture of tree 4. I bet it looks awful.",
    "Take a picture of tree 4. You are doing great!",
    "Take a picture of tree 4. Thanks a million!",
    "Take a picture of tree 4 (my daughter named it Rosie).",
    "I was wondering if you'd be able to take a picture of tree 4.",
]  # fmt: skip
#: Requests for a picture of tree 4 in polite frames.
FRAMED = [
    "Would it be at all possible, if it's no bother, to take a picture of tree 4?",
    "I was wondering whether it might be possible for you to take a picture of tree 4.",
    "I was wondering whether you might be able to take a picture of tree 4.",
    "Might I trouble you for a picture of tree 4?",
    "Please to make a picture of tree 4.",
    "A thermal photo of tree 4 would help us.",
    "A picture of tree 4 would be much appreciated.",
    "A picture of tree 4 is requested, please.",
    "Take a picture of tree 4, would you?",
    "Kindly take a picture of tree 4.",
    "Would you be able to take a picture of tree 4?",
    "Could you possibly take a picture of tree 4?",
    "Could I trouble you to take a picture of tree 4?",
    "I would be grateful if you could take a picture of tree 4.",
    "It would be lovely if you could take a picture of tree 4.",
    "Would it be okay to take a picture of tree 4?",
    "Would it be too much trouble to take a picture of tree 4?",
    "We would very much like a picture of tree 4.",
    "I request you to take a picture of tree 4.",
    "May I request a picture of tree 4?",
    "It is requested to take a picture of tree 4.",
    "Be so good as to take a picture of tree 4.",
    "Do me a favour and take a picture of tree 4.",
    "I want that you take a picture of tree 4.",
    "It would help if you took a picture of tree 4.",
    "Is there any way you could take a picture of tree 4?",
    "I am hoping you can take a picture of tree 4.",
    "Please could you be so kind as to take a picture of tree 4?",
    "You wouldn't mind taking a picture of tree 4, would you?",
    "Would you please be able to take a picture of tree 4 if it's not too much bother?",
    "Would you have the kindness to take a picture of tree 4?",
    "If it isn't too much to ask, take a picture of tree 4.",
    "I'd be ever so grateful for a picture of tree 4.",
    "Could I ask you for a picture of tree 4?",
    "Would it be possible to get a picture of tree 4?",
    "Is it possible for you to take a picture of tree 4?",
    "We kindly request a picture of tree 4.",
    "I should be glad if you would take a picture of tree 4.",
    "You might take a picture of tree 4.",
    "Perhaps you could take a picture of tree 4.",
]  # fmt: skip
#: Other requests that say what asks for nothing, or name what the next sentence refers to.
TOLD_OF = [
    ("How warm is it out there? Get the air temperature at tree 4.", "air @ TreeIs(4)"),
    ("For my thesis I need CO2 at tree 4.", "co2 @ TreeIs(4)"),
    ("Plan: tree 4. Photograph it.", "go TreeIs(4); picture"),
    ("Take a picture of tree 4, bless it, and of tree 9.", "picture @ TreeIs(4); picture @ TreeIs(9)"),
    ("Take a picture of tree 4, if I may, and of tree 9.", "picture @ TreeIs(4); picture @ TreeIs(9)"),
    ("Take a picture of tree 4 (he planted it himself), then of tree 9.", "picture @ TreeIs(4); picture @ TreeIs(9)"),
    ("Take a picture of tree 4 - I know, I know - and of tree 9.", "picture @ TreeIs(4); picture @ TreeIs(9)"),
    ("Take a picture of tree 4 and, God willing, of tree 9.", "picture @ TreeIs(4); picture @ TreeIs(9)"),
    ("A thermal photo of each of the eight trees nearest the pond would help us see whether they get enough water.", "for Nearest(InZone(pond), 8): [picture]"),
    ("I'd like CO2 measured at tree 4.", "co2 @ TreeIs(4)"),
    ("Can you effectuate a CO2 measurement at tree 4?", "co2 @ TreeIs(4)"),
    ("My grandfather put in most of this orchard, you know, and he always swore by the Nonpareils. Anyway, take a picture of each of them.", "for Where(variety, eq, Nonpareil): [picture]"),
    ("We think the two-year-olds are suffering from the heat. Photograph each of them, and wherever the canopy comes out hotter than 38 degrees, take the air temperature too.", "for Where(age_years, eq, 2): [picture = r1; if r1 > 38 degC: [air]]"),
    ("My wife worries about the Carmels. Take a picture of them.", "for Where(variety, eq, Carmel): [picture]"),
    ("There's a tree in the southwest corner that I put in the year my daughter was born. Get me its leaf temperature.", "go Corners(sw); picture"),
    ("Photograph tree 4. My wife worries about the Carmels. Measure their CO2.", "picture @ TreeIs(4); for Where(variety, eq, Carmel): [co2]"),
    ("goto tree 60 and take a picture.", "go TreeIs(60); picture"),
    ("Take a picture of tree 4 — it has always been a fussy one — and of tree 9.", "picture @ TreeIs(4); picture @ TreeIs(9)"),
]  # fmt: skip
#: Requests in which nothing may be left out: it restricts, forbids, corrects or adds to the work, or may do so.
KEPT = [
    "Never the Syrah. Take a picture of tree 4.",
    "We never go to the Carmels. Take a picture of tree 4.",
    "My boss says to skip row 4. Take a picture of row 3, every tree.",
    "The wet corner is flooded. Take a picture of every tree.",
    "They told us to stay out of the wet corner. Take a picture of every tree.",
    "I'd rather you avoided the wet corner. Take a picture of every tree.",
    "We only care for the Carmels. Take a picture of every tree.",
    "I only mean the Carmels. Take a picture of every tree.",
    "We mean the northern half. Take a picture of every tree.",
    "It's the Merlot I fret about, never the Syrah. Take a picture of tree 4.",
    "It's the Carmels that I mean. Take a picture of every tree.",
    "It's the Carmels. Take a picture of every tree.",
    "We are talking about the Carmels here. Take a picture of every tree.",
    "Only the ones near the pond matter. Take a picture of every tree.",
    "My wife wants a video of it. Take a picture of tree 4.",
    "We need radon too. Take a picture of tree 4.",
    "I want you to flambé the Carmels. Take a picture of tree 4.",
    "Flambé the Carmels. Take a picture of tree 4.",
    "Flambé. Take a picture of tree 4.",
    "My knee hurts and flambé the Carmels. Take a picture of tree 4.",
    "The Carmels must be flambéed. Take a picture of tree 4.",
    "The trees need flambéing. Take a picture of tree 4.",
    "The robot frobnicates the trees. Take a picture of tree 4.",
    "You frobnicate the trees. Take a picture of tree 4.",
    "Radon: trees 4 and 5. CO2 there too.",
    "Radon, CO2 and temperature at tree 4.",
    "CO2, radon, and a picture of tree 4.",
    "Take a picture of tree 4, then spray it.",
    "My uncle sprays the trees at noon. Take a picture of tree 4.",
    "We do it every Tuesday. Take a picture of tree 4.",
    "It must be back in 20 minutes. Take a picture of tree 4.",
    "I hope you photograph the Carmels. Take a picture of tree 4.",
    "I hope you flambé them. Take a picture of tree 4.",
    "I meant tree 9. Take a picture of tree 4.",
    "Take a picture of tree 4. I meant the Carmels.",
    "Take a picture of tree 4, I mean its neighbour.",
    "Take a picture of tree 4, no, the tree next to it.",
    "Take a picture of tree 4 if my wife agrees.",
    "We would like the Carmels first. Take a picture of every tree.",
    "The Carmels go first. Take a picture of every tree.",
    "I like the Carmels best, they come first. Take a picture of every tree.",
    "Our Carmels come before the others. Take a picture of every tree.",
    "Is row 3 dry? Take a picture of tree 4.",
    "How tall are the trees? Take a picture of tree 4.",
    "Where are the Carmels? Take a picture of tree 4.",
    "Go to tree 4. There's a mulberry beside it. Take a picture of it.",
    "There is a mulberry by the shed. Take a picture of it.",
    "We mostly care about heat. Take a picture of the trees that matter.",
    "The wet corner flooded. Take a picture of every tree.",
    "The gate is locked. Take a picture of every tree.",
    "The Carmels are gone. Take a picture of every tree.",
    "They cut down the Carmels. Take a picture of every tree.",
    "We removed the Carmels. Take a picture of every tree.",
    "My father ripped out the Carmels. Take a picture of every tree.",
    "The Carmels are sprayed. Take a picture of every tree.",
    "They closed the northern half. Take a picture of every tree.",
    "My boss forbids the northern half. Take a picture of every tree.",
    "The dog lives by the charger. Take a picture of every tree.",
    "We sold the northern half. Take a picture of every tree.",
    "I stand by the charger. Take a picture of every tree.",
    "He marked the Carmels. Take a picture of the marked trees.",
    "Take a picture of tree 4, gently humming.",
    "Take a picture of tree 4, xyzzy.",
    "Take a picture of tree 4, xyzzy, and tree 5.",
    "Take pictures of the almonds, the plums, and tree 4.",
    "Tell Maria it is done. Take a picture of tree 4.",
    "Take a picture of tree 4. Bob, the far one.",
    "Take CO2 at tree 4. They are sensitive, so twice.",
    "Take a picture of each tree in row 3, we like it slow.",
    "My boss thinks the Carmels are enough. Take a picture of every tree.",
    "I think the Carmels will do. Take a picture of every tree.",
    "I believe the Carmels suffice. Take a picture of every tree.",
    "We love the Carmels, so just these. Take a picture of every tree.",
    "I guess the northern half is enough. Take a picture of every tree.",
    "I reckon half of them is plenty. Take a picture of every tree.",
    "I'd say the Carmels. Take a picture of every tree.",
    "We can forget the Carmels. Take a picture of every tree.",
    "It is a pity about the Carmels, forget them. Take a picture of every tree.",
    "We don't love the Carmels. Take a picture of every tree.",
    "I fear the wet corner will swallow you. Take a picture of every tree.",
    "I worry about the wet corner. Take a picture of every tree.",
    "They told you to come home early. Take a picture of every tree.",
    "It is enough to do row 3. Take a picture of every tree.",
    "It's fine to be quick. Take a picture of every tree.",
    "He said twice. Take a picture of tree 4.",
    "She likes two of each. Take a picture of tree 4.",
    "My father always went clockwise. Take a picture of the corner trees.",
    "We always go north to south. Take a picture of every tree in row 3.",
    "We usually start at the pond. Take a picture of every tree in row 3.",
    "I usually measure CO2 too. Take a picture of tree 4.",
    "I remember a CO2 reading there. Take a picture of tree 4.",
    "We suspect the Carmels. Measure CO2 at tree 4 and at those.",
    "We love tree 9. Take a picture of it.",
    "We planted the Carmels. Take a picture of the trees we planted.",
    "I planted some of the Carmels. Take a picture of those.",
    "I know some Carmels are ill. Take a picture of those.",
    "My wife thinks one of the Carmels is dying. Take a picture of it.",
    "There's a gopher by tree 4. Photograph it.",
    "Photograph tree 4. There's a gopher beside it. Photograph that as well.",
    "Photograph tree 4. My brother planted it. Measure CO2 there.",
    "Photograph tree 4, my brother planted it, and measure its CO2.",
    "Photograph tree 4, he hates it, he loves the Carmels.",
    "Photograph tree 4. He loves the Carmels too.",
    "Photograph tree 4. The plums too.",
    "Photograph tree 4. The plums as well.",
    "Photograph tree 4. My ripe plums.",
    "Photograph tree 4. Those plums.",
    "Photograph tree 4. That plum tree.",
    "Photograph tree 4. It, and the plums.",
    "Photograph tree 4, this plum, and tree 5.",
    "Photograph tree 4, my plums, and tree 5.",
    "Photograph tree 4, the planted plums, and tree 5.",
    "Photograph tree 4, the gnarled plum by the pond.",
    "Photograph tree 4 (the gnarled one).",
    "Photograph tree 4, thereafter the robot may rest.",
    "Photograph tree 4. The robot may rest now.",
    "Photograph tree 4. I may want more.",
    "Photograph tree 4. That will be the northern one.",
    "Photograph tree 4. This is the second one.",
    "Photograph tree 4. This is the one beside the pond.",
    "This is about the Carmels. Photograph tree 4.",
    "This concerns the Carmels. Photograph every tree.",
    "This applies to the Carmels. Photograph every tree.",
    "These are the Carmels. Photograph every tree.",
    "That goes for the Carmels. Photograph every tree.",
    "The same applies elsewhere. Photograph tree 4.",
    "My instructions concern the Carmels. Photograph every tree.",
    "My interest is the Carmels. Photograph every tree.",
    "My interest lies elsewhere. Photograph tree 4.",
    "Our budget is tight. Photograph every tree.",
    "Our battery is weak. Photograph every tree.",
    "The battery died. Photograph tree 4.",
    "We have little time. Photograph every tree.",
    "My shift ends soon. Photograph tree 4.",
    "Hope you manage the Carmels. Photograph tree 4.",
    "Hope for the best: xyzzy tree 4. Photograph tree 5.",
    "Order: tree 9, tree 4. Photograph them.",
    "Photograph trees 4 and 9. Order: 9, 4.",
    "Survey Carmels: photograph every tree.",
    "Purpose: Carmels. Photograph every tree.",
    "Background: never the Carmels. Photograph every tree.",
    "Survey design: Carmels, randomized. Photograph every tree.",
    "How many Carmels are there? Photograph tree 4.",
    "How high is the CO2? Photograph tree 4.",
    "Are the Carmels alive? Photograph tree 4.",
    "For the Chardonnay I need CO2 at tree 4.",
    "For his plums we need a picture of tree 4.",
    "For our northern half I need CO2 at tree 4.",
    "Would it be possible to flambé tree 4?",
    "If it's no trouble, take a picture of tree 4. If it's a problem, take CO2.",
    "Measure CO2 at tree 4. If it's a problem, take a picture.",
    "Measure CO2 at tree 4. If that is too much trouble, take a picture.",
    "My neighbour thinks tree 5 is better. Take a picture of tree 4.",
    "I know the northern rows are done already. Take a picture of every tree.",
    "They already photographed the Carmels. Take a picture of every tree.",
    "We finished the Carmels yesterday. Take a picture of every tree.",
    "I remember you did the Carmels. Take a picture of every tree.",
    "We believe in the Carmels alone. Take a picture of every tree.",
    "I feel that every second tree would do. Take a picture of row 3.",
    "I love how you skip the Carmels. Take a picture of every tree.",
    "I fear for the pond side. Take a picture of every tree.",
    "We treasure the Carmels, these and no others. Take a picture of every tree.",
    "My father planted the Carmels; those are the ones. Take a picture of every tree.",
    "I am thinking of the Carmels. Take a picture of every tree.",
    "I am thinking of the Carmels. Take a picture of every tree in row 3.",
    "We have Carmels in mind. Take a picture of every tree.",
    "Take a picture of every tree. I was thinking of the Carmels.",
    "Take a picture of every tree in row 3. They sulk in pairs.",
    "Take a picture of tree 4. We call this a double.",
    "Take a picture of tree 4. He likes big ones.",
    "Take a picture of the three trees. My father planted them.",
    "Take a picture of tree 4. It's the wrong one.",
    "Take a picture of tree 4. That was a joke.",
    "Take a picture of tree 4. I am kidding.",
    "Take a picture of tree 4. I changed my mind.",
    "Take a picture of tree 4. I take that back.",
    "Take a picture of tree 4. Scrap that.",
    "Take a picture of tree 4. It was a mistake.",
    "Take a picture of tree 4. It is cancelled.",
    "Take a picture of tree 4. We abandoned the idea.",
    "Take a picture of tree 4. He told me to abandon it.",
    "Take a picture of tree 4, he vetoed it.",
    "Take a picture of tree 4, it's optional.",
    "Take a picture of tree 4. It's optional.",
    "Take a picture of tree 4. It may be omitted.",
    "Take a picture of tree 4. This is conditional on rain.",
    "Take a picture of tree 4, that depends on the weather.",
    "Take a picture of tree 4. It depends.",
    "Take CO2 at tree 4. It often lags, so repeat.",
    "Take CO2 at tree 4. It lags; average it.",
    "Take CO2 at tree 4. They report in kelvin.",
    "Take pictures of row 3. She sorts them by age.",
    "Take pictures of row 3. It alternates.",
    "Take pictures of row 3. We sample systematically.",
    "Take pictures of row 3. These alternate with row 5.",
    "Take pictures of row 3. We go backwards.",
    "I hope it stays under budget. Take a picture of every tree.",
    "I hope you remain near the pond. Take a picture of tree 4.",
    "I hope you are home early. Take a picture of tree 4.",
    "I hope you get a CO2 value. Take a picture of tree 4.",
    "I trust you to wait. Take a picture of tree 4.",
    "I trust you brake for dogs. Take a picture of tree 4.",
]  # fmt: skip


def left(request: str) -> str:
    """The words of a request without its remarks."""
    words = ENGLISH.words_of(request)
    phrases = ENGLISH.phrases(ROBOT, open_site("demo"))
    return " ".join(word.text for word in without_remarks(words, edges_of(words, phrases)).words)


@pytest.mark.parametrize("remark", REMARKS)
def test_a_remark_before_the_command_changes_nothing_but_is_said(remark: str) -> None:
    plain = composed(COMMAND, open_site("demo"), ROBOT)
    remarked = composed(f"{remark} {COMMAND}", open_site("demo"), ROBOT)
    assert isinstance(plain, Planned)
    assert isinstance(remarked, Planned)
    assert outline(remarked.task) == outline(plain.task)
    assert any("taken as a remark" in one for one in remarked.task.command.assumptions)


@pytest.mark.parametrize("reason", REASONS)
def test_a_reason_behind_the_command_changes_nothing_but_is_said(reason: str) -> None:
    remarked = composed(COMMAND + reason, open_site("demo"), ROBOT)
    assert isinstance(remarked, Planned)
    assert outline(remarked.task) == "picture @ TreeIs(4)"
    assert any("taken as a remark" in one for one in remarked.task.command.assumptions)


@pytest.mark.parametrize(
    "request_",
    [
        "We need a picture of tree 9.",
        "The robot zigzags home.",
        "I want you to flambé row 3.",
        "They said to skip row 4.",
        "take a picture of tree 4 because row 3 is wilting",
    ],
)
def test_what_names_places_or_actions_is_no_remark(request_: str) -> None:
    assert "tree" not in request_ or "tree" in left(request_)
    assert "row" not in request_ or "row" in left(request_)
    assert "robot" not in request_ or "robot" in left(request_)


@given(
    st.lists(st.sampled_from([*REMARKS, COMMAND + ".", "We are wondering,", "for the lab", ",", "row 3"]), max_size=6)
)
def test_only_words_of_the_request_are_left_and_in_their_order(parts: list[str]) -> None:
    request = " ".join(parts)
    words = [word.text for word in ENGLISH.words_of(request)]
    rest = left(request).split()
    position = 0
    for word in rest:
        position = words.index(word, position) + 1
    assert bool(rest) == bool(words)


@pytest.mark.parametrize("request_", [*TOLD, *FRAMED])
def test_what_asks_for_nothing_is_left_out(request_: str) -> None:
    outcome = PLANNER.plan(request_, open_site("demo"), ROBOT)
    assert isinstance(outcome, Planned), outcome
    assert outline(outcome.task) == "picture @ TreeIs(4)"


@pytest.mark.parametrize(("request_", "plan"), TOLD_OF)
def test_a_place_that_is_told_of_is_what_the_next_sentence_refers_to(request_: str, plan: str) -> None:
    outcome = PLANNER.plan(request_, open_site("demo"), ROBOT)
    assert isinstance(outcome, Planned), outcome
    assert outline(outcome.task) == plan


@pytest.mark.parametrize("request_", TOLD)
def test_unknown_words_that_are_left_out_have_to_be_confirmed(request_: str) -> None:
    words = ENGLISH.words_of(request_)
    known = {
        k for edge in edges_of(words, ENGLISH.phrases(ROBOT, open_site("demo"))) for k in range(edge.start, edge.end)
    }
    strange = [
        word.text for k, word in enumerate(words) if k not in known and word.kind == "word" and len(word.norm) > 4
    ]
    outcome = PLANNER.plan(request_, open_site("demo"), ROBOT)
    assert isinstance(outcome, Planned)
    warned = " ".join(str(problem.what) for problem in unaccounted(outcome.task))
    assert [word for word in strange if word not in warned and not is_filler(word, "en")] == []


@pytest.mark.parametrize("request_", KEPT)
def test_what_may_ask_for_something_is_never_left_out(request_: str) -> None:
    assert not isinstance(PLANNER.plan(request_, open_site("demo"), ROBOT), Planned)
