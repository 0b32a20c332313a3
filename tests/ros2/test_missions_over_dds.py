"""Whole missions over DDS, with a robot in another process: they go as in the plain simulation, whatever is killed.

The robot's own account says what it has done; what the mission's log says is held against that.
"""

from __future__ import annotations

import json
import math
import os
from collections import Counter
from collections.abc import Callable, Sequence
from dataclasses import dataclass
from datetime import datetime
from functools import partial
from pathlib import Path
from typing import Any

import pytest
import yaml
from typer.testing import CliRunner

from fieldhand import mission, missions
from fieldhand.approval.authorize import EveryWarning
from fieldhand.cli.app import assemble
from fieldhand.cli.demo import MISSIONS, DemoName
from fieldhand.compatibility import UTC
from fieldhand.errors import Ros2Error
from fieldhand.execution.drivers.ros2 import robot_connection
from fieldhand.execution.drivers.ros2.robot_connection import connected_robot
from fieldhand.execution.drivers.simulation.world import World
from fieldhand.execution.drivers.simulation.world_file import parse_world
from fieldhand.execution.journal import store
from fieldhand.execution.vehicle import Vehicle
from fieldhand.planning.english.planner import EnglishPlanner
from fieldhand.planning.planner import Planned
from fieldhand.robot.loader import load_robot, profile_bytes
from fieldhand.site.loader import open_site, site_files
from fieldhand.task.event_lines import to_json
from fieldhand.task.results import Acted, Arrived, Ended, Event, InDoubt, Paused, Resumed, Shed
from fieldhand_bench.missions.case_file import load_cases
from fieldhand_bench.missions.case_site import load_case_site
from fieldhand_bench.missions.judge import judge
from fieldhand_bench.missions.log import read_log
from ros2.robot_in_process import connected_simulated_robot
from ros2.sim_robots import SimRobot, patient, sim_robot
from support.missions.outside_referee import CASES, HERE, ground, referee
from support.missions.rig import of_type
from support.processes.command import fieldhand, in_background
from support.processes.patience import until

pytest.importorskip("cyclonedds")

#: Its seconds in one of ours.
FAST = "50"
#: Metres from where it stood after which a robot is on its way.
SOME_M = 5.0
#: Cases that stand beside the project, else of our own.
CHOSEN = (
    (str(CASES), (("four-trees-two-sensors", 0), ("five-nested-ifs", 0), ("relative-conditionals", 0)))
    if HERE
    else ("builtin", (("low-co2", 0), ("either-of-two-readings", 0), ("tree-and-neighbours", 0)))
)


@pytest.fixture(autouse=True)
def _no_disk(monkeypatch: pytest.MonkeyPatch) -> None:
    monkeypatch.setattr(store, "SYNCHRONOUS", "OFF")


@pytest.fixture
def _soon_forgotten(monkeypatch: pytest.MonkeyPatch) -> None:
    """A robot that is killed is forgotten after three seconds, not ten."""
    lease = "<Discovery><LeaseDuration>3s</LeaseDuration></Discovery>"
    monkeypatch.setenv("CYCLONEDDS_URI", os.environ["CYCLONEDDS_URI"].replace("</Domain>", f"{lease}</Domain>"))


def captures(events: Sequence[Event]) -> list[tuple[str, str, dict[str, float]]]:
    """Each capture that was made, in its order: what, where, and what it measured."""
    return [
        (e.action, e.place, {name: pytest.approx(value, rel=1e-4) for name, value in e.readings.items()})
        for e in events
        if isinstance(e, Acted) and e.status == "success"
    ]


@dataclass(frozen=True, kw_only=True)
class Plan:
    """An approved mission.

    Attributes:
        site, robot: Files, or names of what is built in.
        seed: Of every random thing in the simulation, and of the guard.
    """

    approved: mission.ApprovedMission
    site: str
    robot: str = "husky"
    seed: int = 0

    @classmethod
    def of(cls, request: str, *, site: str = "demo", robot: str = "husky", seed: int = 0) -> Plan:
        place, profile = open_site(site), load_robot(robot)
        outcome = mission.plan(request, place, profile, EnglishPlanner())
        assert isinstance(outcome, Planned), outcome
        at = datetime(2026, 1, 1, tzinfo=UTC)
        approved = mission.authorize(
            mission.review(outcome.task, place, profile), by="tester", at=at, confirmed=EveryWarning()
        )
        return cls(approved=approved, site=site, robot=robot, seed=seed)

    def simulated(self, world: World) -> tuple[Event, ...]:
        """Return the events of the plain simulation."""
        return mission.simulate(self.approved, world=world, seed=self.seed, speed=None, emit=lambda _: None).events

    def kept(self, under: Path, vehicle: Vehicle) -> missions.StoredMission:
        """Its folder."""
        inputs = missions.Inputs(
            authorized=self.approved.authorized,
            site=open_site(self.site),
            robot=load_robot(self.robot),
            files=site_files(self.site),
            profile=profile_bytes(self.robot)[0],
            started_on=missions.robot_at_start(vehicle),
            seed=self.seed,
        )
        return missions.begin(under, "m1", inputs)

    def carried_out(
        self,
        under: Path,
        robot_there: SimRobot,
        emit: Callable[[Path, Event], None] = lambda *_: None,
        under_way: Callable[[Path], None] = lambda _: None,
    ) -> tuple[Event, ...]:
        """Return the events on the robot that answers.

        Args:
            emit: Takes each event, with the mission's folder.
            under_way: Called at each tick once the robot is some metres from where it stood.
        """
        site, robot = open_site(self.site), load_robot(self.robot)
        with connected_robot(site, robot, self.approved.task, robot_there.by) as vehicle:
            return self.carried_out_by(vehicle, under, emit, under_way)

    def carried_out_by(
        self,
        vehicle: Vehicle,
        under: Path,
        emit: Callable[[Path, Event], None] = lambda *_: None,
        under_way: Callable[[Path], None] = lambda _: None,
    ) -> tuple[Event, ...]:
        """Return the events on a vehicle that is ready."""
        missions.require_in_place(open_site(self.site), load_robot(self.robot), vehicle.driver)
        given, stood = self.kept(under, vehicle), vehicle.driver.position()

        def look() -> None:
            at = vehicle.driver.position()
            if math.dist((at.x, at.y), (stood.x, stood.y)) > SOME_M:
                under_way(given.folder)

        return missions.carry_out(
            given, vehicle=vehicle, emit=lambda event: emit(given.folder, event), interrupted=look
        ).events


# --- as in simulation -----------------------------------------------------------------------------------------------


def test_the_demo_goes_as_in_simulation(tmp_path: Path) -> None:
    """The budget of distance is just enough for some of the visits; robot and mission live on one time, so that what is
    decided depends on no process that waits for its turn."""
    husky = str(patient(tmp_path, type="nav2_msgs/action/NavigateThroughPoses"))
    plan = Plan.of(MISSIONS[DemoName.PICTURES].request, robot=husky, seed=7)
    with connected_simulated_robot("demo", husky, plan.approved.task, seed=plan.seed, tick_s=0.5) as (vehicle, far):
        there = plan.carried_out_by(vehicle, tmp_path)
        made = [place for name, place in far.state["made"] if name.endswith("take_picture")]
    here = plan.simulated(World())
    assert captures(there) == captures(here)
    assert [e.places for e in of_type(there, Shed)] == [e.places for e in of_type(here, Shed)] != []
    pictures = [f"tree {place}" for action, place, _ in captures(there) if action == "take_thermal_picture"]
    assert made == pictures
    assert len(pictures) > 8


def test_the_command_goes_as_in_simulation(tmp_path: Path) -> None:
    """As a user gives it, with a reading that decides what is done."""
    request = "Take a thermal picture at the four corner trees. Where the canopy is hotter than 34 °C measure CO2 too."
    husky = str(patient(tmp_path, type="nav2_msgs/action/NavigateThroughPoses"))
    run = ("run", request, "--site", "demo", "--robot", husky, "--seed", "7", "--yes", "--confirm", "--json")
    with sim_robot(tmp_path, "--site", "demo", "--robot", husky, "--seed", "7", "--speed", FAST) as robot:
        real = fieldhand(
            *run, "--missions", str(tmp_path / "m"), "--events", str(tmp_path / "real.jsonl"), *robot.reached
        )
        assert real.status == 0, real.err
        made = robot.made("take_picture")
    plain = fieldhand(*run, "--missions", str(tmp_path / "plain"), "--events", str(tmp_path / "plain.jsonl"))
    there, here = (read(tmp_path / name) for name in ("real.jsonl", "plain.jsonl"))
    assert there == here
    assert {action for action, *_ in there} == {"take_thermal_picture", "read_co2"}
    assert sum(made.values()) == sum(1 for action, *_ in there if action == "take_thermal_picture") == 4
    said = json.loads(real.out)
    assert (said["status"], said["mission"] != "") == (json.loads(plain.out)["status"], True)
    (folder,) = (tmp_path / "m").iterdir()
    begun = missions.read_folder(folder).started_on
    assert begun is not None
    assert begun.by.transport == "dds"


def read(log: Path) -> list[Any]:
    """The captures of an event log, in their order."""
    lines = [json.loads(line) for line in log.read_text().splitlines()]
    return [
        (e["action"], e["place"], {k: pytest.approx(v, rel=1e-4) for k, v in e["readings"].items()})
        for e in lines
        if e["event"] == "action" and e["status"] == "success"
    ]


@pytest.mark.parametrize(("name", "number"), CHOSEN[1])
def test_a_case_ends_as_it_was_meant(name: str, number: int, tmp_path: Path) -> None:
    """As in simulation, and right by every judge that is here."""
    (case,) = (case for case in load_cases([CHOSEN[0]]) if case.id == name)
    meant = _written(name)["worlds"][number]
    world = tmp_path / "world.yaml"
    world.write_text(yaml.safe_dump({"readings": meant.get("readings", {})}))
    profile = str(patient(tmp_path, case.robot))
    plan = Plan.of(case.request, site=str(case.site), robot=profile)
    with sim_robot(
        tmp_path, "--site", str(case.site), "--robot", profile, "--world", str(world), "--speed", FAST
    ) as robot:
        events = plan.carried_out(tmp_path, robot)
    assert captures(events) == captures(plan.simulated(parse_world(yaml.safe_load(world.read_text()))))
    lines = [to_json(event) for event in events]
    view = load_case_site(case.site)
    assert judge(view, case.worlds[number].expected, read_log(lines, view)) == ()
    if HERE:
        assert referee().judge(ground(case.site), meant["expect"], [json.loads(line) for line in lines]) is None


def _written(name: str) -> Any:
    """A case as its file has it."""
    builtin = Path(load_cases.__code__.co_filename).parent / "builtin"
    files = [CASES] if HERE else sorted(builtin.glob("*.yaml"))
    return next(case for file in files for case in yaml.safe_load(file.read_text())["cases"] if case["id"] == name)


# --- what a person wants --------------------------------------------------------------------------------------------


def test_pause_return_and_abort(tmp_path: Path) -> None:
    """One mission after the other on one robot: each begins where the last has left it."""
    husky = str(patient(tmp_path))
    with sim_robot(tmp_path, "--site", "demo", "--robot", husky, "--speed", "20") as robot:
        _pause_and_return(robot, husky, tmp_path / "first")
        _abort(robot, husky, tmp_path / "second")


def _pause_and_return(robot: SimRobot, husky: str, folder: Path) -> None:
    """The pause breaks a drive off; what was told to come home leaves the rest and comes home."""
    told: list[str] = []

    def tell(kept: Path, event: Event) -> None:
        match event:
            case Paused():
                told.append("continue")
                missions.send_command(kept, "continue", "lunch is over")
            case Acted():
                told.append("return")
                missions.send_command(kept, "return", "rain")
            case _:
                pass

    def pause(kept: Path) -> None:
        if not told:
            told.append("pause")
            missions.send_command(kept, "pause", "lunch")

    events = Plan.of("Take a picture at trees 5, 6 and 7.", robot=husky).carried_out(folder, robot, tell, pause)
    assert told == ["pause", "continue", "return"]
    ended = events[-1]
    assert isinstance(ended, Ended)
    assert (ended.status, ended.reason) == ("aborted", "rain")
    assert len(captures(events)) == sum(robot.made("take_picture").values()) == 1
    assert drives(robot, since=0).count("cancelled") == 1
    arrived = [e for e in events if isinstance(e, Arrived)][-1]
    assert arrived.place in ("start", "end")
    home = open_site("demo").markers[arrived.place]
    assert (ended.lat, ended.lon) == pytest.approx((home.lat, home.lon), abs=2e-5)


def _abort(robot: SimRobot, husky: str, folder: Path) -> None:
    """The robot stands still on its way, where the mission's log says."""
    before = len(robot.account())

    told: list[Path] = []

    def abort(kept: Path) -> None:
        if not told:
            told.append(kept)
            missions.send_command(kept, "abort", "a child on the field")

    events = Plan.of("Take a picture at trees 5 and 40.", robot=husky).carried_out(folder, robot, under_way=abort)
    ended = events[-1]
    assert isinstance(ended, Ended)
    assert (ended.status, ended.reason) == ("aborted", "a child on the field")
    assert captures(events) == []
    assert drives(robot, since=before)[-1] == "cancelled"


def drives(robot: SimRobot, *, since: int) -> list[str]:
    """Return how its drives ended, of what it has said since."""
    said = [line for line in robot.account()[since:] if line["event"] == "goal"]
    return [line["end"] for line in said if "navigate" in line["name"]]


def test_a_robot_that_does_not_answer_leaves_no_mission_behind(tmp_path: Path, monkeypatch: pytest.MonkeyPatch) -> None:
    hasty = partial(connected_robot, within_s=0.2)
    monkeypatch.setattr(robot_connection, "connected_robot", lambda *args: hasty(*args[:4]))
    words = ("run", "Measure CO2 at tree 5.", "--site", "demo", "--yes", "--confirm", "--on", "dds", "--namespace", "x")
    done = CliRunner().invoke(assemble(), (*words, "--missions", str(tmp_path)))
    assert isinstance(done.exception, Ros2Error)
    assert done.exception.exit_status == 1
    for what in ("/x/navigate_to_pose", "/x/fromLL", "/x/gps/fix", "/x/battery_state", "/x/co2_sensor/read"):
        assert what in str(done.exception)
    assert "thermal_camera" not in str(done.exception)
    assert list(tmp_path.iterdir()) == []


# --- kill -9 --------------------------------------------------------------------------------------------------------

TREES = ("5", "6", "7", "8", "9")
PICTURES = f"Take a thermal picture at trees {', '.join(TREES[:-1])} and {TREES[-1]}."


def each_once(folder: Path, robot: SimRobot) -> None:
    """Every tree has its picture, by the mission's log and by the robot's own account; one in doubt may have two."""
    events = missions.events_of(folder)
    logged = Counter(place for _, place, _ in captures(events))
    doubtful = {e.place for e in events if isinstance(e, InDoubt)}
    assert logged == Counter(TREES)
    made = robot.made("take_picture")
    assert {place.removeprefix("tree ") for place in made} == set(TREES)
    for place, times in made.items():
        assert times == 1 or place.removeprefix("tree ") in doubtful


def test_the_program_is_killed_and_goes_on(tmp_path: Path) -> None:
    under, husky = tmp_path / "m", str(patient(tmp_path))
    with sim_robot(tmp_path, "--site", "demo", "--robot", husky, "--speed", FAST) as robot:
        run = (
            "run",
            PICTURES,
            "--site",
            "demo",
            "--robot",
            husky,
            "--yes",
            "--confirm",
            "--missions",
            str(under),
            *robot.reached,
        )
        with in_background(*run, out=tmp_path / "run.txt"):
            until(lambda: sum(made_in(under).values()) >= 2)
        (folder,) = under.iterdir()
        until(lambda: not missions.is_running(folder))
        assert missions.status(folder).now.state == "interrupted"
        done = fieldhand("resume", "--missions", str(under), "--json")
        assert done.status == 0, done.err
        assert len([e for e in missions.events_of(folder) if isinstance(e, Resumed)]) == 1
        each_once(folder, robot)


def made_in(under: Path) -> Counter[str]:
    """Captures in the journal of the only mission."""
    folders = [folder for folder in under.glob("*") if missions.exists(folder)]
    return Counter(place for folder in folders for _, place, _ in captures(missions.events_of(folder)))


@pytest.mark.usefixtures("_soon_forgotten")
def test_the_robot_is_killed_and_goes_on(tmp_path: Path) -> None:
    """It is switched on again at once, before anybody has noticed."""
    husky = str(patient(tmp_path))
    with sim_robot(tmp_path, "--site", "demo", "--robot", husky, "--speed", FAST) as robot:

        def strike(_: Path, event: Event) -> None:
            if isinstance(event, Acted) and robot.lives == 1:
                robot.kill()
                robot.begin()

        plan = Plan.of(PICTURES, robot=husky)
        events = plan.carried_out(tmp_path, robot, strike)
        assert isinstance(events[-1], Ended)
        assert events[-1].status == "completed", events[-1].reason
        each_once(tmp_path / "m1", robot)
