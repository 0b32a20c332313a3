"""HTML for notebooks: text is escaped, nothing is loaded from elsewhere, and long tables are cut."""

from __future__ import annotations

import re
from dataclasses import replace
from html.parser import HTMLParser

import pytest

import fieldhand as fh
from fieldhand.mission.records import Records

HOSTILE = "<script>alert(1)</script>\x1b[31m \u202e\" onload='x'"
ROBOT = fh.Robot.load("husky")
#: Elements that show text and pictures; none of them loads or runs anything by itself.
ELEMENTS = {"h4", "p", "pre", "ul", "li", "table", "thead", "tbody", "tr", "th", "td", "img"}


class Elements(HTMLParser):
    """Collects elements and attributes of a piece of HTML."""

    def __init__(self) -> None:
        super().__init__()
        self.names: set[str] = set()
        self.attributes: list[tuple[str, str | None]] = []

    def handle_starttag(self, tag: str, attrs: list[tuple[str, str | None]]) -> None:
        self.names.add(tag)
        self.attributes.extend(attrs)


def hostile_objects() -> dict[str, object]:
    """One object of each kind, of a site and a request whose words are hostile."""
    site = replace(fh.Site.demo(), name="<script>alert(1)</script>")  # a hidden character would forbid approval
    act = fh.steps.Act(action="read_co2", at=fh.selectors.TreeIs(tree="4"))
    plain = fh.build_task(act, site, ROBOT)
    task = replace(plain, command=replace(plain.command, request="<script>alert(2)</script> <img src=//x.example/y>"))
    review = fh.review(task, site, ROBOT)
    assert not review.errors
    mission = fh.authorize(review, by="Ada", confirmed=review.warnings)
    run = fh.simulate(mission, seed=1)
    return {
        "site": replace(site, name=HOSTILE),
        "plan": fh.Plan(task=task, planner="fixed", site=site, robot=ROBOT),
        "review": review,
        "run": run,
        "simulations": fh.fly_many(mission, 2),
        "events": run.events,
        "observations": run.observations,
        "records": Records([fh.Answer(question=HOSTILE, answer=HOSTILE)]),
    }


@pytest.fixture(scope="module")
def pages() -> dict[str, str]:
    return {name: value._repr_html_() for name, value in hostile_objects().items()}


def test_text_is_escaped_and_hidden_characters_are_shown(pages):
    for name, page in pages.items():
        assert "<script" not in page.lower(), name
        assert not re.search(r"[\x00-\x08\x0b-\x1f\u202a-\u202e\u2066-\u2069]", page), name
    for name in ("site", "records"):
        assert "&lt;script&gt;alert(1)&lt;/script&gt;" in pages[name]
    for name in ("plan", "review", "run"):
        assert "&lt;script&gt;alert(2)&lt;/script&gt;" in pages[name]


def test_nothing_is_loaded_and_nothing_runs(pages):
    for name, page in pages.items():
        found = Elements()
        found.feed(page)
        assert found.names <= ELEMENTS, name
        for attribute, value in found.attributes:
            assert attribute in ("alt", "style", "src"), (name, attribute)
            if attribute == "src":
                assert value.startswith(("data:image/png;base64,", "data:image/svg+xml;base64,")), name


def test_maps_are_shown_of_all_that_has_a_place(pages):
    assert {name for name, page in pages.items() if "<img" in page} == {"site", "plan", "review", "run"}


def test_a_long_table_is_cut_and_says_so():
    page = Records([fh.Answer(question=str(n), answer="x" * 100) for n in range(25)])._repr_html_()
    assert page.count("<tr>") == 21
    assert "5 more rows" in page
    assert "x" * 57 + "..." in page


def test_a_plan_that_cannot_be_approved_shows_why():
    site = fh.Site.demo()
    task = fh.build_task(fh.steps.Act(action="read_co2", at=fh.selectors.TreeIs(tree="9999")), site, ROBOT)
    page = fh.review(task, site, ROBOT)._repr_html_()
    assert "error: " in page
    assert "9999" in page
