"""What is built in is listed by name, and nothing says where it lies."""

from __future__ import annotations

from importlib import resources
from pathlib import Path

from fieldhand.robot.loader import load_robot, robot_names
from support.processes.browser import browser


def test_every_built_in_robot_is_listed_and_can_be_asked_for() -> None:
    web = browser()
    listed = [robot["name"] for robot in web.get("/api/robots").json()]
    assert tuple(listed) == robot_names()
    for name in listed:
        record = web.get(f"/api/robots/{name}").json()
        assert [a["name"] for a in record["actions"]] == [a.name for a in load_robot(name).actions]
        assert "source" not in record


def test_the_built_in_sites_are_listed() -> None:
    demo, vineyard = browser().get("/api/sites").json()
    assert (demo["name"], vineyard["name"]) == ("demo", "vineyard")
    assert demo["trees"] > 100
    assert vineyard["trees"] > 900


def test_an_unknown_robot_is_a_problem_that_names_those_there_are() -> None:
    answer = browser().get("/api/robots/husqvarna")
    assert answer.status_code == 400
    assert all(name in answer.json()["advice"] for name in robot_names())


def test_a_robot_is_never_read_from_a_file(tmp_path: Path) -> None:
    own = tmp_path / "own.yaml"
    own.write_bytes((resources.files("fieldhand.robot") / "profiles" / "husky.yaml").read_bytes())
    answer = browser().post("/api/plan", {"request": "corners", "robot": str(own)})
    assert answer.status_code == 400
    assert str(tmp_path) not in answer.text


def test_the_schema_of_the_api_names_every_address() -> None:
    paths = browser().get("/api/openapi.json").json()["paths"]
    unversioned = {path for path in paths if not path.startswith("/api/v1/")}
    assert {path.replace("/api/", "/api/v1/") for path in unversioned} == set(paths) - unversioned
    assert unversioned == {
        "/api/sites",
        "/api/robots",
        "/api/robots/{name}",
        "/api/languages",
        "/api/site",
        "/api/plan",
        "/api/check",
        "/api/run",
    }
