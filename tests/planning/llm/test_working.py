"""Work along paths from a model: the action of an implement only in a work-along, problems of places sent back."""

from __future__ import annotations

import pytest

from fieldhand.planning.planner import Planned
from fieldhand.robot.loader import load_robot
from fieldhand.site.loader import open_site
from fieldhand.testing.scripted_chat import ScriptedChat, planner_of, task_document
from planning.english.outlines import outline

ROWS = '<work-along words="{}"><spray rate_l_ha="300"/><along><rows first="3" last="8"/></along></work-along>'


@pytest.mark.parametrize(
    ("request_", "plan", "expected"),
    [
        ("Spray rows 3 to 8 at 300 l/ha", ROWS.format("Spray rows 3 to 8 at 300 l/ha"),
         "spray rows Rows(3, 8), rate_l_ha 300"),
        ("Mow every second aisle",
         '<work-along mode="aisles" every="2" words="Mow every second aisle"><mow/><along><all-trees/></along>'
         "</work-along>", "mow aisles Trees, every 2"),
        ("Mow the wet corner",
         '<work-along mode="area" words="Mow the wet corner"><mow/><along><in-zone zone="wet corner"/></along>'
         "</work-along>", "mow area InZone(wet corner)"),
        ("Patrol around the pond twice",
         '<work-along mode="perimeter" laps="2" words="Patrol around the pond twice"><along><in-zone zone="pond"/>'
         "</along></work-along>", "drive perimeter InZone(pond), 2 laps"),
    ],
)  # fmt: skip
def test_an_answer_with_work_along_becomes_a_task(request_: str, plan: str, expected: str) -> None:
    chat = ScriptedChat(task_document(plan.replace("all-trees", "trees")))
    planned = planner_of(chat).plan(request_, open_site("demo"), load_robot("tractor"))
    assert isinstance(planned, Planned), chat.prompts[-1]
    assert outline(planned.task) == expected


@pytest.mark.parametrize(
    ("wrong", "problem"),
    [
        ('<act words="Spray rows 3 to 8"><spray/><at><tree-is tree="4"/></at></act>', "spray"),
        ('<work-along words="Spray rows 3 to 8"><take_picture/><along><rows first="3" last="8"/></along></work-along>',
         "take_picture"),
        ('<work-along mode="area" words="Spray rows 3 to 8"><spray/><along><in-zone zone="meadow"/></along>'
         "</work-along>", "meadow"),
    ],
)  # fmt: skip
def test_a_wrong_use_goes_back_to_the_model_with_its_problem(wrong: str, problem: str) -> None:
    right = ROWS.format("Spray rows 3 to 8").replace(' rate_l_ha="300"', "")
    chat = ScriptedChat(task_document(wrong), task_document(right))
    planned = planner_of(chat).plan("Spray rows 3 to 8", open_site("demo"), load_robot("tractor"))
    assert problem in chat.prompts[1]
    assert isinstance(planned, Planned)
    assert outline(planned.task) == "spray rows Rows(3, 8)"


def test_the_prompt_says_which_actions_are_for_work_along() -> None:
    chat = ScriptedChat("<refusal>no</refusal>")
    planner_of(chat).plan("Spray rows 3 to 8", open_site("demo"), load_robot("tractor"))
    lines = chat.prompts[0].splitlines()
    assert [line.split(":")[0] for line in lines if "only in a work-along" in line] == ["- mow", "- spray", "- film"]
