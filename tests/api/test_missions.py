"""Live missions: nothing unapproved begins, and what a mission does and produces can be fetched at any time."""

from __future__ import annotations

import json
from dataclasses import replace
from pathlib import Path
from typing import Any

import pytest

from fieldhand import missions
from fieldhand.accounts.accounts import Accounts
from fieldhand.accounts.roles import Role
from fieldhand.execution.drivers.simulation.world_file import parse_world
from fieldhand.fleet import Fleet
from fieldhand.planning.planner import Reason, Refused
from fieldhand.site.loader import built_in_path
from fieldhand.task.event_lines import from_json
from support.missions.fleet import FAST, until_over
from support.missions.kept import inputs
from support.processes.browser import Browser, Says, browser, corner_warnings, corner_xml
from support.processes.logins import Visitor, logged_in, server_of

#: One reading of CO2 at tree 5.
BODY = {
    "xml": inputs().document.decode(),
    "confirmed": list(inputs().authorized.authorization.confirmed),
    "approved_by": "Ana",
    "seed": 3,
    "speed": "max",
}


@pytest.fixture(scope="module")
def fleet(tmp_path_factory: pytest.TempPathFactory) -> Fleet:
    return Fleet(tmp_path_factory.mktemp("fleet"))


@pytest.fixture(scope="module")
def done(fleet: Fleet) -> tuple[Browser, str]:
    """A mission that was begun over HTTP, and has ended."""
    web = browser(fleet=fleet)
    answer = web.post("/api/v1/missions", {**BODY, "world": {"readings": {"co2": 395.5}}})
    assert answer.status_code == 201, answer.text
    assert answer.json()["outcome"] == "began"
    name = answer.json()["id"]
    until_over(fleet, name)
    return web, name


@pytest.fixture
def still(tmp_path: Path, monkeypatch: pytest.MonkeyPatch) -> tuple[Browser, Path]:
    """Missions are stored, and no process carries them out."""
    monkeypatch.setattr(Fleet, "_start", lambda self, folder: None)
    return browser(fleet=Fleet(tmp_path)), tmp_path


def get(done: tuple[Browser, str], path: str = "", **options: Any) -> Any:
    web, name = done
    answer = web.get(f"/api/v1/missions/{name}{path}", **options)
    assert answer.status_code == 200, answer.text
    return answer


def folder_of(fleet: Fleet, name: str) -> Path:
    folder = fleet.folder(name)
    assert folder is not None
    return folder


def test_a_mission_is_the_one_that_was_approved(done: tuple[Browser, str], fleet: Fleet) -> None:
    found = get(done).json()
    stored = missions.open_mission(folder_of(fleet, done[1]))
    assert stored.authorized.authorization.by == found["by"] == "Ana"
    assert list(stored.authorized.authorization.confirmed) == BODY["confirmed"]
    assert (stored.seed, found["xml"]) == (3, BODY["xml"])
    assert stored.world.readings["co2"].default == 395.5
    assert found["estimate"]
    assert found["read_back"]["lines"]
    assert {f["properties"]["role"] for f in found["map"]["features"]} >= {"tree", "path", "stop"}
    assert (found["state"], found["status"], found["report"]) == ("ended", "completed", True)
    assert all(goal["name"] and goal["node"] for goal in found["goals"])
    assert [one["id"] for one in done[0].get("/api/v1/missions").json()] == [done[1]]


def test_events_are_those_of_the_journal_and_told_in_both_languages(done: tuple[Browser, str], fleet: Fleet) -> None:
    journal = missions.lines_after(folder_of(fleet, done[1]), 0, 10_000)
    whole = get(done, "/events").json()
    assert [(e["n"], e["at"], e["event"]) for e in whole["events"]] == [(n, at, json.loads(x)) for n, at, x in journal]
    assert get(done, "/events", params={"after": 3}).json()["events"] == whole["events"][3:]
    assert get(done, "/events", params={"after": len(journal)}).json()["events"] == []
    spanish = get(done, "/events", params={"lang": "es"}).json()["events"]
    told = [(a["told"], b["told"]) for a, b in zip(whole["events"], spanish, strict=True) if a["told"]]
    assert told
    assert all(a != b for a, b in told)


def test_what_it_produced_can_be_fetched(done: tuple[Browser, str], fleet: Fleet) -> None:
    folder = folder_of(fleet, done[1])
    log = get(done, "/log")
    assert log.content == (folder / "events.jsonl").read_bytes()
    assert all(from_json(line) for line in log.text.splitlines())
    assert get(done, "/observations.csv").content == (folder / "observations.csv").read_bytes()
    assert get(done, "/results.geojson").content == (folder / "observations.geojson").read_bytes()
    report = get(done, "/report")
    assert report.content == (folder / "report.html").read_bytes()
    policy = report.headers["content-security-policy"]
    assert "default-src 'none'" in policy
    assert "style-src 'unsafe-inline'" in policy
    assert "script" not in policy
    assert report.headers["x-content-type-options"] == "nosniff"
    assert "unsafe-inline" not in get(done, "/log").headers["content-security-policy"]


def test_a_mission_that_has_ended_takes_no_command(done: tuple[Browser, str]) -> None:
    web, name = done
    for command in ("pause", "resume", "return", "abort"):
        answer = web.post(f"/api/v1/missions/{name}/commands", {"command": command, "lang": "es"})
        assert answer.status_code == 200
        assert answer.json() == {"confirmed": False, "sent": False, "by": "", "why": "la misión ha terminado"}


@pytest.mark.parametrize("path", ["", "/events", "/report", "/log", "/observations.csv", "/results.geojson"])
@pytest.mark.parametrize("name", ["20260101-000000-abcdef", "..", "%2e%2e", "a%2fb", "x" * 101, "mission.json"])
def test_what_is_no_mission_is_not_found(done: tuple[Browser, str], name: str, path: str) -> None:
    answer = done[0].get(f"/api/v1/missions/{name}{path}")
    assert answer.status_code in (404, 422)
    assert answer.json()["what"]


@pytest.mark.parametrize("name", ["report.html", "..%2fmission.json", "x.png", "x.svg"])
def test_only_images_are_given_out_as_images(done: tuple[Browser, str], name: str) -> None:
    assert done[0].get(f"/api/v1/missions/{done[1]}/images/{name}").status_code in (404, 422)


def test_a_warning_that_is_not_confirmed_begins_nothing(still: tuple[Browser, Path]) -> None:
    web, folder = still
    answer = web.post("/api/v1/missions", {**BODY, "xml": corner_xml(), "confirmed": []})
    assert answer.status_code == 422
    assert answer.json()["warnings"] == list(corner_warnings())
    assert list(folder.iterdir()) == []


def test_a_request_that_is_not_understood_begins_nothing(tmp_path: Path) -> None:
    refuses = Says(outcome=lambda r, s, p: Refused(reasons=(Reason(what="no"),)))
    answer = browser(refuses, fleet=Fleet(tmp_path)).post(
        "/api/v1/missions", {"request": "dance", "approved_by": "Ana"}
    )
    assert (answer.status_code, answer.json()["outcome"]) == (200, "refused")
    assert list(tmp_path.iterdir()) == []


@pytest.mark.parametrize(
    "more",
    [
        {"request": "corners"},
        {"xml": None},
        {"speed": 0},
        {"speed": -1},
        {"speed": "fast"},
        {"speed": 1e9},
        {"seed": -1},
        {"world": []},
        {"world": {"nothing": 1}},
        {"world": {"readings": {"no_such_quantity": 1}}},
        {"site": "/etc/passwd"},
        {"robot": "../husky"},
        {"xml": "<task/>"},
        {"approved_by": "\x1b[2J"},
        {"surprise": 1},
    ],
    ids=str,
)
def test_what_cannot_be_used_begins_nothing(still: tuple[Browser, Path], more: dict[str, Any]) -> None:
    web, folder = still
    answer = web.post("/api/v1/missions", {**BODY, **more})
    assert answer.status_code in (400, 422), answer.text
    assert answer.json()["what"]
    assert list(folder.iterdir()) == []


@pytest.mark.parametrize("name", ["field", "..", ".", "a/b\\c.json", "x" * 100, "ñandú 北.geojson", "*?.GeoJSON"])
def test_a_site_of_any_name_is_stored_and_read_again(still: tuple[Browser, Path], name: str) -> None:
    web, folder = still
    text = built_in_path("demo").read_text()
    answer = web.post("/api/v1/missions", {**BODY, "site": {"name": name, "text": text}})
    assert answer.status_code == 201, answer.text
    stored = missions.open_mission(folder / answer.json()["id"])
    assert stored.site.sha256 == stored.authorized.authorization.site_sha256


@pytest.mark.parametrize(
    "world",
    [
        {"readings": {"co2": {"default": 1e-7}}},
        {"readings": {"co2": 1e21}},
        {"readings": {"co2": {"default": 400.5, "trees": [{"id": "5", "value": 1}]}}},
        {"faults": [{"fault": "action_fails", "action": "read_co2"}], "seed": 12},
    ],
    ids=str,
)
def test_the_world_that_is_stored_is_the_one_that_was_sent(still: tuple[Browser, Path], world: dict[str, Any]) -> None:
    web, folder = still
    answer = web.post("/api/v1/missions", {**BODY, "world": world, "seed": None})
    assert answer.status_code == 201, answer.text
    stored = missions.open_mission(folder / answer.json()["id"])
    assert replace(stored.world, data=None, source="world") == parse_world(world)
    assert stored.seed == world.get("seed", 0)


def test_another_machine_may_do_nothing(done: tuple[Browser, str]) -> None:
    stranger = Browser(done[0].app, address="192.168.1.9")
    paths = stranger.app.openapi()["paths"]
    guarded = [(path, method) for path, ways in paths.items() if path.startswith("/api/v1/") for method in ways]
    assert len(guarded) >= 10
    for path, method in guarded:
        address = path.replace("{name}", done[1]).replace("{image}", "x.png")
        body = {"json": {**BODY} if path.endswith("missions") else {"command": "abort"}} if method == "post" else {}
        assert stranger.call(method.upper(), address, **body).status_code == 403, path


#: The least role that may call each route; every account may call the others.
LEAST = {"post /missions": Role.APPROVER, "post /missions/{name}/commands": Role.APPROVER}


def test_a_role_does_what_it_may_and_the_audit_log_names_who_did_it(
    accounts: Accounts, still: tuple[Browser, Path]
) -> None:
    fleet = Fleet(still[1])
    app = server_of(accounts, fleet=fleet)
    name = fleet.begin(inputs(), FAST)
    paths = app.openapi()["paths"]
    live = [(path.removeprefix("/api/v1"), way) for path in paths for way in paths[path] if "/missions" in path]
    assert len(live) >= 9
    for role in Role:
        visitor = logged_in(app, accounts, role)
        for path, way in live:
            address = path.replace("{name}", name).replace("{image}", "x.png")
            body = None if way == "get" else {"command": "pause"} if path.endswith("commands") else {"xml": BODY["xml"]}
            answer = visitor.call(way.upper(), address, body)
            least = LEAST.get(f"{way} {path}", Role.VIEWER)
            allowed = tuple(Role).index(role) >= tuple(Role).index(least)
            assert (answer.status_code not in (401, 403)) is allowed, (role, way, path, answer.text)
            assert Visitor(app).call(way.upper(), address, body).status_code == 401
    done = [(entry.who, entry.what, entry.about) for entry in accounts.audit.entries() if entry.what == "pause"]
    assert done == [("Admin", "pause", name), ("Approver", "pause", name)]


def test_an_account_approves_under_its_own_name(accounts: Accounts, still: tuple[Browser, Path]) -> None:
    folder = still[1]
    ada = logged_in(server_of(accounts, fleet=Fleet(folder)), accounts, Role.APPROVER, "Ada")
    assert ada.call("POST", "/missions", BODY).status_code == 403
    answer = ada.call("POST", "/missions", {**BODY, "approved_by": "Ada"})
    assert answer.status_code == 201, answer.text
    assert missions.open_mission(folder / answer.json()["id"]).authorized.authorization.by == "Ada"
    (entry,) = [e for e in accounts.audit.entries() if e.what == "approve and begin"]
    assert (entry.who, entry.about) == ("Ada", answer.json()["id"])
