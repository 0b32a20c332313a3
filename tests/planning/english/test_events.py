"""Conditions that hold all the time: what is watched, what the robot does, and what it cannot tell."""

from __future__ import annotations

from dataclasses import replace

import pytest

from fieldhand.planning.english.planner import EnglishPlanner
from fieldhand.planning.planner import Answer, Clarify, Outcome, Planned, Refused
from fieldhand.robot.loader import load_robot
from fieldhand.robot.model import RobotProfile
from fieldhand.site.loader import load_demo
from planning.english.outlines import outline
from planning.english.outlines import watch as outline_of
from support.missions.watched import EVENTS, watchful

WORK = "Photograph every tree in row 3."
PLAN = "for Rows(3, 3): [picture]"


def planned(request: str, robot: RobotProfile | None = None) -> Outcome:
    return EnglishPlanner().plan(request, load_demo(), robot or watchful())


HOME, STOPS = "return_to_start", "end"

WATCHED = [
    ("Stop if someone is in the row.", f"person_near: wait, then {STOPS}"),
    ("Stop if somebody is near.", f"person_near: wait, then {STOPS}"),
    ("If someone is in the row, stop.", f"person_near: wait, then {STOPS}"),
    ("If a person comes too close, halt.", f"person_near: wait, then {STOPS}"),
    ("Halt immediately whenever there are people around.", f"person_near: wait, then {STOPS}"),
    ("Stop if you see anyone.", f"person_near: wait, then {STOPS}"),
    ("As soon as a worker walks by, stop.", f"person_near: wait, then {STOPS}"),
    ("Stop for people.", f"person_near: wait, then {STOPS}"),
    ("If somebody is standing in the row, pause until they leave.", f"person_near: wait, then {HOME}"),
    ("Whenever someone is in the way, stop until they are gone, then go on.", f"person_near: wait, then {STOPS}"),
    ("Hold on while someone is close.", f"person_near: wait, then {HOME}"),
    ("If someone is near, wait at most 10 minutes.", f"person_near: wait 10 min, then {HOME}"),
    ("If someone is near, stop. Wait at most 5 minutes, then end the mission.", "person_near: wait 5 min, then end"),
    ("When somebody walks by, stop, at most 3 minutes, then skip.", "person_near: wait 3 min, then skip"),
    ("Skip a row if somebody is in it.", "person_near: skip_row"),
    ("If there's a worker in the row, leave the row out.", "person_near: skip_row"),
    ("If there are people near, skip that tree and go on with the next.", "person_near: skip"),
    ("Skip it if someone is there.", "person_near: skip"),
    ("Come home if it rains.", f"rain: {HOME}"),
    ("If it rains, come home.", f"rain: {HOME}"),
    ("Come back if it starts raining.", f"rain: {HOME}"),
    ("Come back as soon as it starts to rain.", f"rain: {HOME}"),
    ("If rain starts falling, go back to the end.", "rain: return_to_end"),
    ("Should it rain, come home.", f"rain: {HOME}"),
    ("In case of rain, come home.", f"rain: {HOME}"),
    ("In the event of rain return to the start.", f"rain: {HOME}"),
    ("At any time, if it rains, come home.", f"rain: {HOME}"),
    ("If at any time it rains, stop and come home.", f"rain: {HOME}"),
    ("While it rains, wait.", f"rain: wait, then {HOME}"),
    ("Wait as long as it is raining.", f"rain: wait, then {HOME}"),
    ("During rain, stand still.", f"rain: wait, then {HOME}"),
    ("If it rains, wait until the rain stops, at most 20 minutes; then come home.", f"rain: wait 20 min, then {HOME}"),
    ("If it rains, wait for 10 minutes and then go on anyway.", "rain: wait 10 min, then go_on"),
    ("Pause while the wind is over 5 m/s.", f"wind > 5 m/s: wait, then {HOME}"),
    ("At any time, if the wind is above 18 km/h, end the mission.", "wind > 5 m/s: end"),
    ("If ever the wind exceeds 10 m/s, abort.", "wind > 10 m/s: end"),
    ("If the wind speed reaches 8 meters per second, come home.", f"wind >= 8 m/s: {HOME}"),
    ("If it gets windy, stop.", f"wind: wait, then {STOPS}"),
    ("If the wind is strong, wait at most half an hour and then end the mission.", "wind: wait 30 min, then end"),
    ("If the wind is over 6 m/s, wait up to 15 minutes, then go on.", "wind > 6 m/s: wait 15 min, then go_on"),
    ("If the gate is closed, wait for 5 minutes and then come home.", f"gate_closed: wait 5 min, then {HOME}"),
    ("If the gate is shut, come back.", f"gate_closed: {HOME}"),
    ("Stop the mission if the gate is shut.", "gate_closed: end"),
    ("Drive at 0.3 m/s while someone is near.", "person_near: slow 0.3"),
    ("If someone is near, drive at 0.3 m/s.", "person_near: slow 0.3"),
    ("Slow down to 0.3 m/s near people.", "person_near: slow 0.3"),
    ("While anyone is near, drive no faster than 0.3 m/s.", "person_near: slow 0.3"),
    ("Do not drive faster than 0.3 m/s while a worker is close.", "person_near: slow 0.3"),
    ("Never exceed 0.3 m/s when someone is near.", "person_near: slow 0.3"),
    ("Whenever it rains, drive at most 1 km/h.", "rain: slow 0.277778"),
    ("Slow down to 0.2 m/s if the wind is above 6 m/s.", "wind > 6 m/s: slow 0.2"),
    ("If the gate is not closed, come home.", f"not gate_closed: {HOME}"),
    ("If it does not rain, end the mission.", "not rain: end"),
    ("If nobody is near, wait.", f"not person_near: wait, then {HOME}"),
    ("Only work while the gate is open.", f"gate_closed: wait, then {HOME}"),
]  # fmt: skip


@pytest.mark.parametrize(("sentence", "expected"), WATCHED)
def test_a_sentence_about_an_event_is_watched_throughout(sentence, expected):
    for request in (f"{WORK} {sentence}", f"{sentence} {WORK}"):
        outcome = planned(request)
        assert isinstance(outcome, Planned), (request, outcome)
        assert outline(outcome.task).split(" | at any time ")[0] == PLAN
        assert [outline_of(watch) for watch in outcome.task.composition.watches] == [expected]


PROVISOS = [
    ("only while the gate is open", f"gate_closed: wait, then {HOME}"),
    ("as long as it doesn't rain", f"rain: wait, then {HOME}"),
    ("only as long as it is dry", f"rain: wait, then {HOME}"),
    ("only while nobody is in the row", f"person_near: wait, then {HOME}"),
    ("only while the wind is below 5 m/s", f"wind >= 5 m/s: wait, then {HOME}"),
    ("only while it rains", f"not rain: wait, then {HOME}"),
]  # fmt: skip
ASKED = [
    ("unless it rains", "rain"),
    ("except when it rains", "rain"),
    (", but not while someone is near", "person_near"),
    (", but only if nobody is in the row", "person_near"),
    ("only if it isn't raining", "rain"),
    ("only when the gate is open", "gate_closed"),
    (", but not when it is windy", "wind"),
    ("unless the wind is over 8 m/s", "wind > 8 m/s"),
    ("only if the wind is under 5 m/s", "wind >= 5 m/s"),
]


@pytest.mark.parametrize(("words", "expected"), PROVISOS)
def test_a_proviso_is_watched_as_its_opposite(words, expected):
    outcome = planned(f"{WORK.removesuffix('.')} {words}.")
    assert isinstance(outcome, Planned), outcome
    assert outline(outcome.task).split(" | at any time ")[0] == PLAN
    assert [outline_of(watch) for watch in outcome.task.composition.watches] == [expected]


@pytest.mark.parametrize(("words", "event"), ASKED)
def test_a_proviso_that_leaves_open_where_the_robot_is_meanwhile_is_asked(words, event):
    request = f"{WORK.removesuffix('.')} {words}.".replace(" ,", ",")
    outcome = planned(request)
    assert isinstance(outcome, Clarify), outcome
    assert len(outcome.choices) == 2
    for k, response in enumerate((f"wait, then {HOME}", HOME)):
        answered = EnglishPlanner().plan(
            request, load_demo(), watchful(), answers=(Answer(question=outcome.question, answer=outcome.choices[k]),)
        )
        assert isinstance(answered, Planned)
        assert [outline_of(watch) for watch in answered.task.composition.watches] == [f"{event}: {response}"]


@pytest.mark.parametrize(
    ("request_", "plan"),
    [
        (
            "Spray rows 3 to 8. While spraying, stop if the wind is above 5 m/s.",
            "spray rows Rows(3, 8) | at any time while spray: wind > 5 m/s: wait, then end",
        ),
        (
            "Spray rows 3 to 8. Stop if the wind is above 5 m/s while spraying.",
            "spray rows Rows(3, 8) | at any time while spray: wind > 5 m/s: wait, then end",
        ),
        (
            "Spray rows 3 to 5. Then photograph row 9. While spraying, come home if it rains.",
            "spray rows Rows(3, 5); for Rows(9, 9): [picture] | at any time while spray: rain: return_to_start",
        ),
        (
            "While spraying, drive at 0.3 m/s if someone is near. Spray row 4.",
            "spray rows Rows(4, 4) | at any time while spray: person_near: slow 0.3",
        ),
        (
            "While taking pictures, wait if it rains. Photograph every tree in row 3.",
            "for Rows(3, 3): [picture] | at any time while picture: rain: wait, then return_to_start",
        ),
    ],
)
def test_an_event_may_be_watched_in_a_part_only(request_, plan):
    outcome = planned(request_, replace(load_robot("tractor"), events=EVENTS))
    assert isinstance(outcome, Planned), outcome
    assert outline(outcome.task) == plan


def test_how_slowly_is_asked_where_the_profile_does_not_say_it():
    asked = planned(f"{WORK} Slow down near people.")
    assert isinstance(asked, Clarify)
    assert "how fast?" in asked.question
    outcome = planned(f"{WORK} Slow down near people.", replace(watchful(), slow_m_s=0.4))
    assert isinstance(outcome, Planned)
    assert [outline_of(watch) for watch in outcome.task.composition.watches] == ["person_near: slow 0.4"]


def test_it_may_be_part_of_the_same_sentence():
    for request, expected in (
        ("Measure CO2 at trees 4 and 5; stop if someone is in the row.", f"person_near: wait, then {STOPS}"),
        ("Photograph every tree in row 3 and come back as soon as it starts to rain.", f"rain: {HOME}"),
        ("Photograph every tree in row 3, but stop the mission if the gate is shut.", "gate_closed: end"),
        ("Photograph every tree in row 3 and pause while the wind is over 5 m/s.", f"wind > 5 m/s: wait, then {HOME}"),
    ):
        outcome = planned(request)
        assert isinstance(outcome, Planned), (request, outcome)
        assert [outline_of(watch) for watch in outcome.task.composition.watches] == [expected]


def test_several_events_are_watched():
    outcome = planned(f"{WORK} If it rains or the wind is over 8 m/s, come home. If someone is near, stop.")
    assert isinstance(outcome, Planned)
    assert [outline_of(watch) for watch in outcome.task.composition.watches] == [
        f"rain: {HOME}",
        f"wind > 8 m/s: {HOME}",
        f"person_near: wait, then {STOPS}",
    ]


@pytest.mark.parametrize(
    "sentence",
    [
        "If the air gets hotter than 40 degrees at any time, come home.",
        "At any time, if the air temperature is above 40 degrees, come home.",
        "If the air temperature is ever above 40 degrees, come home.",
    ],
)
def test_a_reading_is_watched_if_that_is_said(sentence):
    for robot in (watchful(), load_robot("husky")):
        outcome = planned(f"Measure the air temperature at every tree in row 3. {sentence}", robot)
        assert isinstance(outcome, Planned), outcome
        assert outline(outcome.task).startswith("for Rows(3, 3): [air] | at any time")
        assert [outline_of(watch) for watch in outcome.task.composition.watches] == [
            f"ambient_temperature > 40 degC: {HOME}"
        ]


def test_a_condition_on_one_reading_is_tested_once():
    for request, expected in (
        ("Photograph every tree in row 3. Stop if it is hotter than 36 degrees.", "until r1 > 36 degC"),
        ("Read CO2 at tree 4. If it is above 500 ppm, take a picture.", "if r1 > 500 ppm"),
    ):
        outcome = planned(request)
        assert isinstance(outcome, Planned)
        assert expected in outline(outcome.task)
        assert outcome.task.composition.watches == ()


def test_single_captures_become_visits_that_can_be_left_out():
    outcome = planned("Photograph tree 4. Then photograph tree 9. Skip it if someone is there.")
    assert isinstance(outcome, Planned)
    assert outline(outcome.task).startswith("for TreeIs(4): [picture]; for TreeIs(9): [picture] | at any time")


@pytest.mark.parametrize("sentence", ["Don't work when it rains.", "At any time, if it rains, stop working."])
def test_what_the_robot_does_meanwhile_is_asked_where_it_is_open(sentence):
    outcome = planned(f"{WORK} {sentence}")
    assert isinstance(outcome, Clarify)
    assert [str(choice).split(", ")[1] for choice in outcome.choices] == [
        "stand still until it is over",
        "give up the rest and return to the start.",
    ]


REFUSED = [
    ("If it rains, come home. If it rains, wait.", "said twice"),
    ("Come home if it snows.", "condition on the weather"),
    ("Photograph tree 4 when it rains.", "decides about no single step"),
    ("If someone is near, honk.", "honk"),
    ("If the wind is over 20 degrees, stop.", ""),
    ("If an obstacle is in the way, stop.", "no such event"),
]


@pytest.mark.parametrize(("sentence", "why"), REFUSED)
def test_other_reactions_and_events_are_refused(sentence, why):
    outcome = planned(f"{WORK} {sentence}")
    assert isinstance(outcome, Refused), outcome
    assert why in " ".join(str(reason.what) for reason in outcome.reasons)


@pytest.mark.parametrize("sentence", [sentence for sentence, _ in WATCHED])
def test_a_robot_without_the_event_says_so(sentence):
    outcome = planned(f"{WORK} {sentence}", load_robot("husky"))
    assert isinstance(outcome, Refused), outcome


def test_the_refusal_names_what_the_robot_detects():
    husky = planned(f"{WORK} Stop if someone is in the row.", load_robot("husky"))
    assert isinstance(husky, Refused)
    (reason,) = husky.reasons
    assert "husky cannot tell: its profile has no such event" in reason.what
    assert "what it detects all the time: nothing" in reason.advice
    snow = planned(f"{WORK} Come home if it snows.")
    assert isinstance(snow, Refused)
    assert "someone is near, it rains, the wind is strong and the gate is closed" in snow.reasons[0].advice


@pytest.mark.parametrize("word", ["purple", "yesterday", "slowly", "twice", "quickly"])
def test_no_word_of_such_a_sentence_is_dropped(word):
    """A foreign word at any position leads to a refusal, a question or a warning."""
    words = ["Stop", "if", "someone", "is", "in", "the", "row"]
    for at in range(1, len(words) + 1):
        sentence = " ".join([*words[:at], word, *words[at:]])
        outcome = planned(f"{WORK} {sentence}.")
        assert not isinstance(outcome, Planned) or outcome.task.command.warnings or outcome.task.command.no_part, (
            sentence
        )
