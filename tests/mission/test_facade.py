"""The functions of ``fieldhand.mission``: one examination a mission, determinism, pickling, and refusals."""

from __future__ import annotations

import ast
import pickle
import re
from pathlib import Path

import numpy as np
import pytest
from hypothesis import given

import fieldhand as fh
from fieldhand import mission
from fieldhand.approval import checks
from fieldhand.errors import InputError, NotApprovedError, NotConfirmedError, RequestError, TaskError
from fieldhand.exchange.btcpp import write_tree
from fieldhand.execution.drivers.simulation.vehicle import simulation
from fieldhand.mission.records import Records
from fieldhand.robot.capabilities import capabilities_of
from fieldhand.testing.generated.tasks import ROVER, Parts

SITE, ROBOT = fh.Site.demo(), fh.Robot.load("husky")
REQUEST = "Photograph every third tree of row 2."


def approved(request: str = REQUEST) -> fh.ApprovedMission:
    return fh.authorize(fh.review(fh.plan(request, SITE, ROBOT).task, SITE, ROBOT), by="Ada")


def built(**constraints) -> fh.Task:
    """A Task whose request names nothing of its plan: a review warns of that."""
    return fh.build_task(
        fh.steps.Act(action="read_co2", at=fh.selectors.TreeIs(tree="4")), SITE, ROBOT, request="Hello", **constraints
    )


MISSION = approved()


def test_a_mission_is_examined_once(monkeypatch):
    calls = []
    examine = checks.examine
    monkeypatch.setattr(checks, "examine", lambda *args, **kw: calls.append(args) or examine(*args, **kw))
    review = fh.review(fh.plan(REQUEST, SITE, ROBOT).task, SITE, ROBOT)
    fh.simulate(fh.authorize(review, by="Ada"))
    assert len(calls) == 1


def test_only_the_checks_make_an_examination():
    root = Path(fh.__file__).parent
    assert {str(path.relative_to(root)) for path in root.rglob("*.py") if _makes_examination(path)} == {
        "approval/checks.py"
    }


def _makes_examination(path: Path) -> bool:
    """Return True if a module calls the class, under its own name or another."""
    tree = ast.parse(path.read_text(encoding="utf-8"))
    names = {"Examination"} | {
        alias.asname or alias.name
        for node in ast.walk(tree)
        if isinstance(node, ast.ImportFrom)
        for alias in node.names
        if alias.name == "Examination"
    }
    calls = (node.func for node in ast.walk(tree) if isinstance(node, ast.Call))
    return any((call.id if isinstance(call, ast.Name) else getattr(call, "attr", "")) in names for call in calls)


def test_the_same_seed_gives_the_same_events_and_another_seed_others():
    first = fh.simulate(MISSION, seed=3)
    assert fh.simulate(MISSION, seed=3).events == first.events
    assert fh.simulate(MISSION, seed=4).events != first.events


def test_many_simulations_are_the_same_on_any_number_of_processes():
    alone = fh.fly_many(MISSION, (5, 2, 7))
    assert [one.seed for one in alone] == [5, 2, 7]
    assert fh.fly_many(MISSION, (5, 2, 7), jobs=2) == alone
    run = fh.simulate(MISSION, seed=5)
    assert (alone[0].success, alone[0].seconds) == (run.success, run.events[-1].t)


def test_no_simulation_has_no_success_rate():
    none = fh.fly_many(MISSION, 0)
    assert none.success_rate != none.success_rate
    assert all(value != value for value in none.quantiles("seconds"))


@pytest.mark.parametrize(("seed", "shown"), [(-1, "-1"), (1.5, "1.5"), ("one", "'one'")])
def test_a_seed_that_is_none_is_refused(seed, shown):
    for use in (
        lambda: fh.fly_many(MISSION, (1, seed)),
        lambda: fh.simulate(MISSION, seed=seed),
        lambda: fh.review(MISSION.task, MISSION.site, MISSION.robot, seed=seed),
    ):
        with pytest.raises(InputError, match=f"the seed is {shown}, not a whole number from 0"):
            use()


def test_a_numpy_integer_is_a_seed():
    assert fh.simulate(MISSION, seed=np.int64(3)).events == fh.simulate(MISSION, seed=3).events


def test_a_review_reads_in_another_language():
    review = fh.review(MISSION.task, MISSION.site, MISSION.robot)
    assert review.words_in("en") == review.words
    spanish = review.words_in("es")
    assert len(spanish.splitlines()) == len(review.words.splitlines())
    assert "árbol" in spanish
    with pytest.raises(InputError, match="language"):
        review.words_in("xx")


def test_site_and_approved_mission_survive_pickling():
    site = pickle.loads(pickle.dumps(SITE))
    assert site == SITE
    assert site.content_sha256 == SITE.content_sha256
    mission = pickle.loads(pickle.dumps(MISSION))
    assert mission.task == MISSION.task
    assert fh.simulate(mission, seed=1).events == fh.simulate(MISSION, seed=1).events


def test_a_question_and_a_refusal_have_no_task():
    question = fh.plan("Measure CO2 at the corner tree.", SITE, ROBOT)
    with pytest.raises(RequestError, match=r"which is meant\?.*north-west"):
        question.task  # noqa: B018
    with pytest.raises(RequestError, match="husky cannot prune: no action 'prune'"):
        fh.plan("Prune the trees.", SITE, ROBOT).task  # noqa: B018


def test_warnings_are_to_be_confirmed_one_by_one():
    review = fh.review(built(), SITE, ROBOT)
    assert review.warnings
    with pytest.raises(NotConfirmedError) as refused:
        fh.authorize(review, by="Ada")
    assert refused.value.warnings == review.warnings
    with pytest.raises(NotConfirmedError):
        fh.authorize(review, by="Ada", confirmed=review.warnings[1:])
    assert fh.authorize(review, by="Ada", confirmed=review.warnings).task == review.task


def test_a_built_task_has_ids_whatever_its_nodes_had():
    def task(name: str) -> fh.Task:
        return fh.build_task(fh.steps.Act(id=name, action="read_co2"), SITE, ROBOT)

    assert task("") == task("mine")
    assert task("").composition.plan.id == "n1"


@given(task=Parts(ROVER).tasks())
def test_a_task_survives_its_xml(task):
    assert fh.Task.from_xml(task.to_xml()) == task
    assert fh.Task.from_xml(task.to_xml().decode()) == task


def test_a_task_is_read_from_a_file(tmp_path):
    path = tmp_path / "task.xml"
    path.write_bytes(MISSION.task.to_xml())
    assert fh.Task.from_xml(path) == MISSION.task
    with pytest.raises(TaskError, match=r"none\.xml"):
        fh.Task.from_xml(tmp_path / "none.xml")


def test_records_without_positions_are_no_map():
    pytest.importorskip("geopandas")
    with pytest.raises(InputError, match="no positions"):
        fh.fly_many(MISSION, 2).to_geopandas()


def test_a_table_has_a_row_a_record():
    pytest.importorskip("pandas")
    run = fh.simulate(MISSION, seed=1)
    events = run.events.to_pandas()
    assert next(iter(events.event)) == "started"
    assert len(events) == len(run.events)
    assert len(run.observations.to_pandas()) == 6
    assert Records(()).to_pandas().empty


def test_tables_are_shown_by_their_size():
    run = fh.simulate(MISSION, seed=5)
    assert repr(fh.fly_many(MISSION, (5, 2))) == "<Simulations: 2 of 2 succeeded>"
    assert re.fullmatch(r"<Records: (\d+ [A-Z]\w+, ){1,4}(\.\.\.|\d+ [A-Z]\w+)>", repr(run.events))
    assert len(repr(run.events)) < 120
    assert repr(Records(())) == "<Records: empty>"


def test_the_map_of_a_review_is_written_and_refused_where_nothing_can_be_driven(tmp_path):
    review = fh.review(MISSION.task, SITE, ROBOT)
    review.save_map(tmp_path / "plan.png")
    assert (tmp_path / "plan.png").read_bytes().startswith(b"\x89PNG")
    away = fh.steps.Act(action="read_co2", at=fh.selectors.TreeIs(tree="no such tree"))
    impossible = fh.review(fh.build_task(away, SITE, ROBOT, request="Hello"), SITE, ROBOT)
    with pytest.raises(NotApprovedError, match="no such tree"):
        impossible.save_map(tmp_path / "none.png")
    assert not (tmp_path / "none.png").exists()


def test_an_exported_tree_is_imported_as_the_task_that_it_came_from():
    tree = write_tree(MISSION.task, capabilities_of(ROBOT))
    task, document = mission.import_tree(tree, ROBOT, site=SITE, source="tree.xml")
    assert task.composition == MISSION.task.composition
    assert mission.decode_task(document, ROBOT) == task
    with pytest.raises(TaskError, match=r"tree\.xml"):
        mission.import_tree(b"<root/>", ROBOT, source="tree.xml")


def test_a_vehicle_of_another_robot_is_refused():
    vehicle = simulation(SITE, fh.Robot.load("amiga"), fh.World(), seed=1)
    with pytest.raises(NotApprovedError, match="the vehicle is amiga"):
        fh.carry_out(MISSION, vehicle=vehicle)
    assert fh.carry_out(MISSION, vehicle=simulation(SITE, ROBOT, fh.World(), seed=1)).status == "completed"
