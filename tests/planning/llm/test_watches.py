"""A model writes watches for a robot that detects events, and hears of them only then."""

from __future__ import annotations

from fieldhand.planning.llm.prompt import opening
from fieldhand.planning.planner import Planned
from fieldhand.robot.loader import load_robot
from fieldhand.task.watches import EventBeyond, EventHolds, Watch
from fieldhand.testing.scripted_chat import ScriptedChat, planner_of
from support.missions.watched import watchful
from support.sites.grids import grid

SITE = grid(4, 6)
REQUEST = (
    "Take a picture of every tree. Stop if someone is near, at most 10 minutes. Come home if the wind is over 8 m/s."
)
ANSWER = """<task xmlns="urn:fieldhand:task:1">
  <task-composition>
    <plan>
      <for-each words="every tree"><select><trees/></select>
        <body><act words="Take a picture"><take_thermal_picture/></act></body>
      </for-each>
    </plan>
    <watches>
      <watch response="wait" at-most-s="600" fallback="end" words="Stop if someone is near, at most 10 minutes">
        <event-holds><person_near/></event-holds>
      </watch>
      <watch response="return_to_start" words="Come home if the wind is over 8 m/s">
        <event-beyond test="gt"><wind value="8" unit="m/s"/></event-beyond>
      </watch>
    </watches>
  </task-composition>
</task>"""


def test_the_watches_of_an_answer_are_those_of_the_task() -> None:
    outcome = planner_of(ScriptedChat(ANSWER)).plan(REQUEST, SITE, watchful())
    assert isinstance(outcome, Planned), outcome
    person, wind = outcome.task.composition.watches
    assert person.condition == EventHolds(event="person_near")
    assert (person.response, person.at_most_s, person.fallback) == ("wait", 600.0, "end")
    assert REQUEST[slice(*person.said[0])] == "Stop if someone is near, at most 10 minutes"
    assert isinstance(wind, Watch)
    assert wind.condition == EventBeyond(event="wind", test="gt", value=8.0, unit="m/s")


def test_an_event_that_the_robot_lacks_goes_back_to_the_model() -> None:
    chat = ScriptedChat(ANSWER.replace("person_near", "meteor"), ANSWER)
    assert isinstance(planner_of(chat).plan(REQUEST, SITE, watchful()), Planned)


def test_a_model_hears_of_watches_where_the_robot_detects_events() -> None:
    for robot, expected in ((watchful(), True), (load_robot("husky"), False)):
        _, asked = opening(REQUEST, SITE, robot)
        assert ("<watch response=" in asked.text) is expected
        assert ("- wind in m/s: the wind is strong; holds above 8.0" in asked.text) is expected
