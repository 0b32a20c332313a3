"""Events are heard over ROS 2 by what the topics of the profile say; missions react as in the plain simulation."""

from __future__ import annotations

import json
from dataclasses import replace
from pathlib import Path
from typing import ClassVar

import pytest
import yaml

from fieldhand.errors import ProfileError
from fieldhand.execution.drivers.ros2.event_topics import event_value
from fieldhand.execution.drivers.simulation.world import ScriptedEvent, World
from fieldhand.execution.guard import NoGuard
from fieldhand.execution.mission_runner import run
from fieldhand.places.selectors import Rows
from fieldhand.robot.bindings import EventBinding, FieldBinding, TopicBinding
from fieldhand.robot.loader import parse_profile, profile_bytes
from fieldhand.robot.model import RobotProfile
from fieldhand.task.plan import Act, ForEach
from fieldhand.task.results import Acted, EventBegan, Waited
from ros2.sim_robots import patient, sim_robot
from ros2.simulated_robot_rig import SITE
from ros2.test_simulated_robot_contract import OverSimulatedRobot
from support.missions.rig import Rig, authorized, captured, of_type
from support.missions.watched import watch, watchful, watching, windy
from support.processes.command import fieldhand

PLAN = ForEach(select=Rows(first="2", last="2"), body=Act(action="read_co2"))
BOOL, NUMBER = "std_msgs/msg/Bool", "std_msgs/msg/Float32"


def bound(name: str, type_name: str, value: FieldBinding, **test: float) -> EventBinding:
    return EventBinding(topic=TopicBinding(topic=name, type=type_name, stale_s=5.0), value=value, **test)


def reporting() -> RobotProfile:
    """The robot whose events have topics: a flag, a distance, and wind in km/h."""
    robot = watchful()
    assert robot.ros2 is not None
    data = FieldBinding(path="data")
    events = {
        "rain": bound("rain", BOOL, data, equals=1.0),
        "person_near": bound("people/nearest", NUMBER, data, below=5.0),
        "wind": bound("wind", NUMBER, FieldBinding(path="data", scale=1 / 3.6)),
        "gate_closed": bound("gate/open", BOOL, data, equals=0.0),
    }
    return replace(robot, ros2=replace(robot.ros2, events=events))


class Reporting(OverSimulatedRobot):
    """A simulated robot that reports events."""

    robot: ClassVar[RobotProfile] = reporting()


@pytest.mark.parametrize(
    ("response", "scripted"),
    [
        (watch("rain", "wait"), ScriptedEvent(event="rain", from_s=20, until_s=60)),
        (watch("person_near", "wait"), ScriptedEvent(event="person_near", from_s=20, until_s=60)),
        (windy(5.0, "wait"), ScriptedEvent(event="wind", value=7.0, from_s=20, until_s=60)),
        (watch("gate_closed", "wait"), ScriptedEvent(event="gate_closed", from_s=20, until_s=60)),
        (watch("person_near", "return_to_end"), ScriptedEvent(event="person_near", silent=True, from_s=20)),
    ],
)
def test_a_mission_reacts_as_in_the_plain_simulation(response, scripted):
    task, world = watching(PLAN, response), World(events=(scripted,))
    reports = Reporting()
    driver, clock, _ = reports.make_in(world)
    there = run(
        authorized(task, SITE, reports.robot),
        site=SITE,
        robot=reports.robot,
        driver=driver,
        guard=NoGuard(),
        clock=clock,
        emit=lambda event: None,
    )
    here = Rig(robot=reports.robot, world=world).fly(task)
    assert there.status == here.status
    assert [e.name for e in of_type(there.events, EventBegan)] == [e.name for e in of_type(here.events, EventBegan)]
    assert [e.over for e in of_type(there.events, Waited)] == [e.over for e in of_type(here.events, Waited)]
    if here.status == "completed":
        assert captured(there.events) == captured(here.events)
    (began,) = of_type(there.events, EventBegan)
    assert 20 <= began.t <= 40
    for event in of_type(there.events, Waited):
        assert 35 <= event.seconds <= 60


@pytest.mark.parametrize(
    ("message", "binding", "value"),
    [
        ({"data": True}, bound("t", BOOL, FieldBinding(path="data"), equals=1.0), 1.0),
        ({"data": False}, bound("t", BOOL, FieldBinding(path="data"), equals=0.0), 1.0),
        ({"data": 3.0}, bound("t", NUMBER, FieldBinding(path="data"), below=5.0), 1.0),
        ({"data": 7.2}, bound("t", NUMBER, FieldBinding(path="data", scale=0.5)), 3.6),
        ({"detections": ({}, {})}, bound("t", NUMBER, FieldBinding(path="detections"), above=0.0), 1.0),
        ({"detections": ()}, bound("t", NUMBER, FieldBinding(path="detections"), above=0.0), 0.0),
        ({"data": float("nan")}, bound("t", NUMBER, FieldBinding(path="data"), below=5.0), None),
        ({}, bound("t", NUMBER, FieldBinding(path="data"), below=5.0), None),
    ],
)
def test_the_value_of_an_event_in_a_message(message, binding, value):
    assert event_value(message, binding) == value


def profile(**ros2: object) -> bytes:
    """The built-in husky with a rain sensor and an anemometer, and other keys of their topics."""
    content = yaml.safe_load(profile_bytes("husky")[0])
    content["events"] = {
        "rain": {"description": "it rains", "words": ["rain"], "verbs": ["rain"]},
        "wind": {"description": "the wind is strong", "words": ["wind"], "unit": "m/s", "above": 8},
    }
    topics = {"rain": {"topic": "rain"}, "wind": {"topic": "wind", "type": NUMBER, "path": "data", "unit": "km/h"}}
    content["ros2"]["events"] = {**topics, **ros2}
    return yaml.safe_dump(content).encode()


def test_a_profile_binds_its_events():
    robot = parse_profile(profile())
    assert robot.ros2 is not None
    rain, wind = robot.ros2.events["rain"], robot.ros2.events["wind"]
    assert (rain.equals, rain.topic.stale_s) == (1.0, 10.0)
    assert wind.value.scale == pytest.approx(1 / 3.6)
    assert [event.name for event in robot.events] == ["rain", "wind"]


@pytest.mark.parametrize(
    ("changed", "why"),
    [
        ({"snow": {"topic": "snow"}}, "the profile has no event 'snow'"),
        ({"wind": {"topic": "wind", "type": NUMBER, "path": "data", "above": 3}}, "has no equals, above or below"),
        ({"wind": {"topic": "wind", "type": NUMBER, "path": "data", "unit": "degC"}}, "degC cannot be turned into m/s"),
        ({"rain": {"topic": "rain", "unit": "m/s", "path": "data"}}, "has no unit"),
        ({"rain": {"topic": "rain", "above": 1, "below": 3}}, "give only one of"),
    ],
)
def test_bindings_that_do_not_fit_are_refused(changed, why):
    with pytest.raises(ProfileError) as refused:
        parse_profile(profile(**changed))
    assert why in f"{refused.value} {refused.value.advice}"


def test_a_mission_over_dds_waits_for_the_rain_to_stop(tmp_path: Path) -> None:
    """As a user gives it: the robot in another process publishes the topics of its profile."""
    pytest.importorskip("cyclonedds")
    path = patient(tmp_path)
    content = yaml.safe_load(path.read_text())
    own = yaml.safe_load(profile())
    content["events"], content["ros2"]["events"] = own["events"], own["ros2"]["events"]
    path.write_text(yaml.safe_dump(content))
    world = tmp_path / "world.yaml"
    world.write_text(yaml.safe_dump({"events": [{"event": "rain", "from_s": 0, "until_s": 400}]}))
    words = ("--site", "demo", "--robot", str(path), "--world", str(world), "--speed", "20")
    with sim_robot(tmp_path, *words) as robot:
        done = fieldhand(
            *("run", "Measure CO2 at tree 4. If it rains, wait."),
            *("--site", "demo", "--robot", str(path), "--yes", "--confirm", "--json"),
            *("--missions", str(tmp_path / "m"), "--events", str(tmp_path / "log.jsonl"), *robot.reached),
        )
        assert done.status == 0, done.err
    lines = [json.loads(line) for line in (tmp_path / "log.jsonl").read_text().splitlines()]
    kinds = [line["event"] for line in lines if line["event"] in ("event_began", "event_ended", "wait", "action")]
    assert kinds == ["event_began", "event_ended", "wait", "action"]
    assert Acted.event == kinds[-1]
