"""LlmPlanner over real HTTP: what comes of an answer, what goes back to the model, and that the loop ends."""

from __future__ import annotations

import json
from dataclasses import replace
from pathlib import Path

import pytest

from fieldhand.approval.account import unaccounted
from fieldhand.errors import ModelError, OutputError, RequestError
from fieldhand.places.selectors import Corners
from fieldhand.planning.homeward import faulted_exits
from fieldhand.planning.llm.planner import LONGEST_REQUEST, LlmPlanner
from fieldhand.planning.llm.replay import replay
from fieldhand.planning.llm.scripted import ScriptedAnswer, ScriptedEndpoint
from fieldhand.planning.llm.transcript import read_transcript
from fieldhand.planning.planner import Answer, Clarify, Outcome, Planned, Refused
from fieldhand.robot.loader import load_robot
from fieldhand.task.codec import decode, encode
from fieldhand.task.plan import Act, walk
from support.sites.grids import grid

SITE, HUSKY = grid(4, 6), load_robot("husky")
REQUEST = "Take a picture at  the corners,\nand come home. Use at most 50 % of the battery."

GOOD = """<task xmlns="urn:fieldhand:task:1">
  <command>
    <request>something else</request>
    <assumptions><assumption>All four corners are meant.</assumption></assumptions>
  </command>
  <task-composition>
    <plan>
      <for-each id="mine" said="0-3"><select><corners/></select>
        <body><act reading="r"><take_thermal_picture/></act></body>
      </for-each>
    </plan>
    <exits nominal="return_to_start"/>
  </task-composition>
  <constraints><budget kind="energy_percent" limit="50"/></constraints>
</task>"""
NO_ZONE = GOOD.replace("<corners/>", '<in-zone zone="pond"/>')
NO_ACTION = GOOD.replace("take_thermal_picture", "paint_tree")


def ask(*answers: ScriptedAnswer | str, request: str = REQUEST, transcript: Path | None = None) -> Outcome:
    with ScriptedEndpoint(answers) as endpoint:
        outcome = LlmPlanner(endpoint.settings(), transcript).plan(request, SITE, HUSKY)
        assert endpoint.unused == 0
    return outcome


@pytest.mark.parametrize("wrap", ["{}", "Sure!\n```xml\n{}\n```\nHave fun.", "<think>corners...</think>{}"])
def test_a_good_answer_becomes_a_whole_task(wrap: str) -> None:
    planned = ask(wrap.format(GOOD))
    assert isinstance(planned, Planned)
    assert planned.planner == "llm:scripted"
    task = planned.task
    assert task.command.request == REQUEST
    assert task.command.assumptions == ("All four corners are meant.",)
    assert [g.action for g in task.command.goals] == ["take_thermal_picture"]
    assert [(v.name, v.quantity) for v in task.command.variables] == [("r", "canopy_temperature")]
    assert task.composition.plan.id == "n1"
    assert task.composition.plan.said == ()
    assert getattr(task.composition.plan, "select", None) == Corners()
    assert (task.composition.nominal, task.composition.faulted) == ("return_to_start", faulted_exits("return_to_start"))
    assert [b.limit for b in task.constraints.budgets] == [50.0]
    assert {(r.kind, r.sha256) for r in task.resources} == {("site", SITE.sha256), ("robot", HUSKY.sha256)}
    assert decode(encode(task)) == task


QUOTED = GOOD.replace("<command>", '<command words="please">').replace("<for-each", '<for-each words="the  Corners"')
QUOTED = QUOTED.replace('<act reading="r">', '<act words="Take a picture | at">').replace(
    "<exits", '<exits words="come home"'
)
QUOTED = QUOTED.replace("<budget", '<budget words="at most half"')


def test_quoted_words_are_found_in_the_request_whatever_their_case_and_white_space() -> None:
    request = "Please take a picture at the\n corners at most half the battery, then come home."
    planned = ask(QUOTED, request=request)
    assert isinstance(planned, Planned)
    task = planned.task
    each, act = walk(task.composition.plan)
    spans = (each.said, act.said, task.command.no_part, task.composition.nominal_said, task.constraints.budgets[0].said)
    assert [[request[start:end] for start, end in said] for said in spans] == [
        ["the\n corners"],
        ["take a picture", "at"],
        ["Please"],
        ["come home"],
        ["at most half"],
    ]
    assert [problem.what for problem in unaccounted(task)] == ["nothing in the plan corresponds to 'battery'"]


def test_words_that_stand_twice_are_found_in_their_order() -> None:
    each = '<act words="picture"><take_thermal_picture/><at><first/></at></act>'
    twice = GOOD[: GOOD.index("<plan>")] + f"<plan><sequence>{each * 3}</sequence></plan></task-composition></task>"
    planned = ask(twice, request="A picture, then a picture.")
    assert isinstance(planned, Planned)
    said = [node.said for node in walk(planned.task.composition.plan) if isinstance(node, Act)]
    assert said == [((2, 9),), ((18, 25),), ((18, 25),)]


def test_words_that_the_request_does_not_say_go_back_to_the_model() -> None:
    with ScriptedEndpoint([GOOD.replace("<for-each", '<for-each words="every vine"'), GOOD]) as endpoint:
        assert isinstance(LlmPlanner(endpoint.settings()).plan(REQUEST, SITE, HUSKY), Planned)
        assert "[words] line 8 <for-each>: the request does not say 'every vine'" in endpoint.requests[1].text


def test_an_answer_follows_its_question_and_stands_among_the_assumptions(tmp_path: Path) -> None:
    given = Answer(question="Which corner?", answer="the <northern> one")
    path = tmp_path / "said.jsonl"
    with ScriptedEndpoint([GOOD]) as endpoint:
        planned = LlmPlanner(endpoint.settings(), path).plan(REQUEST, SITE, HUSKY, (given,))
        asked = endpoint.requests[0].text
    assert isinstance(planned, Planned)
    assert asked.index(REQUEST) < asked.index("Which corner?") < asked.index("the <northern> one")
    assert str(given) in planned.task.command.assumptions
    (session,) = read_transcript(path)
    assert replay(session, SITE, HUSKY) == planned


def test_a_question_becomes_a_clarification() -> None:
    outcome = ask("<question>Which corner?<choice>north</choice><choice>south</choice></question>")
    assert outcome == Clarify(question="Which corner?", choices=("north", "south"), planner="llm:scripted", free=True)


def test_a_refusal_becomes_a_refusal() -> None:
    outcome = ask("<refusal>It has no brush.</refusal>")
    assert isinstance(outcome, Refused)
    assert [r.what for r in outcome.reasons] == ["It has no brush."]
    assert outcome.planner == "llm:scripted"


@pytest.mark.parametrize(
    ("bad", "told"),
    [
        (NO_ACTION, "paint_tree"),
        (NO_ZONE, "pond"),
        (GOOD.replace("</for-each>", ""), "[schema] line"),
        (GOOD[: len(GOOD) // 2], "cut off"),
        (ScriptedAnswer(text=GOOD[: len(GOOD) // 2], finish="length"), "cut off"),
        ("", "empty"),
        ("I would be happy to help!", "neither"),
    ],
    ids=["unknown action", "unknown zone", "malformed", "half", "half and said so", "empty", "prose"],
)
def test_the_model_is_told_what_is_wrong_and_may_mend_it(bad: ScriptedAnswer | str, told: str) -> None:
    with ScriptedEndpoint([bad, GOOD]) as endpoint:
        outcome = LlmPlanner(endpoint.settings()).plan(REQUEST, SITE, HUSKY)
    assert isinstance(outcome, Planned)
    messages = endpoint.requests[1].body["messages"]
    assert [m["role"] for m in messages] == ["system", "user", "assistant", "user"]
    assert told in messages[-1]["content"]
    assert all(m["content"] for m in messages)
    assert messages[:2] == endpoint.requests[0].body["messages"]


def test_every_problem_of_an_answer_is_told_at_once() -> None:
    plan = '<sequence><go-to><tree-is tree="999"/></go-to><go-to><in-zone zone="pond"/></go-to></sequence>'
    bad = GOOD[: GOOD.index("<for-each")] + plan + GOOD[GOOD.index("</for-each>") + len("</for-each>") :]
    with ScriptedEndpoint([bad, GOOD]) as endpoint:
        LlmPlanner(endpoint.settings()).plan(REQUEST, SITE, HUSKY)
    told = endpoint.requests[1].body["messages"][-1]["content"]
    assert "999" in told
    assert "pond" in told


def test_a_model_that_never_mends_it_is_asked_four_times_and_no_more(tmp_path: Path) -> None:
    path = tmp_path / "t.jsonl"
    with ScriptedEndpoint([NO_ZONE], repeat_last=True) as endpoint:
        with pytest.raises(ModelError) as caught:
            LlmPlanner(endpoint.settings(), path).plan(REQUEST, SITE, HUSKY)
        assert len(endpoint.requests) == 4
    assert "none of 4 answers" in caught.value.what
    assert "pond" in caught.value.what
    assert "llm:scripted" in caught.value.where
    assert str(path) in caught.value.advice
    assert "last try" in endpoint.requests[3].body["messages"][-1]["content"]
    (session,) = read_transcript(path)
    assert session.outcome == "failed"
    assert [len(e.problems) for e in session.exchanges] == [1, 1, 1, 1]


def test_an_answer_that_is_always_cut_off_advises_more_tokens() -> None:
    cut = ScriptedAnswer(text=GOOD[:200], finish="length")
    with ScriptedEndpoint([cut], repeat_last=True) as endpoint, pytest.raises(ModelError) as caught:
        LlmPlanner(endpoint.settings()).plan(REQUEST, SITE, HUSKY)
    assert "FIELDHAND_MODEL_MAX_TOKENS" in caught.value.advice


def test_every_exchange_is_in_the_transcript_and_no_key_is(tmp_path: Path) -> None:
    path = tmp_path / "t.jsonl"
    ask(NO_ACTION, GOOD, transcript=path)
    (session,) = read_transcript(path)
    assert (session.request, session.outcome, session.about["planner"]) == (REQUEST, "planned", "llm:scripted")
    assert session.about["site"] == {"name": SITE.name, "sha256": SITE.sha256}
    assert [e.answer for e in session.exchanges] == [NO_ACTION, GOOD]
    assert [[m.role for m in e.messages] for e in session.exchanges] == [["system", "user"], ["user"]]
    assert "paint_tree" in session.exchanges[0].problems[0]
    assert session.exchanges[1].problems == ()
    text = path.read_text(encoding="utf-8")
    assert "scripted-key" not in text
    assert all(json.loads(line)["at"] for line in text.splitlines())


def test_a_failure_of_the_endpoint_ends_the_session_in_the_transcript(tmp_path: Path) -> None:
    path = tmp_path / "t.jsonl"
    with pytest.raises(ModelError, match="refused the key"):
        ask(ScriptedAnswer(status=401, text="bad key scripted-key"), transcript=path)
    assert read_transcript(path)[0].outcome == "failed"
    assert "scripted-key" not in path.read_text(encoding="utf-8")


def test_an_unwritable_transcript_is_said_before_the_model_is_asked(tmp_path: Path) -> None:
    with ScriptedEndpoint([GOOD]) as endpoint:
        with pytest.raises(OutputError):
            LlmPlanner(endpoint.settings(), tmp_path).plan(REQUEST, SITE, HUSKY)
        assert not endpoint.requests


@pytest.mark.parametrize("request_", ["", " \n\t", "x" * (LONGEST_REQUEST + 1), "x" * 100_000])
def test_a_request_that_cannot_be_one_is_never_sent(request_: str) -> None:
    with ScriptedEndpoint([GOOD]) as endpoint:
        with pytest.raises(RequestError) as caught:
            LlmPlanner(endpoint.settings()).plan(request_, SITE, HUSKY)
        assert not endpoint.requests
    assert caught.value.advice
    assert len(str(caught.value)) < 300


def test_the_same_answer_makes_the_same_task() -> None:
    assert ask(GOOD) == ask("once more:\n" + GOOD)


def test_repairs_can_be_switched_off() -> None:
    with ScriptedEndpoint([NO_ZONE], repeat_last=True) as endpoint:
        settings = replace(endpoint.settings(), repairs=0)
        with pytest.raises(ModelError, match="none of 1 answers"):
            LlmPlanner(settings).plan(REQUEST, SITE, HUSKY)
        assert len(endpoint.requests) == 1


def test_a_word_that_is_said_twice_is_found_where_no_other_quote_stands() -> None:
    request = "Check CO2 at tree 4; if it is above 450 ppm, check the trees next to it."
    answer = """<task><task-composition><plan><sequence>
      <act reading="a" words="check co2 at tree 4"><read_co2/><at><tree-is tree="4"/></at></act>
      <if words="if it is above 450 ppm">
        <condition><compare reading="a" test="gt"><co2 value="450" unit="ppm"/></compare></condition>
        <then><for-each words="the trees next to it">
          <select><nearest count="2" adjacent="true"><to><tree-is tree="4"/></to></nearest></select>
          <body><act words="check"><read_co2/></act></body>
        </for-each></then>
      </if>
    </sequence></plan></task-composition></task>"""
    planned = ask(answer, request=request)
    assert isinstance(planned, Planned)
    assert unaccounted(planned.task) == ()
