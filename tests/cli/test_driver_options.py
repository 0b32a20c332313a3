"""On what a mission is carried out: what contradicts itself is refused before anything is planned or reached."""

from __future__ import annotations

from pathlib import Path

import pytest
from typer.testing import CliRunner

from fieldhand import missions
from fieldhand.cli.app import assemble
from fieldhand.cli.driver_options import DriverOptions, connection_again, connection_of
from fieldhand.errors import ExecutionError, FieldhandError, InputError
from fieldhand.execution.vehicle import Connection
from support.missions.kept import inputs

RUN = ("run", "Measure CO2 at tree 5.", "--site", "demo", "--yes")


def refused(*words: str) -> FieldhandError:
    """Return the message of a command that cannot be carried out."""
    done = CliRunner().invoke(assemble(), words)
    assert isinstance(done.exception, FieldhandError), done.output
    return done.exception


@pytest.mark.parametrize(
    ("words", "said"),
    [
        (("--on", "submarine"), "cannot run on 'submarine'.*simulation, dds"),
        (("--domain", "3"), "the simulation does not support domain; use it together with --on dds"),
        (("--on", "simulation", "--namespace", "a"), "the simulation does not support namespace"),
        (("--sim-time",), "the simulation does not support sim-time"),
        (("--on", "dds", "--namespace", "a b"), "--namespace: 'a b' is not a ROS name"),
        (("--on", "dds", "--speed", "10"), "runs only in real time"),
        (("--on", "dds", "--world", "w.yaml"), "a world file is for the simulation"),
    ],
)
def test_options_that_contradict_each_other(words: tuple[str, ...], said: str, tmp_path: Path) -> None:
    error = refused(*RUN, "--missions", str(tmp_path), *words)
    assert error.exit_status == 2
    with pytest.raises(FieldhandError, match=said):
        raise error
    assert list(tmp_path.iterdir()) == []


def test_a_profile_that_does_not_say_how_its_robot_is_reached(tmp_path: Path) -> None:
    from fieldhand.robot.loader import profile_bytes

    profile = tmp_path / "robot.yaml"
    profile.write_bytes(profile_bytes("husky")[0].partition(b"\nros2:")[0] + b"\n")
    error = refused(*RUN, "--missions", str(tmp_path / "missions"), "--on", "dds", "--robot", str(profile))
    assert error.exit_status == 2
    assert "does not define how the robot is reached over ROS 2" in str(error)
    assert not (tmp_path / "missions").exists()


def test_a_mission_goes_on_on_what_it_was_begun(tmp_path: Path) -> None:
    missions.begin(tmp_path, "m1", inputs())
    error = refused("resume", "m1", "--missions", str(tmp_path), "--on", "dds")
    assert error.exit_status == 1
    assert "started in simulation and cannot be continued on a robot" in str(error)

    by = Connection(transport="dds", domain=4, namespace="/a", sim_time=True)
    begun = missions.RobotAtStart(by=by, charge_percent=90.0)

    def again(on: str | None = None, domain: int | None = None, namespace: str | None = None) -> Connection | None:
        return connection_again(
            "m1", begun, DriverOptions(on=on, domain=domain, namespace=namespace), {"ROS_DOMAIN_ID": "9"}
        )

    assert again() == again("dds") == by
    assert again(domain=5, namespace="/") == Connection(transport="dds", domain=5, namespace="", sim_time=True)
    with pytest.raises(ExecutionError, match=r"started on a robot \(dds, domain 4 as /a\)"):
        again("simulation")


def test_the_domain_is_that_of_the_environment_where_none_is_given() -> None:
    def domain(said: str | None, given: int | None = None) -> int:
        environ = {} if said is None else {"ROS_DOMAIN_ID": said}
        connection = connection_of(DriverOptions(on="dds", domain=given), environ)
        assert connection is not None
        return connection.domain

    assert (domain(None), domain(""), domain(" 42 "), domain("42", 7)) == (0, 0, 42, 7)
    for bad in ("-1", "233", "two", "1.5"):
        with pytest.raises(InputError, match=r"ROS_DOMAIN_ID.*is not a DDS domain"):
            domain(bad)


@pytest.mark.parametrize(("said", "namespace"), [("/", ""), ("", ""), ("a", "/a"), ("/a/b_2", "/a/b_2")])
def test_a_namespace_is_written_as_people_do(said: str, namespace: str) -> None:
    connection = connection_of(DriverOptions(on="dds", domain=1, namespace=said), {})
    assert connection is not None
    assert connection.namespace == namespace
