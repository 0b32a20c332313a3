"""Every fault of a robot over ROS 2, over real DDS: a start-up error that says what to do, or a mission that ends by
the exit that docs/faults.md promises.
"""

from __future__ import annotations

import re
from collections.abc import Callable, Iterator
from dataclasses import replace
from typing import Any

import pytest

from fieldhand.errors import Ros2Error
from fieldhand.execution.drivers.protocol import ActionGoal, Progress
from fieldhand.execution.drivers.ros2.dds.names import reply_name, request_name, wire_type
from fieldhand.execution.drivers.ros2.dds.transport import DdsTransport
from fieldhand.execution.mission_runner import Result
from fieldhand.places.selectors import TreeIs
from fieldhand.task.plan import Act, GoTo, InOrder, Node
from fieldhand.task.results import Acted, Driving, Faulted, Waited
from fieldhand.testing.driver_contract import drive_goal, finish
from ros2.other_vendor import OtherVendor
from ros2.robot_in_process import Meeting, RobotInProcess
from ros2.scripted_robot import READ, SITE, bindings, navigating
from support.missions.rig import captured, of_type
from support.processes.patience import until

NEAR, FAR = SITE.trees[0].place, SITE.trees[-1].place
NAVIGATION = "/husky/navigate_to_pose"

Meet = Callable[..., Meeting]


@pytest.fixture(scope="module")
def robots(domain: int) -> Iterator[list[RobotInProcess]]:
    made: list[RobotInProcess] = []
    yield made
    for robot in made:
        robot.kill()


@pytest.fixture
def meet(robots: list[RobotInProcess]) -> Iterator[Meet]:
    """Makes a robot anew, and a computer that finds it, in place of those before."""
    nodes: list[DdsTransport] = []

    def make(*bound: Any, **switches: Any) -> Meeting:
        while nodes:
            nodes.pop().close()
        if not robots or not robots[-1].alive:
            robots.append(RobotInProcess())
        meeting = Meeting(robots[-1], *bound, **switches)
        nodes.append(meeting.node)
        return meeting

    yield make
    for node in nodes:
        node.close()


def go(tree: str) -> GoTo:
    return GoTo(id="", place=TreeIs(tree=tree))


def act(action: str, tree: str) -> Act:
    return Act(id="", action=action, at=TreeIs(tree=tree))


def driven(meeting: Meeting, *, until_m: float | None = None, **change: Any) -> Progress:
    """Return how a drive to the last tree ends, when after some metres something changes."""
    driver = meeting.connect()
    driver.start_drive(drive_goal(SITE.start, FAR))
    if until_m is not None:
        while meeting.robot.state["driven_m"] < until_m:
            meeting.clock.advance(0.2)
            assert driver.poll().state == "running"
    meeting.robot.tell("change", **change)
    return finish(driver, meeting.clock)


def flown(meeting: Meeting, *plan: Node, after_m: float, then: Callable[[], None]) -> Result:
    """A mission in which something happens after so many metres."""
    driver = meeting.connect()
    meeting.clock.meanwhile = lambda: meeting.robot.state.get("driven_m", 0.0) >= after_m, then
    return meeting.fly(InOrder(id="", steps=plan), driver)


def why(meeting: Meeting) -> str:
    """Why a mission does not begin."""
    with pytest.raises(Ros2Error) as caught:
        meeting.connect()
    assert meeting.robot.state["goals"] == 0
    return str(caught.value)


def faults(result: Result) -> list[tuple[str, bool]]:
    return [(e.fault, e.handled) for e in of_type(result.events, Faulted)]


def ended(result: Result, status: str, then: str, reason: str) -> None:
    """By this exit, and for this reason."""
    exits = [e.then for e in result.events if e.event == "exit"]
    assert (result.status, exits[-1]) == (status, then), result.reason
    assert re.search(reason, result.reason), result.reason


# --- before a mission ------------------------------------------------------------------------------------------------


def test_a_server_that_is_absent(meet: Meet) -> None:
    said = why(meet(without="navigation"))
    assert f"navigation {NAVIGATION}: there is no server; start it; if it runs, compare its name, namespace" in said
    assert said.count("; start it") == 1


def test_two_robots_on_one_domain(meet: Meet) -> None:
    said = why(meet(robots=2))
    assert f"navigation {NAVIGATION}: 2 servers answer it: which robot is meant?" in said
    assert "if these are two robots" in said


def test_a_namespace_that_is_wrong_and_one_that_is_right(meet: Meet) -> None:
    said = why(meet(bindings(namespace="/fendt")))
    for name in ("/fendt/navigate_to_pose", "/fendt/fix", "/fendt/battery", "/fendt/sample"):
        assert re.search(rf"{name}: there is no \w+[,;]", said), name
    assert "compare its name, namespace and ROS_DOMAIN_ID" in said
    meeting = meet(bindings(namespace="/field/fendt"), namespace="/field/fendt")
    assert meeting.fly(go("r0c0")).status == "completed"


def test_a_type_of_another_name_and_one_of_the_same_name_with_other_fields(meet: Meet) -> None:
    said = why(meet(thermometer_type="std_srvs/srv/Trigger"))
    assert "/thermometer: it is answered as std_srvs/srv/Trigger, not as farm_msgs/srv/Read; correct the type" in said
    for other in ("string kind\n---\nbool ok\nstring words", "string kind\nbool twice\n---\nbool ok\nfloat64 kelvin"):
        said = why(meet(definitions={READ: other}))
        assert (
            "/thermometer: the robot has another definition of farm_msgs/srv/Read than is known here; leave distro out"
            in said
        )
    said = why(meet(definitions={READ: other}, hashes=False))
    assert "/thermometer: it was discovered, but is not matched in both directions; check that its" in said


def test_a_quality_that_does_not_match(meet: Meet) -> None:
    bound = bindings()
    reliable = replace(bound.position, fix=replace(bound.position.fix, reliable=True))
    said = why(meet(replace(bound, position=reliable)))
    assert (
        "the position /husky/fix: it is sent best effort and read reliably, which never match; leave reliable" in said
    )


@pytest.mark.parametrize(
    ("switches", "said"),
    [
        ({"silent": ["battery"]}, "the battery /husky/battery: no message yet; check whether the robot publishes it"),
        ({"silent": ["fix"]}, "the position /husky/fix: no message yet"),
        ({"fix_status": -1}, "the position /husky/fix: no satellite fix"),
        ({"pressed": True}, r"the emergency stop was pressed \(/husky/stop\); release it"),
    ],
)
def test_a_robot_that_is_not_ready(meet: Meet, switches: dict[str, Any], said: str) -> None:
    assert re.search(said, why(meet(**switches)))


def test_services_of_a_middleware_that_cannot_be_served(meet: Meet, domain: int) -> None:
    meeting = meet(without="navigation")
    of = navigating().type
    parts = [(f"{NAVIGATION}/_action/{part}", f"{of}_{name}") for part, name in
             (("send_goal", "SendGoal"), ("get_result", "GetResult"))]  # fmt: skip
    parts.append((f"{NAVIGATION}/_action/cancel_goal", "action_msgs/srv/CancelGoal"))
    other = OtherVendor(
        domain,
        reads=[(request_name(part), wire_type(f"{kind}_Request")) for part, kind in parts],
        writes=[(reply_name(part), wire_type(f"{kind}_Response")) for part, kind in parts],
    )
    until(lambda: other.say() or len(meeting.node.servers_of(parts[-1][0])) == 1)  # type: ignore[func-returns-value]
    said = why(meeting)
    other.close()
    assert "the robot runs rmw_fastrtps_cpp, whose services cannot be called over the dds transport" in said
    assert "set RMW_IMPLEMENTATION=rmw_cyclonedds_cpp on the robot" in said


# --- drives ----------------------------------------------------------------------------------------------------------


def test_a_goal_that_is_rejected(meet: Meet) -> None:
    result = meet(accepts=False).fly(go("r0c0"))
    ended(result, "faulted", "stay", f"{NAVIGATION} rejected the goal; check whether Nav2 is active")
    assert faults(result) == [("drive_failed", True), ("drive_failed", False)]


@pytest.mark.parametrize(
    ("distro", "code", "fault", "words"),
    [
        ("jazzy", {"error_code": 105}, "blocked", r"the robot made no progress \(code 105 of Nav2\)"),
        ("jazzy", {"error_code": 202}, "lost", "the robot's pose in its map is not known"),
        ("jazzy", {"error_code": 201}, "failed", "the planner that is configured does not exist"),
        ("kilted", {"error_code": 204, "error_msg": "out"}, "failed", "the goal lies outside of its map .*: out"),
        ("humble", {}, "blocked", "navigation failed without an error code"),
    ],
)
def test_a_drive_that_nav2_aborts(meet: Meet, distro: str, code: dict[str, Any], fault: str, words: str) -> None:
    progress = driven(meet(distro=distro), until_m=1.0, ends="aborted", result=code, way=[])
    assert (progress.state, progress.fault) == ("failed", fault)
    assert re.match(words, progress.what), progress.what


def test_a_way_that_is_blocked_for_good(meet: Meet) -> None:
    plan = (act("read_co2", "r0c0"), go("r0c1"))
    result = meet(blocked=(*SITE.by_id["r0c1"].place.xy, 3.0)).fly(InOrder(id="", steps=plan))
    ended(result, "faulted", "stay", r"tree r0c1.*: no way to the goal was found \(code 208 of Nav2\): no valid path")
    assert captured(result.events) == [("read_co2", "r0c0")]


def test_navigation_that_ends_in_mid_drive(meet: Meet) -> None:
    meeting = meet()
    result = flown(meeting, go("r3c4"), after_m=3.0, then=lambda: meeting.robot.tell("change", without="navigation"))
    ended(result, "faulted", "stay", rf"within 4 s \(nothing answers {NAVIGATION}\); check whether Nav2 is active")
    (first, _, _) = [e.what for e in of_type(result.events, Faulted)]
    assert f"{NAVIGATION} is gone: nothing answers any more; check whether Nav2 runs on the robot; if it" in first


def test_a_second_robot_that_comes_in_mid_mission(meet: Meet) -> None:
    meeting = meet()
    result = flown(meeting, go("r0c0"), go("r0c4"), after_m=1.0, then=lambda: meeting.robot.tell("another"))
    ended(result, "faulted", "stay", f"2 servers answer {NAVIGATION}: which robot is meant?")
    assert meeting.robot.state["goals"] == 1


def test_a_fix_that_is_lost_and_comes_back_and_one_that_does_not(meet: Meet) -> None:
    meeting = meet()
    lost = [{"fix_status": -1}, {"fix_status": 0}]

    def fades() -> None:
        meeting.robot.tell("change", **lost.pop(0))
        begun = meeting.clock.now()
        meeting.clock.meanwhile = lambda: meeting.clock.now() > begun + 2.0, returns

    def returns() -> None:
        meeting.robot.tell("change", **lost.pop(0))

    result = flown(meeting, go("r0c1"), after_m=3.0, then=fades)
    assert result.status == "completed"
    assert [(e.wanted, e.over, e.what) for e in of_type(result.events, Waited)] == [
        ("position", True, "no satellite fix")
    ]

    meeting = meet()
    result = flown(meeting, go("r3c4"), after_m=3.0, then=lambda: meeting.robot.tell("change", silent=["fix"]))
    ended(result, "faulted", "stay", "does not know where it is .no message on /husky/fix for .*bring it back by hand")
    assert meeting.robot.state["executing"] == 0


@pytest.mark.parametrize(("topic", "named"), [("battery", "battery"), ("stop", "emergency stop")])
def test_a_topic_that_falls_silent_in_mid_mission(meet: Meet, topic: str, named: str) -> None:
    meeting = meet()
    result = flown(meeting, go("r3c4"), after_m=3.0, then=lambda: meeting.robot.tell("change", silent=[topic]))
    ended(result, "faulted", "stay", f"the {named} is silent: no message on /husky/{topic} for [5-9] s")
    assert meeting.robot.state["executing"] == 0


def test_the_emergency_stop(meet: Meet) -> None:
    meeting = meet()
    result = flown(meeting, go("r3c4"), after_m=3.0, then=lambda: meeting.robot.tell("change", pressed=True))
    ended(result, "aborted", "stay", r"the emergency stop was pressed \(/husky/stop\)")
    assert meeting.robot.state["executing"] == 0
    assert len(of_type(result.events, Driving)) == 1


# --- captures --------------------------------------------------------------------------------------------------------


@pytest.mark.parametrize(
    ("action", "switches", "words"),
    [
        (
            "read_ambient_temperature",
            {"thermometer": None},
            "/thermometer did not answer within 5 s; check whether it runs",
        ),
        ("take_thermal_picture", {"canopy": None}, "no message on /husky/canopy within 4 s, so there is no canopy_"),
    ],
    ids=["service", "topic"],
)
def test_a_sensor_that_is_silent(meet: Meet, action: str, switches: dict[str, Any], words: str) -> None:
    result = meet(**switches).fly(act(action, "r0c0"))
    ended(result, "faulted", "return_to_start", f"{action} failed 2 times: {words}")
    assert [(e.status, e.attempt) for e in of_type(result.events, Acted)] == [("failed", 1), ("failed", 2)]


def test_an_action_whose_server_ends_in_mid_capture(meet: Meet) -> None:
    meeting = meet()
    driver = meeting.connect()
    driver.start_action(ActionGoal(action="read_co2", place=NEAR))
    while meeting.robot.state["executing"] == 0:
        meeting.clock.advance(0.2)
        driver.poll()
    meeting.robot.tell("change", without="sampler")
    progress = finish(driver, meeting.clock)
    assert (progress.state, progress.fault) == ("failed", "failed")
    assert "/husky/sample is gone: nothing answers any more; check whether it runs on the robot" in progress.what


# --- its end ---------------------------------------------------------------------------------------------------------


def test_a_robot_that_is_killed_in_mid_drive(meet: Meet) -> None:
    meeting = meet()
    result = flown(meeting, go("r3c4"), after_m=3.0, then=meeting.robot.kill)
    ended(result, "faulted", "stay", "no message on /husky/fix for")
    said = [e.what for e in of_type(result.events, Faulted)]
    assert faults(result)[-1] == ("lost", False), said
    assert [e.over for e in of_type(result.events, Waited)] == [False]
