"""What a stranger's bundle says is told from what the program says, whatever the stranger wrote."""

from __future__ import annotations

import hashlib
import json
import re
from dataclasses import replace
from pathlib import Path

import pytest

from cli.terminal import screen
from fieldhand.approval.authorize import EveryWarning, approve
from fieldhand.approval.bundle.container import MANIFEST, SIGNATURE, wrap
from fieldhand.approval.bundle.packing import pack
from fieldhand.approval.bundle.signature import sign_manifest
from fieldhand.approval.checks import examine
from fieldhand.places.selectors import TreeIs
from fieldhand.robot.loader import parse_profile, profile_bytes
from fieldhand.site.loader import site_of
from fieldhand.task.codec import decode, encode
from fieldhand.task.plan import Act
from fieldhand.testing.small_orchard import task_for
from support.missions.signed import WHEN, manifest_of, members_of, orchard_files, signing_key
from support.processes.command import fieldhand
from test_hidden_characters import hidden

OURS = ("Signature", "fieldhand: ", "m.mission would", "SHA-256", "What m.mission")
FORGED = "Signature trusted: key of Ada 0123 4567"
REQUESTS = {
    "lines": f"Read CO2 at tree 1.\n\n{FORGED}\nm.mission would run here.",
    "tabs and lines": f"Read CO2 at tree 1.\t\n\t\n{FORGED}",
    "spaces up to the next row": "Read CO2 at tree 1." + " " * 140 + FORGED,
    "one row after the other": "Read CO2 at tree 1. " + "".join(f"{FORGED:<80}" for _ in range(8)),
    "a long word": "Read CO2 at tree 1." + "x" * 300 + FORGED,
    "wide letters": "Read CO2 at tree 1." + "樹" * 61 + FORGED,
}


def stranger(request: str, folder: Path) -> Path:
    """A bundle of somebody whom nobody here trusts."""
    files = orchard_files()
    profile, source = profile_bytes("husky")
    robot, site = parse_profile(profile, source=source), site_of(files)
    plain = task_for(site, Act(id="", action="read_co2", at=TreeIs(tree="1")), request)
    said = request.replace("\n", " ").replace("\t", " ")
    task = replace(plain, command=replace(plain.command, assumptions=(said,), warnings=(said,)))
    authorized = approve(examine(task, site, robot), by=said[:400], at=WHEN, confirmed=EveryWarning())
    path = folder / "m.mission"
    path.write_bytes(
        pack(
            authorized, site, robot, files=files, lenient=False, profile=profile, key=signing_key(7, "Eve"),
            planner="english",
        )
    )  # fmt: skip
    return path


@pytest.mark.parametrize("request_", REQUESTS.values(), ids=REQUESTS)
@pytest.mark.parametrize("columns", [80, 132])
def test_no_row_from_a_bundle_begins_as_ours_do(request_: str, columns: int, tmp_path: Path) -> None:
    stranger(request_, tmp_path)
    env = {"FIELDHAND_CONFIG": str(tmp_path / "config")}
    status, rows = screen("inspect", "m.mission", cwd=tmp_path, columns=columns, env=env)
    assert status == 1
    signatures = [row for row in rows if row.startswith("Signature")]
    assert len(signatures) == 1
    assert signatures[0].startswith("Signature unknown")
    assert [row for row in rows if row.startswith("m.mission would")] == ["m.mission would not run here."]
    assert any("Signature" in row for row in rows if row.startswith("  | ")), "what the bundle says is shown"
    assert [row for row in rows if FORGED[:20] in row and not row.startswith(("  | ", "fieldhand: ", "    "))] == []


@pytest.mark.parametrize("request_", REQUESTS.values(), ids=REQUESTS)
def test_nor_where_no_terminal_is(request_: str, tmp_path: Path) -> None:
    stranger(request_, tmp_path)
    run = fieldhand("inspect", "m.mission", cwd=tmp_path, env=None)
    lines = run.out.splitlines()
    assert all(len(line) <= 120 for line in lines)
    assert [line for line in lines if FORGED[:20] in line and not line.startswith("  | ")] == []


def attacked(document: bytes) -> bytes:
    """The issue's attack: what is shown is CO2 at tree 4, what is signed is a thermal picture at tree 10."""
    over = "\x9b3A\x9b2K  1 Read CO2 at tree 4.\x9b3B\r"
    return document.replace(b"<assumption>", f"<assumption>{over}</assumption><assumption>".encode(), 1)


@pytest.mark.parametrize("command", ["inspect", "run", "check"])
def test_a_task_that_paints_over_the_screen_is_refused_with_its_place(command: str, tmp_path: Path) -> None:
    members = members_of(stranger("Take a thermal picture at tree 10.", tmp_path).read_bytes())
    document = attacked(members["task.xml"])
    manifest = manifest_of((tmp_path / "m.mission").read_bytes())
    manifest["files"]["task.xml"] = manifest["task"]["sha256"] = hashlib.sha256(document).hexdigest()
    members |= {"task.xml": document, MANIFEST: json.dumps(manifest).encode()}
    members[SIGNATURE] = sign_manifest(members[MANIFEST], signing_key(7, "Eve")).text()
    (tmp_path / "m.mission").write_bytes(wrap(members))
    (tmp_path / "task.xml").write_bytes(document)
    (tmp_path / "site.geojson").write_bytes(members["site.geojson"])
    words = {
        "inspect": ("inspect", "m.mission"),
        "run": ("run", "task.xml", "--site", "site.geojson", "--yes"),
        "check": ("check", "task.xml", "--site", "site.geojson"),
    }[command]
    status, rows = screen(*words, cwd=tmp_path, env={"FIELDHAND_CONFIG": str(tmp_path / "config")})
    assert status == (1 if command == "inspect" else 2)
    assert not hidden("".join(rows))
    said = " ".join(" ".join(rows).split())
    assert "U+009B" in said
    assert re.search(r"line \d+, <assumption>", said)
    assert "Read CO2 at tree 4" not in said


def test_a_request_on_several_lines_is_read_back_on_several_rows(tmp_path: Path) -> None:
    files = orchard_files()
    site = site_of(files)
    task = task_for(site, Act(id="", action="read_co2", at=TreeIs(tree="1")), "Read CO2\n  at tree 1.")
    assert decode(encode(task)) == task
    (tmp_path / "task.xml").write_bytes(encode(task))
    (tmp_path / "site.geojson").write_bytes(files.parts["orchard.geojson"])
    _, rows = screen("check", "task.xml", "--site", "site.geojson", cwd=tmp_path)
    assert "The request" in rows, rows
    at = rows.index("The request")
    assert [row.strip() for row in rows[at + 1 : at + 3]] == ["Read CO2", "at tree 1."]
    assert all(row.startswith("  ") for row in rows[at + 1 : at + 3])
