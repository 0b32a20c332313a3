"""The agent reviews a mission once, for its start and its report."""

from __future__ import annotations

from dataclasses import replace

import pytest

from fieldhand import mission
from fieldhand.program.review_cache import ReviewCache
from support.missions.kept import inputs


def test_a_mission_is_reviewed_once_until_another_one_comes(monkeypatch: pytest.MonkeyPatch) -> None:
    given, cache, reviewed = inputs(), ReviewCache(), []
    monkeypatch.setattr(mission, "review", lambda task, *_: reviewed.append(task) or len(reviewed))
    first = cache.review(given.authorized, given.site, given.robot)
    assert cache.review(given.authorized, given.site, given.robot) == first == 1
    other = replace(given.authorized, authorization=replace(given.authorized.authorization, task_sha256="0" * 64))
    assert cache.review(other, given.site, given.robot) == 2
    assert cache.review(given.authorized, given.site, given.robot) == 3
