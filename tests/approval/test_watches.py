"""A person signs what a mission watches, in the words of their language; what cannot be noticed is refused."""

from __future__ import annotations

import pytest

from fieldhand.approval.checks import examine
from fieldhand.approval.readback import read_back
from fieldhand.exchange.btcpp.reading import read_tree
from fieldhand.exchange.btcpp.writing import write_tree
from fieldhand.language import open_language
from fieldhand.places.selectors import TreeIs, Trees
from fieldhand.robot.capabilities import capabilities_of
from fieldhand.task.plan import Act, ForEach
from fieldhand.task.watches import EventHolds, ReadingBeyond, Watch
from support.missions.rig import husky, orchard
from support.missions.watched import watch, watchful, watching, windy

PLAN = ForEach(select=Trees(), body=Act(action="read_co2"))
WATCHES = (
    watch("person_near", "wait", fallback="end"),
    watch("rain", "return_to_end"),
    windy(5.0, "skip"),
    watch("gate_closed", "skip_row"),
    watch("wind", "end"),
)


def errors(*watches: Watch, plan: Act | ForEach = PLAN) -> list[str]:
    return [p.what for p in examine(watching(plan, *watches), orchard(), watchful()).errors]


def test_the_read_back_states_every_watch():
    task = watching(PLAN, *WATCHES)
    found = examine(task, orchard(), watchful())
    assert not found.errors
    back = read_back(task, orchard(), watchful(), found.estimate)
    assert [str(line.text) for line in back.lines[:5]] == [
        "At any time: if someone is near, stand still until it is over, at most 60 min; then end the mission there.",
        "At any time: if it rains, give up the rest and return to the end.",
        "At any time: if wind is above 5 m/s, leave out the current visit and go on with the next.",
        "At any time: if the gate is closed, leave out the rest of that row and go on.",
        "At any time: if the wind is strong, end the mission where the robot is.",
    ]
    assert "The figures are without events: each wait adds up to 60 min and what idling uses." in back.notes
    spanish = open_language("es").read(back)
    assert spanish.lines[0].text == (
        "En todo momento: si hay alguien cerca, quedarse quieto hasta que pase, como máximo 60 min; después terminar la"
        " misión allí."
    )


def test_the_figures_are_those_without_events():
    free, watched = (examine(watching(PLAN, *watches), orchard(), watchful()).estimate for watches in ((), WATCHES))
    assert free.worst.seconds == watched.worst.seconds


@pytest.mark.parametrize("response", ["skip", "skip_row"])
def test_a_visit_can_be_left_out_only_where_there_are_visits(response):
    assert errors(watch("rain", response)) == []
    one = Act(action="read_co2", at=TreeIs(tree="r0c0"))
    assert errors(watch("rain", response), plan=one) == [
        "“it rains” is to leave out a visit, and the plan has no list of visits"
    ]
    assert errors(watch("rain", "wait", fallback="skip"), plan=one)
    assert errors(watch("rain", "wait"), plan=one) == []


def test_a_reading_can_be_watched_only_if_it_is_taken_and_not_waited_for():
    def over(quantity: str, response: str) -> Watch:
        unit = "ppm" if quantity == "co2" else "degC"
        return Watch(condition=ReadingBeyond(quantity=quantity, test="gt", value=40.0, unit=unit), response=response)

    assert errors(over("co2", "return_to_end")) == []
    assert errors(over("co2", "wait")) == [
        "“a reading of CO₂ is above 40 ppm” is to be waited out, but nothing is read while the robot waits"
    ]
    assert errors(over("ambient_temperature", "return_to_end")) == [
        "“a reading of ambient temperature is above 40 °C” is to be noticed, but the mission never reads the ambient"
        " temperature"
    ]


def test_a_robot_without_the_event_refuses_the_task():
    task = watching(PLAN, Watch(condition=EventHolds(event="rain"), response="return_to_end"))
    (problem,) = examine(task, orchard(), husky()).errors
    assert "rain" in problem.what or "watch" in problem.what


def test_an_exported_tree_gives_the_watches_back():
    task = watching(PLAN, *WATCHES)
    capabilities = capabilities_of(watchful())
    assert read_tree(write_tree(task, capabilities), capabilities) == task
