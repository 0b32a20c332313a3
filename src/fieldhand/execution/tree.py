"""Behavior tree of a plan: one behavior per plan node, named by the node's id and description.

The tree shows the mission and ticks it. :mod:`fieldhand.task.nodes` defines what a node means; each tick advances the
current node, and each behavior has the status of its node.
"""

from __future__ import annotations

from collections.abc import Iterator
from contextlib import contextmanager

from py_trees.behaviour import Behaviour
from py_trees.common import Status
from py_trees.composites import Composite

from fieldhand.execution.active_mission import ActiveMission
from fieldhand.execution.for_each_visits import ForEachVisits
from fieldhand.execution.plan_executor import PlanExecutor
from fieldhand.execution.shed_work import shed_rest
from fieldhand.forecast.mission_state import Verdict
from fieldhand.places.selector import Selector
from fieldhand.task.nodes.base import GivenUp
from fieldhand.task.plan import Node
from fieldhand.task.run import RunOutcome

_STATUS: dict[RunOutcome, Status] = {"done": Status.SUCCESS, "failed": Status.FAILURE, "cut": Status.INVALID}


def compile_tree(mission: ActiveMission) -> MissionTree:
    """Return the behavior tree of a Task.

    Args:
        mission: The mission, shared by all behaviors. A tree serves one mission.

    Returns:
        The root. Tick it until it succeeds or fails, or until the mission has an ending.
    """
    return MissionTree(mission)


class NodeBehavior(Composite):
    """Behavior of a plan node.

    Args:
        node: The node.
    """

    def __init__(self, node: Node) -> None:
        super().__init__(f"{node.id} {node.say(_say_selector)}", [NodeBehavior(child) for child in node.children])
        self.node = node

    def tick(self) -> Iterator[Behaviour]:
        """Tick the current child; the root advances the mission itself."""
        if self.current_child is not None and self.current_child.status == Status.RUNNING:
            yield from self.current_child.tick()
        yield self


class MissionTree(NodeBehavior):
    """Root of the tree, which advances the mission.

    Args:
        mission: The mission.
    """

    def __init__(self, mission: ActiveMission) -> None:
        super().__init__(mission.task.composition.plan)
        self.mission = mission
        self._executor = PlanExecutor(mission)
        self._program = self._executor.program()
        #: True once nothing of the plan is left to do, not even a charge for the way home.
        self.ended = False
        self._behavior: dict[str, NodeBehavior] = {b.node.id: b for b in self.iterate() if isinstance(b, NodeBehavior)}
        mission.run.entered, mission.run.left = self._entered, self._left

    def tick(self) -> Iterator[Behaviour]:
        """Advance until the robot is busy, a round is over, or the plan has ended."""
        with self._until_ended():
            next(self._program)
        yield from super().tick()

    def stop(self, new_status: Status = Status.INVALID) -> None:
        """End the plan and stop the robot."""
        if new_status == Status.INVALID:
            self._program.close()
            self.mission.stop_driver()
        super().stop(new_status)

    @property
    def between(self) -> bool:
        """True between two rounds or visits."""
        return self._executor.between

    @property
    def current_visit(self) -> ForEachVisits | None:
        """The current visit of a for-each, which can be left out."""
        return self._executor.visit

    def skip(self, why: str, *, row: bool) -> None:
        """Leave out the current visit of a for-each; the robot must not have a goal."""
        visit = self.current_visit
        assert visit is not None  # noqa: S101  callers have checked it
        visit.skip(why, row=row)
        with self._until_ended():
            self._program.throw(GivenUp(visit.node.id))

    @contextmanager
    def _until_ended(self) -> Iterator[None]:
        """Advance the program in this context; note its end."""
        try:
            yield
        except StopIteration:
            self.ended = True

    def give_up(self, verdict: Verdict) -> None:
        """Report the current work and all later work as given up."""
        shed_rest(self.mission, self._executor.place, verdict)

    def _entered(self, node: Node) -> None:
        behavior = self._behavior[node.id]
        for inner in behavior.iterate():
            inner.status = Status.INVALID
        behavior.status = Status.RUNNING
        if isinstance(behavior.parent, NodeBehavior):
            behavior.parent.current_child = behavior

    def _left(self, node: Node, outcome: RunOutcome) -> None:
        self._behavior[node.id].status = _STATUS[outcome]


def _say_selector(selector: Selector) -> str:
    from fieldhand.places.wording import say_selector

    return say_selector(selector)
