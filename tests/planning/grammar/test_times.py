"""Times of missions in the words of many speakers."""

from __future__ import annotations

import pytest

from fieldhand.planning.english.planner import EnglishPlanner
from fieldhand.planning.english.tokens import words_of
from fieldhand.planning.grammar.times import without_times
from fieldhand.planning.planner import Answer, Clarify, Planned, Refused
from fieldhand.robot.loader import load_robot
from fieldhand.site.loader import open_site
from planning.english.outlines import outline, timing

PLANNER = EnglishPlanner()
DEMO, HUSKY = open_site("demo"), load_robot("husky")

#: Times, and what they say where they stand in a request.
TIMES = [
    ("at 6 am", "not_before=06:00 not_after=06:15"),
    ("at 6 a.m.", "not_before=06:00 not_after=06:15"),
    ("at 12 am", "not_before=00:00 not_after=00:15"),
    ("at 12 pm", "not_before=12:00 not_after=12:15"),
    ("at 18:30", "not_before=18:30 not_after=18:45"),
    ("at 23:50", "not_before=23:50 not_after=00:05"),
    ("at 0600 hours", "not_before=06:00 not_after=06:15"),
    ("at noon", "not_before=12:00 not_after=12:15"),
    ("around 7:15 pm", "not_before=19:15 not_after=19:45"),
    ("at half past six in the morning", "not_before=06:30 not_after=06:45"),
    ("at a quarter to seven in the evening", "not_before=18:45 not_after=19:00"),
    ("at sunrise", "not_before=sunrise not_after=sunrise+15"),
    ("an hour before sunset", "not_before=sunset-60 not_after=sunset-45"),
    ("half an hour after dawn", "not_before=dawn+30 not_after=dawn+45"),
    ("before sunrise", "done_by=sunrise"),
    ("by 10 am", "done_by=10:00"),
    ("no later than 10 am", "done_by=10:00"),
    ("after 8 pm", "not_before=20:00"),
    ("not before 8 pm", "not_before=20:00"),
    ("between 6 am and 8 am", "not_before=06:00 done_by=08:00"),
    ("between 6 and 8 am", "not_before=06:00 done_by=08:00"),
    ("between 1 and 3 pm", "not_before=13:00 done_by=15:00"),
    ("from 10 pm to 2 am", "not_before=22:00 done_by=02:00"),
    ("tomorrow at 7 am", "day=tomorrow not_before=07:00 not_after=07:15"),
    ("at 7 am tomorrow", "day=tomorrow not_before=07:00 not_after=07:15"),
    ("next Friday at noon", "day=fri not_before=12:00 not_after=12:15"),
    ("on Friday at noon", "day=fri not_before=12:00 not_after=12:15"),
    ("on 3 March at 6:30", "day=--03-03 not_before=06:30 not_after=06:45"),
    ("on March 3rd, 2027 at 6:30 am", "day=2027-03-03 not_before=06:30 not_after=06:45"),
    ("on 2027-03-03 at sunset", "day=2027-03-03 not_before=sunset not_after=sunset+15"),
    ("in 3 days at 6 am", "day=+3 not_before=06:00 not_after=06:15"),
    ("today", "day=today"),
    ("every day at 6 am", "at=06:00"),
    ("daily at 6 am", "at=06:00"),
    ("each day at sunrise", "at=sunrise"),
    ("every morning at half past six in the morning", "at=06:30"),
    ("at 6 am and at 6 pm every day", "at=06:00,18:00"),
    ("every day at 6 am and 6 pm", "at=06:00,18:00"),
    ("every Monday at 7:30", "at=07:30 weekdays=mon"),
    ("on Mondays and Thursdays at 7:30", "at=07:30 weekdays=mon,thu"),
    ("every Monday, Wednesday and Friday at noon", "at=12:00 weekdays=mon,wed,fri"),
    ("Monday to Friday at 8 am", "at=08:00 weekdays=mon,tue,wed,thu,fri"),
    ("on weekdays at 8 am", "at=08:00 weekdays=mon,tue,wed,thu,fri"),
    ("only on weekends at 9 am", "at=09:00 weekdays=sat,sun"),
    ("every other day at noon", "at=12:00 every_days=2"),
    ("every third day at noon", "at=12:00 every_days=3"),
    ("weekly at 6 am", "at=06:00 every_days=7"),
    ("every 2 weeks at 6 am", "at=06:00 every_days=14"),
    ("every two hours", "every_min=120"),
    ("every 30 minutes", "every_min=30 late_min=30"),
    ("hourly", "every_min=60"),
    ("every hour from 8 am until 6 pm", "at=08:00 every_min=60 until=18:00"),
    ("every 2 hours between 8 am and 6 pm", "at=08:00 every_min=120 until=18:00"),
    ("every day between 6 and 8 am", "at=06:00 done_by_min=120"),
    ("every day at 6 am until 31 December", "at=06:00 last_day=--12-31"),
    ("every day at 6 am until Friday", "at=06:00 last_day=fri"),
    ("every day at 6 am from 1 March to 31 May", "at=06:00 first_day=--03-01 last_day=--05-31"),
    ("every day at 6 am starting tomorrow", "at=06:00 first_day=tomorrow"),
    ("every day at 6 am for the next two weeks", "at=06:00 last_day=+13"),
    ("every day at 6 am for 10 days", "at=06:00 last_day=+9"),
]


@pytest.mark.parametrize(("said", "meant"), TIMES)
def test_a_time_means_the_same_wherever_it_stands(said: str, meant: str) -> None:
    """At the beginning, at the end, and in a sentence of its own."""
    for request in (
        f"{said[0].upper()}{said[1:]}, measure CO2 at tree 4.",
        f"Measure CO2 at tree 4 {said}.",
        f"Measure CO2 at tree 4, {said}.",
        f"Measure CO2 at tree 4. Do this {said}.",
    ):
        found = PLANNER.plan(request, DEMO, HUSKY)
        assert isinstance(found, Planned), (request, found)
        assert outline(found.task) == f"co2 @ TreeIs(4) | {meant}", request
        assert not found.task.command.warnings


@pytest.mark.parametrize(
    ("said", "choices"),
    [
        ("every morning", ("at 06:00", "at 08:00", "at sunrise")),
        ("tomorrow", ("at 06:00", "at 08:00", "at 12:00", "at sunrise")),
        ("tomorrow evening", ("at 18:00", "at 20:00", "at sunset")),
        ("tonight", ("at 20:00", "at 22:00", "at dusk")),
        ("on weekdays", ("at 06:00", "at 08:00", "at 12:00", "at sunrise")),
        ("every Sunday until 31 December", ("at 06:00", "at 08:00", "at 12:00", "at sunrise")),
    ],
)
def test_a_day_without_a_time_is_asked_for_one(said: str, choices: tuple[str, ...]) -> None:
    request = f"Measure CO2 at tree 4 {said}."
    asked = PLANNER.plan(request, DEMO, HUSKY)
    assert isinstance(asked, Clarify)
    assert (asked.question, asked.choices) == ("At what time of the day?", choices)
    for answer in (choices[-1], "at 7:20 am"):
        found = PLANNER.plan(request, DEMO, HUSKY, (Answer(question=asked.question, answer=answer),))
        assert isinstance(found, Planned)
        assert found.task.timing is not None
        shown = " ".join(timing(found.task.timing))
        assert ("07:20" if "7:20" in answer else answer.removeprefix("at ")) in shown
        assert any(answer in line for line in found.task.command.assumptions)
    assert PLANNER.plan(request, DEMO, HUSKY, (Answer(question=asked.question, answer="soon"),)) == asked


@pytest.mark.parametrize(
    "request_",
    [
        "Photograph row 3, then at 8 am measure CO2 at tree 4.",
        "Measure CO2 at tree 4 at 6 am. At 8 am photograph tree 5.",
        "Measure CO2 at tree 4 at 6 am and tree 5 at 7 am.",
        "If it is after 6 pm, photograph tree 4.",
        "The crew arrives at 7 am. Photograph tree 4.",
        "Photograph tree 4, the crew arrives at 7 am.",
        "Photograph the trees that were watered at 6 am.",
        "Photograph tree 4 at 25:00.",
        "Photograph tree 4 at 13 pm.",
        "Photograph tree 4 every 0 minutes.",
        "Photograph tree 4 on 31 February at 6 am.",
        "Photograph tree 4 next month.",
        "Photograph tree 4 three times a week.",
        "Photograph tree 4 every Monday tomorrow at 6 am.",
        "Photograph tree 4 at 6 o'clock.",
        "Photograph tree 4 every day except Sunday at 6 am.",
        "Photograph tree 4 at 6 am unless it is Sunday.",
        "At 6 am.",
    ],
)
def test_times_that_are_not_clear_are_refused_or_asked(request_: str) -> None:
    found = PLANNER.plan(request_, DEMO, HUSKY)
    assert isinstance(found, Refused | Clarify), found


@pytest.mark.parametrize(
    "request_",
    [
        "Photograph every fifth tree of row 3.",
        "Take a picture every 20 meters along row 3.",
        "Measure CO2 at 6 trees.",
        "Photograph 12 trees from row 3 to row 5.",
        "Photograph trees 10 to 12 and tree 14.",
        "Photograph the second tree of each row.",
        "Within 20 minutes, photograph as many trees as you can.",
    ],
)
def test_other_numbers_are_no_times(request_: str) -> None:
    assert without_times(words_of(request_)) is None


@pytest.mark.parametrize(
    ("request_", "meant"),
    [
        ("Tomorrow, not before ten, measure CO2 at tree 4.", "day=tomorrow not_before=10:00"),
        ("After 7 this evening, measure CO2 at tree 4.", "day=today not_before=19:00"),
        ("Measure CO2 at tree 4 this morning at 8.", "day=today not_before=08:00 not_after=08:15"),
        ("Measure CO2 at tree 4 tonight at eleven.", "day=today not_before=23:00 not_after=23:15"),
        ("Tomorrow morning, no earlier than seven, measure CO2 at tree 4.", "day=tomorrow not_before=07:00"),
        ("Measure CO2 at tree 4 before nine tomorrow.", "day=tomorrow done_by=09:00"),
        (
            "Measure CO2 at tree 4 on Friday between two and five in the afternoon.",
            "day=fri not_before=14:00 done_by=17:00",
        ),
        (
            "Start at half past six tomorrow morning and measure CO2 at tree 4.",
            "day=tomorrow not_before=06:30 not_after=06:45",
        ),
        ("Wait until eight this evening, then measure CO2 at tree 4.", "day=today not_before=20:00"),
        ("As soon as the sun is up, measure CO2 at tree 4.", "not_before=sunrise not_after=sunrise+15"),
        ("Once it gets dark, measure CO2 at tree 4.", "not_before=dusk not_after=dusk+15"),
        ("Each night at ten for a fortnight, measure CO2 at tree 4.", "at=22:00 last_day=+13"),
        ("Twice a day, at six in the morning and six in the evening, measure CO2 at tree 4.", "at=06:00,18:00"),
        ("Every third morning at sunrise, measure CO2 at tree 4.", "at=sunrise every_days=3"),
        ("Once an hour between eight and four, measure CO2 at tree 4.", "at=08:00 every_min=60 until=16:00"),
    ],
)  # fmt: skip
def test_an_hour_beside_a_day_is_a_time(request_: str, meant: str) -> None:
    found = PLANNER.plan(request_, DEMO, HUSKY)
    assert isinstance(found, Planned), found
    assert outline(found.task) == f"co2 @ TreeIs(4) | {meant}"


@pytest.mark.parametrize(
    ("request_", "choices"),
    [
        ("From eight tomorrow, measure CO2 at tree 4.", ("at 08:00", "at 20:00")),
        ("Every weekday at seven, measure CO2 at tree 4.", ("at 07:00", "at 19:00")),
        ("First thing tomorrow, measure CO2 at tree 4.", ("at 06:00", "at 08:00", "at sunrise")),
    ],
)
def test_an_hour_that_may_be_in_the_evening_is_asked(request_: str, choices: tuple[str, ...]) -> None:
    asked = PLANNER.plan(request_, DEMO, HUSKY)
    assert isinstance(asked, Clarify)
    assert asked.choices == choices
    for answer in choices:
        given = PLANNER.plan(request_, DEMO, HUSKY, (Answer(question=asked.question, answer=answer),))
        assert isinstance(given, Planned)
        assert given.task.timing is not None
        assert answer.removeprefix("at ") in " ".join(timing(given.task.timing))


def test_an_hour_that_is_taken_as_usual_is_stated() -> None:
    found = PLANNER.plan("Tomorrow, not before ten, measure CO2 at tree 4.", DEMO, HUSKY)
    assert isinstance(found, Planned)
    assert "The hour is taken as 10:00." in found.task.command.assumptions


@pytest.mark.parametrize(
    "request_",
    [
        "Tomorrow at 5 yellow trees measure CO2.",
        "Measure CO2 at tree 4 tomorrow at 5 other trees.",
        "This evening measure CO2 at tree 4, then at 7 this evening at tree 9.",
        "Tomorrow morning at 17:30 measure CO2 at tree 4.",
        "Twice a day, at six in the morning, measure CO2 at tree 4.",
    ],
)
def test_a_number_that_is_no_hour_is_not_read_as_one(request_: str) -> None:
    assert not isinstance(PLANNER.plan(request_, DEMO, HUSKY), Planned)
