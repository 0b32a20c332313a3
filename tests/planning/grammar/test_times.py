"""Times of missions in the words of many speakers."""

from __future__ import annotations

import pytest

from fieldhand.language import open_language
from fieldhand.planning.english.planner import EnglishPlanner
from fieldhand.planning.english.tokens import words_of
from fieldhand.planning.grammar.times import without_times
from fieldhand.planning.planner import Answer, Clarify, Planned, Refused
from fieldhand.robot.loader import load_robot
from fieldhand.site.loader import open_site
from fieldhand.wording.timing import say_timing
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


#: Parts of the day and days without a time, and the window that they are.
MORNING, DAYLIGHT = "late_min=1440 done_by=12:00", "late_min=1440 done_by=sunset"
WINDOWS = [
    ("every morning", f"at=sunrise {MORNING}"),
    ("each morning", f"at=sunrise {MORNING}"),
    ("in the mornings", f"at=sunrise {MORNING}"),
    ("every third morning", f"at=sunrise every_days=3 {MORNING}"),
    ("every weekday morning", f"at=sunrise weekdays=mon,tue,wed,thu,fri {MORNING}"),
    ("every Monday morning", f"at=sunrise weekdays=mon {MORNING}"),
    ("weekly in the morning", f"at=sunrise every_days=7 {MORNING}"),
    ("every morning until 31 December", f"at=sunrise last_day=--12-31 {MORNING}"),
    ("every morning until the end of June", f"at=sunrise last_day=--06-30 {MORNING}"),
    ("early every morning", "at=sunrise late_min=1440 done_by=sunrise+180"),
    ("every afternoon", "at=12:00 late_min=1440 done_by=18:00"),
    ("every evening", "at=18:00 late_min=1440 done_by=22:00"),
    ("every night", "at=dusk late_min=1440 done_by=dawn"),
    ("daily", f"at=sunrise {DAYLIGHT}"),
    ("every day", f"at=sunrise {DAYLIGHT}"),
    ("every other day", f"at=sunrise every_days=2 {DAYLIGHT}"),
    ("once a week", f"at=sunrise every_days=7 {DAYLIGHT}"),
    ("on weekdays", f"at=sunrise weekdays=mon,tue,wed,thu,fri {DAYLIGHT}"),
    ("but only on weekdays", f"at=sunrise weekdays=mon,tue,wed,thu,fri {DAYLIGHT}"),
    ("every Monday", f"at=sunrise weekdays=mon {DAYLIGHT}"),
    ("on Mondays and Thursdays", f"at=sunrise weekdays=mon,thu {DAYLIGHT}"),
    ("on Monday and Thursday", f"at=sunrise weekdays=mon,thu {DAYLIGHT}"),
    ("every Sunday until 31 December", f"at=sunrise weekdays=sun last_day=--12-31 {DAYLIGHT}"),
    ("daily for two weeks", f"at=sunrise last_day=+13 {DAYLIGHT}"),
    ("tomorrow", "day=tomorrow not_before=sunrise done_by=sunset"),
    ("on Friday", "day=fri not_before=sunrise done_by=sunset"),
    ("on 3 March", "day=--03-03 not_before=sunrise done_by=sunset"),
    ("tomorrow morning", "day=tomorrow not_before=sunrise done_by=12:00"),
    ("early tomorrow", "day=tomorrow not_before=sunrise done_by=sunrise+180"),
    ("first thing tomorrow", "day=tomorrow not_before=sunrise done_by=12:00"),
    ("late tomorrow morning", "day=tomorrow not_before=10:00 done_by=12:00"),
    ("tomorrow afternoon", "day=tomorrow not_before=12:00 done_by=18:00"),
    ("on Friday evening", "day=fri not_before=18:00 done_by=22:00"),
    ("this morning", "day=today not_before=sunrise done_by=12:00"),
    ("this afternoon", "day=today not_before=12:00 done_by=18:00"),
    ("this evening", "day=today not_before=18:00 done_by=22:00"),
    ("tonight", "day=today not_before=dusk done_by=dawn"),
    ("in the morning", "not_before=sunrise done_by=12:00"),
    ("late in the afternoon", "not_before=15:00 done_by=18:00"),
    ("at night", "not_before=dusk done_by=dawn"),
    ("during the day", "not_before=sunrise done_by=sunset"),
]


@pytest.mark.parametrize(("said", "meant"), WINDOWS)
def test_a_part_of_the_day_is_a_window_and_a_day_its_daylight(said: str, meant: str) -> None:
    """The plan states it as an assumption, so that another time can be said."""
    for request in (f"{said[0].upper()}{said[1:]}, measure CO2 at tree 4.", f"Measure CO2 at tree 4 {said}."):
        found = PLANNER.plan(request, DEMO, HUSKY)
        assert isinstance(found, Planned), (request, found)
        shown = outline(found.task).removeprefix("co2 @ TreeIs(4) | ")
        assert sorted(shown.split()) == sorted(meant.split()), request
        part = "assumption" if found.task.timing is None else " ".join(found.task.command.assumptions)
        assert "akes place" in part, request
        assert not found.task.command.warnings


def test_the_read_back_states_the_window_in_both_languages() -> None:
    found = PLANNER.plan("Every morning, measure CO2 at tree 4.", DEMO, HUSKY)
    assert isinstance(found, Planned)
    assert found.task.timing is not None
    assert "Takes place in the morning, from sunrise to 12:00." in found.task.command.assumptions
    assert say_timing(found.task.timing)[:3] == (
        "Runs every day, at sunrise.",
        "Each run is done by 12:00, including the way home.",
        "A run that cannot begin in time for that is left out.",
    )
    by_day = PLANNER.plan("Measure CO2 at tree 4 tomorrow.", DEMO, HUSKY)
    assert isinstance(by_day, Planned)
    (assumed,) = [line for line in by_day.task.command.assumptions if "time of the day" in line]
    assert assumed == "No time of the day is said: takes place by day, from sunrise to sunset."
    assert open_language("es").say(assumed) == (
        "No se dice ninguna hora del día: se hace de día (desde: salida del sol; hasta: puesta del sol)."
    )


@pytest.mark.parametrize(
    ("request_", "meant"),
    [
        (
            "Every evening until the end of June, one hour before sunset, measure CO2 at tree 4.",
            "at=sunset-60 last_day=--06-30",
        ),
        ("Every morning half an hour after sunrise, measure CO2 at tree 4.", "at=sunrise+30"),
        ("Each night at two, measure CO2 at tree 4.", "at=02:00"),
        ("Every night at 2 am, measure CO2 at tree 4.", "at=02:00"),
        ("Each night at eleven, measure CO2 at tree 4.", "at=23:00"),
        ("Tonight at eleven, measure CO2 at tree 4.", "day=today not_before=23:00 not_after=23:15"),
        ("Every morning before 9 am, measure CO2 at tree 4.", "at=sunrise late_min=1440 done_by=09:00"),
        ("Every day between sunrise and 9 am, measure CO2 at tree 4.", "at=sunrise late_min=1440 done_by=09:00"),
        ("Every day at 6 am and noon, be done by 6 pm, measure CO2 at tree 4.", "at=06:00,12:00 done_by=18:00"),
        ("Measure CO2 at tree 4 every two hours in the morning.", "at=sunrise every_min=120 until=12:00"),
        ("Measure CO2 at tree 4 every hour during the day.", "at=sunrise every_min=60 until=sunset"),
        ("Every Monday and Thursday at 6 am, measure CO2 at tree 4.", "at=06:00 weekdays=mon,thu"),
        ("On Monday and Friday at 6 am, measure CO2 at tree 4.", "at=06:00 weekdays=mon,fri"),
    ],
)  # fmt: skip
def test_a_time_beside_a_part_of_the_day_is_the_time(request_: str, meant: str) -> None:
    found = PLANNER.plan(request_, DEMO, HUSKY)
    assert isinstance(found, Planned), found
    assert outline(found.task) == f"co2 @ TreeIs(4) | {meant}"
    assert not any("akes place" in line for line in found.task.command.assumptions)


@pytest.mark.parametrize(
    ("said", "meant"),
    [
        ("Tomorrow at 6 am, noon and 6 pm", "at=06:00,12:00,18:00 first_day=tomorrow last_day=today"),
        ("Today at 6 am and 6 pm", "at=06:00,18:00 first_day=today last_day=today"),
        ("On Friday at 6:00, 12:30 and 18:00", "at=06:00,12:30,18:00 first_day=fri last_day=today"),
        ("On 3 March at sunrise and sunset", "at=sunrise,sunset first_day=--03-03 last_day=--03-03"),
        ("At 2, 4 and 6 pm tomorrow", "at=14:00,16:00,18:00 first_day=tomorrow last_day=today"),
        ("At 6, 12 and 18 o'clock every day", "at=06:00,12:00,18:00"),
        ("Every day at 6 and 8 am", "at=06:00,08:00"),
        ("Every day at sunrise, noon, and sunset", "at=sunrise,12:00,sunset"),
        ("Every Monday and Thursday at sunrise, noon and 6 pm", "at=sunrise,12:00,18:00 weekdays=mon,thu"),
    ],
)
def test_several_times_of_a_day_are_runs_of_their_own(said: str, meant: str) -> None:
    for request in (f"{said}, measure CO2 at tree 4.", f"Measure CO2 at tree 4 {said[0].lower()}{said[1:]}."):
        found = PLANNER.plan(request, DEMO, HUSKY)
        assert isinstance(found, Planned), (request, found)
        assert outline(found.task) == f"co2 @ TreeIs(4) | {meant}"


def test_several_times_without_a_day_are_asked_for_the_days() -> None:
    request = "At 6 am and 6 pm, measure CO2 at tree 4."
    asked = PLANNER.plan(request, DEMO, HUSKY)
    assert isinstance(asked, Clarify)
    assert (asked.question, asked.choices) == ("On which days?", ("every day", "today", "tomorrow"))
    for answer, meant in (
        ("every day", "at=06:00,18:00"),
        ("tomorrow", "at=06:00,18:00 first_day=tomorrow last_day=today"),
        ("on Fridays", "at=06:00,18:00 weekdays=fri"),
    ):
        found = PLANNER.plan(request, DEMO, HUSKY, (Answer(question=asked.question, answer=answer),))
        assert isinstance(found, Planned), found
        assert outline(found.task) == f"co2 @ TreeIs(4) | {meant}"


@pytest.mark.parametrize(
    ("request_", "choices"),
    [
        (
            "Every morning one hour before sunset, measure CO2 at tree 4.",
            ("at 60 min before sunset", "in the morning, from sunrise to 12:00"),
        ),
        (
            "Tomorrow morning at 17:30, measure CO2 at tree 4.",
            ("at 17:30", "in the morning, from sunrise to 12:00"),
        ),
    ],
)
def test_a_time_in_another_part_of_the_day_is_asked(request_: str, choices: tuple[str, ...]) -> None:
    asked = PLANNER.plan(request_, DEMO, HUSKY)
    assert isinstance(asked, Clarify)
    assert asked.choices == choices
    plans = set()
    for answer in (*choices, "at 7 am"):
        found = PLANNER.plan(request_, DEMO, HUSKY, (Answer(question=asked.question, answer=answer),))
        assert isinstance(found, Planned), found
        plans.add(outline(found.task))
    assert len(plans) == 3


@pytest.mark.parametrize("said", ["until Friday", "for two weeks", "starting Monday", "from 1 March to 31 May"])
def test_days_that_leave_open_how_often_are_asked(said: str) -> None:
    request = f"Measure CO2 at tree 4 {said}."
    choices = ("at 06:00", "at 08:00", "at 12:00", "at sunrise")
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
    ("request_", "meant"),
    [
        ("Measure CO2 at tree 4 in the morning.", "co2 @ TreeIs(4) | not_before=sunrise done_by=12:00"),
        (
            "Measure CO2 at trees 3, 4 in the afternoon.",
            "for UnionOf(TreeIs(3)+TreeIs(4)): [co2] | not_before=12:00 done_by=18:00",
        ),
        (
            "Photograph the trees of rows 3 and 4 in the morning.",
            "for UnionOf(Rows(3, 3)+Rows(4, 4)): [picture] | not_before=sunrise done_by=12:00",
        ),
        (
            "Tomorrow at 5 yellow trees measure CO2.",
            "for Take(5, of Where(leaf_color, eq, yellow)): [co2] | day=tomorrow not_before=sunrise done_by=sunset",
        ),
    ],
)
def test_the_number_of_a_place_is_no_hour(request_: str, meant: str) -> None:
    found = PLANNER.plan(request_, DEMO, HUSKY)
    assert isinstance(found, Planned), found
    assert outline(found.task) == meant


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
        "Measure CO2 at tree 4 tomorrow at 6 or 7.",
        "Measure CO2 at tree 4 sometime.",
        "Measure CO2 at tree 4 tomorrow and on Friday.",
        "At 10, 12 and 2 pm tomorrow, measure CO2 at tree 4.",
        "At 6, 9 and 11 o'clock tomorrow, measure CO2 at tree 4.",
        "Tonight at two, measure CO2 at tree 4.",
        "Every night measure CO2 at tree 4 every hour.",
        "Every day photograph tree 4 and every Monday measure CO2 at tree 9.",
        "Every morning photograph tree 4 and every Monday at noon measure CO2 at tree 9.",
        "Every morning photograph tree 4 and at 6 pm measure CO2 at tree 9.",
        "This morning photograph tree 4 and tomorrow tree 9.",
        "Photograph tree 4 in the morning and tree 9 in the evening.",
        "Tomorrow photograph tree 4, and this evening tree 9.",
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
        "Measure CO2 at tree 4 tomorrow at 5 other trees.",
        "This evening measure CO2 at tree 4, then at 7 this evening at tree 9.",
        "Tomorrow morning at 17:30 measure CO2 at tree 4.",
        "Twice a day, at six in the morning, measure CO2 at tree 4.",
    ],
)
def test_a_number_that_is_no_hour_is_not_read_as_one(request_: str) -> None:
    assert not isinstance(PLANNER.plan(request_, DEMO, HUSKY), Planned)
