"""A Task exported as a tree and imported again is the same Task; what a tree cannot carry is said."""

from __future__ import annotations

from hypothesis import HealthCheck, assume, given, settings
from strategies import ROVER, Parts

from fieldhand.errors import TaskError
from fieldhand.exchange.btcpp import read_tree, write_tree
from fieldhand.task.frames import Task


@given(Parts(ROVER).tasks())
@settings(deadline=None, max_examples=60, suppress_health_check=[HealthCheck.too_slow, HealthCheck.data_too_large])
def test_a_task_comes_back(task: Task) -> None:
    try:
        document = write_tree(task, ROVER)
    except TaskError as error:
        assert any(word in str(error) for word in ("blackboard entry", "cannot carry"))
        assume(False)
    assert read_tree(document, ROVER) == task
    assert write_tree(read_tree(document, ROVER), ROVER) == document


