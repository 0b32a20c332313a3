"""Approval is a type, and this room alone makes it."""

from __future__ import annotations

import ast
import hashlib
from dataclasses import replace
from pathlib import Path

import pytest

import fieldhand
from fieldhand.approval.authorize import EveryWarning, approve
from fieldhand.approval.checks import check, examine
from fieldhand.errors import NotApprovedError, NotConfirmedError
from fieldhand.places.selectors import TreeIs
from fieldhand.task.codec import decode, encode
from fieldhand.task.plan import Act
from fieldhand.testing.small_orchard import husky, orchard, task_for

SITE, ROBOT = orchard(), husky()
GOOD = task_for(SITE, Act(id="", action="read_co2", at=TreeIs(tree="1")))
BAD = task_for(SITE, Act(id="", action="read_co2", at=TreeIs(tree="99")))
_PLAIN = task_for(
    SITE, Act(id="", action="read_co2", at=TreeIs(tree="1"), said=((0, 30),)), "Take 3 CO2 readings at tree 1."
)
DOUBTED = replace(_PLAIN, command=replace(_PLAIN.command, warnings=("read by a model",)))
WHEN = "2026-05-01T08:00:00+02:00"


def test_an_approved_task_carries_who_when_and_the_hashes_of_what():
    approved = approve(examine(GOOD, SITE, ROBOT), by="Ada", at=WHEN)
    authorization = approved.authorization
    assert approved.task == GOOD
    assert (authorization.by, authorization.at, authorization.confirmed) == ("Ada", WHEN, ())
    assert authorization.task_sha256 == hashlib.sha256(encode(GOOD)).hexdigest()
    assert (authorization.site_sha256, authorization.robot_sha256) == (SITE.sha256, ROBOT.sha256)


def test_a_task_with_an_error_is_not_approved_and_says_why():
    with pytest.raises(NotApprovedError, match="99"):
        approve(examine(BAD, SITE, ROBOT), by="Ada", at=WHEN)


def test_a_task_is_approved_once_each_of_its_warnings_is_confirmed_and_they_are_kept():
    read = decode(encode(DOUBTED))  # as it comes out of a file: nobody knows who planned it
    warnings = [str(p) for p in check(read, SITE, ROBOT) if p.severity == "warning"]
    assert any("read by a model" in w for w in warnings)
    assert any("this may not be what was asked" in w and "'3 co2 readings'" in w for w in warnings)
    for confirmed in ((), warnings[1:], warnings[:-1], ["the gate is narrow"], [w.upper() for w in warnings]):
        with pytest.raises(NotConfirmedError) as refused:
            approve(examine(read, SITE, ROBOT), by="Ada", at=WHEN, confirmed=confirmed)
        assert set(refused.value.warnings) == set(warnings) - set(confirmed)
    approved = approve(examine(read, SITE, ROBOT), by="Ada", at=WHEN, confirmed=[*warnings, "the gate is narrow"])
    assert approved.authorization.confirmed == tuple(warnings)
    assert approve(examine(read, SITE, ROBOT), by="Ada", at=WHEN, confirmed=EveryWarning()) == approved


def test_an_error_is_not_to_be_confirmed():
    with pytest.raises(NotApprovedError, match="99") as refused:
        approve(examine(BAD, SITE, ROBOT), by="Ada", at=WHEN, confirmed=EveryWarning())
    assert not isinstance(refused.value, NotConfirmedError)


@pytest.mark.parametrize(("by", "at"), [("", WHEN), ("  ", WHEN), ("Ada", "yesterday"), ("Ada", "2026-05-01T08:00:00")])
def test_nobody_and_no_moment_approve_nothing(by, at):
    with pytest.raises(NotApprovedError):
        approve(examine(GOOD, SITE, ROBOT), by=by, at=at)


def test_no_other_module_makes_an_authorized_task():
    root = Path(fieldhand.__file__).parent
    makers = {str(path.relative_to(root)) for path in root.rglob("*.py") if _makes(path)}
    assert makers == {"approval/authorize.py"}


def _makes(path: Path) -> bool:
    """Return True if a module calls the class, or passes it on under another name."""
    text = path.read_text(encoding="utf-8")
    if "AuthorizedTask" not in text:
        return False
    tree = ast.parse(text)
    named = {
        alias.asname or alias.name
        for node in ast.walk(tree)
        if isinstance(node, ast.ImportFrom)
        for alias in node.names
        if alias.name == "AuthorizedTask"
    }
    for node in ast.walk(tree):
        if isinstance(node, ast.Call):
            called = node.func
            name = called.id if isinstance(called, ast.Name) else getattr(called, "attr", "")
            if name in named | {"AuthorizedTask"}:
                return True
    return False
