"""A plan says what the approver has to know, and its words, its map and its document speak of the same nodes."""

from __future__ import annotations

import json
from itertools import pairwise
from typing import Any

import pytest

from fieldhand.places.selectors import TreeIs
from fieldhand.planning.english.planner import EnglishPlanner
from fieldhand.planning.planner import Clarify, Planned, Reason, Refused
from fieldhand.robot.model import RobotProfile
from fieldhand.site.loader import load_demo
from fieldhand.site.model import Site
from fieldhand.task.codec import decode
from fieldhand.task.plan import Act, walk
from support.processes.browser import Says, browser, corner_xml, task_of


@pytest.fixture(scope="module")
def planned() -> dict[str, Any]:
    answer: dict[str, Any] = browser().post("/api/plan", {"request": "corners"}).json()
    assert answer["outcome"] == "planned"
    return answer


def of_role(answer: dict[str, Any], role: str) -> list[dict[str, Any]]:
    return [f for f in answer["map"]["features"] if f["properties"]["role"] == role]


def test_the_document_is_the_task_of_which_the_words_speak(planned: dict[str, Any]) -> None:
    task = decode(planned["xml"].encode())
    ids = {node.id for node in walk(task.composition.plan)}
    assert task.id == planned["task"]
    assert {line["node"] for line in planned["read_back"]["lines"]} <= ids
    assert {node for stop in of_role(planned, "stop") for node in stop["properties"]["nodes"]} <= ids
    assert {leg["properties"]["node"] for leg in of_role(planned, "path")} <= ids


def test_the_legs_where_every_condition_holds_are_one_way_from_the_start_to_the_end(planned: dict[str, Any]) -> None:
    site = load_demo()
    legs = [f["geometry"]["coordinates"] for f in of_role(planned, "path") if not f["properties"]["branch"]]
    assert all(one[-1] == other[0] for one, other in pairwise(legs))
    ends = (site.markers["start"], site.markers["end"])
    for (lon, lat), place in zip((legs[0][0], legs[-1][-1]), ends, strict=True):
        assert (lon, lat) == pytest.approx((place.lon, place.lat), abs=2e-7)


def test_stops_are_numbered_in_order_and_stand_at_their_trees(planned: dict[str, Any]) -> None:
    site = load_demo()
    stops = of_role(planned, "stop")
    assert [s["properties"]["number"] for s in stops] == list(range(1, len(stops) + 1))
    for stop in stops:
        place = site.by_id[stop["properties"]["place"]].place
        assert stop["geometry"]["coordinates"] == pytest.approx([place.lon, place.lat], abs=1e-7)


def test_what_happens_on_some_branches_alone_is_marked() -> None:
    request = "corners"
    answer = browser().post("/api/plan", {"request": request}).json()
    # On the first branch the reading is hot at every corner; without the neighbours the way is another one.
    assert any(leg["properties"]["branch"] for leg in of_role(answer, "path"))
    assert not any(stop["properties"]["branch"] for stop in of_role(answer, "stop")[:4])


def test_a_plan_that_cannot_be_approved_says_why_and_still_shows_the_site() -> None:
    def unknown_tree(request: str, site: Site, robot: RobotProfile) -> Planned:
        act = Act(id="", action=robot.actions[0].name, at=TreeIs(tree="no such tree"))
        return Planned(task=task_of(act, request, site, robot), planner="hand")

    answer = browser(Says(outcome=unknown_tree)).post("/api/plan", {"request": "corners"}).json()
    assert not answer["approvable"]
    assert any("no such tree" in p["what"] for p in answer["problems"]), answer["problems"]
    assert len(of_role(answer, "tree")) == len(load_demo().trees)
    assert not of_role(answer, "stop")


def test_a_question_is_passed_on_with_its_choices() -> None:
    asks = Says(outcome=lambda r, s, p: Clarify(question="Which end?", choices=("the north end", "the south end")))
    answer = browser(asks).post("/api/plan", {"request": "the end"}).json()
    assert answer["outcome"] == "clarify"
    assert (answer["question"], answer["choices"]) == ("Which end?", ["the north end", "the south end"])


def test_an_answer_to_a_question_leads_to_the_plan() -> None:
    web = browser(EnglishPlanner())
    body = {"request": "take a picture of row 3"}
    asked = web.post("/api/plan", body).json()
    answer = {"question": asked["question"], "answer": asked["choices"][1]}
    planned = web.post("/api/plan", {**body, "answers": [answer]}).json()
    assert planned["outcome"] == "planned"
    assert any(answer["answer"] in text for text in planned["read_back"]["assumptions"])
    assert web.post("/api/plan", {**body, "answers": [{"question": "?"}]}).status_code == 422


def test_the_places_of_each_choice_are_on_the_map_with_its_number() -> None:
    asked = browser(EnglishPlanner()).post("/api/plan", {"request": "take a picture of row 3"}).json()
    every, four = asked["places"]
    marked = {f["properties"]["place"]: f["properties"]["numbers"] for f in of_role(asked, "choice")}
    assert set(marked) == set(every)
    assert {place for place, numbers in marked.items() if numbers[0] == 2} == set(four)
    assert len(of_role(asked, "tree")) == len(load_demo().trees)


def test_the_request_comes_in_pieces_with_what_became_of_each() -> None:
    request = "Please take a picture of tree 4."
    words = browser(EnglishPlanner()).post("/api/plan", {"request": request}).json()["words"]
    assert "".join(piece["text"] for piece in words) == request
    assert {(piece["role"], piece["text"]) for piece in words} >= {("no_part", "Please"), ("place", "tree 4")}


def test_a_refusal_says_which_words_and_does_not_read_them_as_markup() -> None:
    request = "<img src=x onerror=alert(1)> dance"
    reason = Reason(what=f"'{request}' was not understood", said=((29, 34),), advice="say what to measure")
    refuses = Says(outcome=lambda r, s, p: Refused(reasons=(reason,), planner="english"))
    answer = browser(refuses).post("/api/plan", {"request": request})
    assert answer.headers["content-type"] == "application/json"
    (said,) = answer.json()["reasons"]
    assert [request[a:b] for a, b in said["said"]] == ["dance"]
    assert said["what"] == reason.what


def test_the_english_planner_plans_without_any_model() -> None:
    from fieldhand.planning.english.planner import EnglishPlanner

    answer = (
        browser(EnglishPlanner()).post("/api/plan", {"request": "Take pictures of the 3 northernmost trees."}).json()
    )
    assert answer["outcome"] == "planned"
    assert len(of_role(answer, "stop")) == 3


def test_the_english_planner_points_at_what_it_did_not_understand() -> None:
    from fieldhand.planning.english.planner import EnglishPlanner

    request = "Take a picture of the northernmost tree and sing loudly."
    answer = browser(EnglishPlanner()).post("/api/plan", {"request": request}).json()
    assert answer["outcome"] == "refused"
    assert any("sing" in request[a:b] for reason in answer["reasons"] for a, b in reason["said"])


@pytest.mark.parametrize(
    ("body", "where"),
    [
        ({}, "request"),
        ({"request": 7}, "request"),
        ({"request": "x", "planner": "oracle"}, "planner"),
        ({"request": "x", "robot": ["husky"]}, "robot"),
        ({"request": "x" * 20_001}, "request"),
        ({"request": "x", "transcript": "x.jsonl"}, "transcript"),
        ({"request": "\ud800"}, "request"),
    ],
)
def test_a_fault_of_shape_names_its_place(body: dict[str, Any], where: str) -> None:
    answer = browser().call("POST", "/api/plan", content=json.dumps(body), headers={"content-type": "application/json"})
    assert answer.status_code == 422
    assert answer.json()["where"] == where


def test_an_empty_request_is_a_problem() -> None:
    answer = browser().post("/api/plan", {"request": "  "})
    assert answer.status_code == 400
    assert "empty" in answer.json()["what"]


def test_a_checked_document_is_reviewed_as_it_was_planned(planned: dict[str, Any]) -> None:
    checked = browser().post("/api/check", {"xml": planned["xml"]}).json()
    assert checked["outcome"] == "checked"
    for part in ("task", "approvable", "warnings", "problems", "read_back", "estimate", "map"):
        assert checked[part] == planned[part]


BOMB = '<!DOCTYPE t [<!ENTITY a "aaaaaaaaaa"><!ENTITY b "&a;&a;&a;&a;">]><task>&b;</task>'
OUTSIDE = '<!DOCTYPE t [<!ENTITY a SYSTEM "file:///etc/hostname">]><task>&a;</task>'


@pytest.mark.parametrize("xml", ["", "<task", "<task/>", BOMB, OUTSIDE, corner_xml().replace("take_thermal", "take_x")])
def test_a_document_that_is_no_task_of_this_robot_is_a_problem(xml: str) -> None:
    answer = browser().post("/api/check", {"xml": xml})
    assert answer.status_code == 400
    assert answer.json()["where"].startswith("xml")


def test_a_plan_is_read_back_in_the_language_that_was_asked_for() -> None:
    web = browser(EnglishPlanner())
    body = {"request": "Take a picture of tree 4.", "lang": "es"}
    planned = web.post("/api/plan", body).json()
    assert planned["language"] == "es"
    assert planned["read_back"]["lines"][0]["text"] == "En el árbol 4: tomar una fotografía térmica."
    assert planned["headings"]["assumptions"] == "Se supone"
    assert [piece["name"] for piece in planned["words"] if piece["name"]] == ["acción", "lugar"]
    checked = web.post("/api/check", {"xml": planned["xml"], "lang": "es"}).json()
    assert checked["read_back"] == planned["read_back"]
    english = web.post("/api/check", {"xml": planned["xml"]}).json()
    assert english["read_back"]["lines"][0]["text"] == "At tree 4: take a thermal picture."
    assert web.post("/api/plan", {**body, "lang": "xx"}).status_code == 422


def test_the_approval_says_in_which_language_it_was_read() -> None:
    body = {"request": "Take a picture of tree 4.", "lang": "es", "approved_by": "Ana", "planner": "english"}
    assert browser(EnglishPlanner()).post("/api/run", body).json()["authorization"]["language"] == "es"


def test_words_of_places_name_the_nodes_of_their_stops() -> None:
    request = "Measure CO2 at the four corner trees and take a picture of tree 50."
    plan = browser(EnglishPlanner()).post("/api/plan", {"request": request}).json()
    nodes = {piece["text"]: set(piece["nodes"]) for piece in plan["words"] if piece["role"] == "place"}
    stops = [f["properties"] for f in plan["map"]["features"] if f["properties"]["role"] == "stop"]
    found = {text: {s["place"] for s in stops if own & set(s["nodes"])} for text, own in nodes.items()}
    assert found == {"four corner trees": {"1", "19", "152", "169"}, "tree 50": {"50"}}
    assert all(piece["nodes"] == [] for piece in plan["words"] if piece["role"] == "between")


def test_questions_and_refusals_are_shown_in_the_language_asked_for() -> None:
    api = browser(EnglishPlanner())
    body = {"request": "Photograph row 15.", "site": "vineyard", "lang": "es"}
    question = api.post("/api/plan", body).json()
    assert question["shown"]["question"] != question["question"]
    assert len(question["shown"]["choices"]) == len(question["choices"]) == 2
    assert all(choice.startswith("En cada uno") for choice in question["shown"]["choices"])
    # What is sent back is what was asked in English.
    answer = {"question": question["question"], "answer": question["choices"][0]}
    assert api.post("/api/plan", {**body, "answers": [answer]}).json()["outcome"] == "planned"
    refusal = api.post("/api/plan", {"request": "Spray the oldest trees.", "lang": "es"}).json()
    assert "no puede" in refusal["reasons"][0]["what"]
