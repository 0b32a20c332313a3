"""The API plans by earlier missions whose event logs the client sends; the server keeps none."""

from __future__ import annotations

from typing import Any

import pytest

from fieldhand.places.selector import Selector
from fieldhand.places.selectors import DoneEarlier, Excluding, Rows, TopEarlier
from fieldhand.robot.loader import load_robot
from fieldhand.site.model import Site
from fieldhand.task.codec import encode
from fieldhand.task.plan import Act, ForEach
from support.processes.browser import Browser, browser, task_of

SITE, ROBOT = Site.demo(), load_robot("husky")


def xml(select: Selector, action: str = "read_co2") -> str:
    plan = ForEach(id="", select=select, body=Act(id="", action=action))
    return encode(task_of(plan, "Skip those done.", SITE, ROBOT)).decode()


def run(web: Browser, document: str, **body: Any) -> dict[str, Any]:
    checked = web.post("/api/check", {"xml": document, **body}).json()
    answer = web.post("/api/run", {"xml": document, "approved_by": "Ana", "confirmed": checked["warnings"], **body})
    assert answer.status_code == 200, answer.text
    result: dict[str, Any] = answer.json()
    return result


def places(answer: dict[str, Any]) -> set[str]:
    return {event["place"] for event in answer["events"] if event["event"] == "action"}


def test_a_mission_skips_what_the_one_before_did() -> None:
    web = browser()
    row = Rows(first="1", last="1")
    first = run(web, xml(row))
    rest = Excluding(places=DoneEarlier(action="read_co2"), of=Rows(first="1", last="2"))
    second = run(web, xml(rest), earlier=[first["events"]])
    assert places(first)
    assert places(second)
    assert not places(first) & places(second)
    hottest = run(web, xml(TopEarlier(quantity="co2", count=2)), earlier=[first["events"], second["events"]])
    assert len(places(hottest)) == 2
    assert places(hottest) <= places(first) | places(second)


def test_without_logs_a_task_that_needs_them_is_not_approvable() -> None:
    answer = browser().post("/api/check", {"xml": xml(TopEarlier(quantity="co2"))})
    assert answer.status_code == 200
    assert not answer.json()["approvable"]


def test_no_logs_at_all_are_confirmed_as_nothing_done() -> None:
    rest = Excluding(places=DoneEarlier(action="read_co2"), of=Rows(first="1", last="1"))
    answer = browser().post("/api/check", {"xml": xml(rest), "earlier": []}).json()
    assert answer["approvable"]
    assert any("count as not done" in warning for warning in answer["warnings"])


@pytest.mark.parametrize(
    "logs",
    [
        "x",
        [[1]],
        [[{"event": "started"}]],
        [[{"event": "action", "t": "soon"}]],
        [[{"event": "action", "t": 1e308, "node": "n", "action": "a", "status": "success", "kind": "tree"}]],
        [[]] * 1001,
    ],
)
def test_bad_logs_are_refused_in_words(logs: object) -> None:
    answer = browser().post("/api/check", {"xml": xml(DoneEarlier()), "earlier": logs})
    assert answer.status_code in (400, 422)
    assert "Traceback" not in answer.text
