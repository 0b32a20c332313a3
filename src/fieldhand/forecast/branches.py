"""Enumeration of the branches of a mission: outcomes of conditions, failing actions, optional visits made or not."""

from __future__ import annotations

from collections import deque
from collections.abc import Callable, Iterator, Sequence
from dataclasses import dataclass, field
from itertools import product
from typing import TYPE_CHECKING, Literal

import numpy as np

from fieldhand.errors import DriveFault, PlaceError
from fieldhand.forecast import visit_order
from fieldhand.forecast.local_decisions import local_decisions
from fieldhand.forecast.optional_work import LikelyOptionalWork, ScriptedOptionalWork
from fieldhand.forecast.possible_answers import BranchReadings, ConditionOutcomes
from fieldhand.forecast.request_handler import ForecastHandler
from fieldhand.forecast.sampled_costs import LegCostSamples, MissionSamples
from fieldhand.forecast.walk_state import Answers
from fieldhand.forecast.walk_steps import Decision, Walk, WalkStep
from fieldhand.robot.model import RobotProfile
from fieldhand.short_repr import short_repr
from fieldhand.site.model import Site
from fieldhand.task import plan
from fieldhand.task.earlier import site_of_run
from fieldhand.task.frames import Task

if TYPE_CHECKING:
    from fieldhand.forecast.expected_visits import ExpectedVisits
    from fieldhand.site.drives import Drives

#: Maximum number of walks, and of steps in all walks; at least two walks are always made.
MAX_WALKS = 256
MAX_STEPS = 40_000
#: Maximum number of steps of the initial walks, which matter most because they include the longest and the shortest.
MAX_STEPS_ALIKE = 200_000
#: Maximum number of additional walks on which optional visits are prescribed instead of simulated.
MAX_OPTIONAL_WALKS = 64
#: Number of nodes whose constant answers are tried in every combination; all further nodes share one answer.
_ALIKE = 4
#: Number of local decisions on one walk above which their answers are not varied individually.
_BY_THEMSELVES = 8

Coverage = Literal["enumerated", "bounded", "sampled"]


@dataclass(frozen=True, kw_only=True)
class BrokenBranch:
    """A branch that cannot be carried out.

    Attributes:
        decisions: Decisions that lead to the branch.
        error: The error on this branch.
        node: Id of the node of the last drive.
        steps: Steps up to the error.
    """

    decisions: tuple[Decision, ...]
    error: PlaceError | DriveFault
    node: str
    steps: tuple[WalkStep, ...]


@dataclass(frozen=True, kw_only=True, repr=False)
class Branches:
    """The branches of a mission that were walked.

    Attributes:
        walks: Distinct walks, no two with the same decisions. On the first, every condition holds and nothing fails.
        optional_walks: Further walks on which each optional step is done or left out, and optional visits are those of
            the sampled mission that makes the most, or the fewest.
        broken: Branches that end early because a place cannot be resolved or reached.
        coverage: ``enumerated``: all branches. ``bounded``: decisions that only affect the work at the current place
            have the same answer throughout a walk, all other decisions are enumerated; so every place and drive was
            covered, and no branch uses more or less than those walked. ``sampled``: a random sample of the branches.
    """

    walks: tuple[Walk, ...]
    optional_walks: tuple[Walk, ...] = ()
    broken: tuple[BrokenBranch, ...] = ()
    coverage: Coverage = "enumerated"

    __repr__ = short_repr

    @property
    def complete(self) -> bool:
        """Return True if no place, drive or extreme of resource use can have been missed."""
        return self.coverage != "sampled"


def branches(
    task: Task,
    site: Site,
    robot: RobotProfile,
    *,
    drives: Drives | None = None,
    charge_percent: float = 100.0,
    limit: int = MAX_WALKS,
    leg_costs: LegCostSamples | None = None,
    seed: int = 0,
) -> Branches:
    """Walk a Task along every branch, up to a maximum number of walks and steps.

    Args:
        task, site, robot: Task, site and robot of the mission.
        drives: Drives between places of the site; None to compute them.
        charge_percent: Battery charge at the start of the mission, 0 to 100.
        limit: Maximum number of walks.
        leg_costs: Sampled leg costs of missions along each walk; None to sample no missions.
        seed: Seed for sampling branches if there are too many.

    Raises:
        TaskError: A walk exceeds the maximum number of nodes.
    """
    site = site_of_run(task, site)
    ways = drives or visit_order.drives_for(site, robot, task.constraints)
    outcomes = ConditionOutcomes(task.composition.plan, site, robot)
    kept: dict[object, ExpectedVisits] = {}

    def likely(answers: Answers) -> ForecastHandler:
        samples = None if leg_costs is None else MissionSamples(leg_costs)
        readings = BranchReadings(outcomes)
        return ForecastHandler(
            task,
            site,
            robot,
            ways,
            answers,
            charge_percent,
            optional=LikelyOptionalWork(kept),
            samples=samples,
            readings=readings,
        )

    def optional_walker(answers: Answers) -> ForecastHandler:
        readings = BranchReadings(outcomes)
        return ForecastHandler(
            task, site, robot, ways, answers, charge_percent, optional=ScriptedOptionalWork(kept), readings=readings
        )

    root = task.composition.plan
    looked = _Exploration(likely, root, limit, seed, by_themselves=_BY_THEMSELVES)
    coverage = looked.explore()
    further = _Exploration(optional_walker, root, MAX_OPTIONAL_WALKS, seed, by_themselves=0)
    if any(node.is_optional for node in plan.walk(root)):
        coverage = "sampled" if further.explore() == "sampled" else coverage
    return Branches(
        walks=tuple(looked.walks.values()),
        optional_walks=tuple(further.walks.values()),
        broken=(*looked.broken.values(), *further.broken.values()),
        coverage=coverage,
    )


@dataclass(kw_only=True)
class _Script:
    """A source of answers: a prefix of answers in order, then preset ones by node, else the nominal answer.

    Nominally conditions hold, optional steps are taken, and nothing fails.

    Attributes:
        prefix: The first answers: those of an earlier walk, with the last one inverted.
        preset: Preset answers by kind of decision and node.
        fixed: Keys of decisions that always have their preset answer and do not consume the prefix.
        rng: Random generator for answers beyond the prefix; ``chance`` is the probability of yes.
    """

    prefix: Sequence[bool] = ()
    turned: int | None = None
    preset: dict[str, bool] = field(default_factory=dict)
    fixed: frozenset[str] = frozenset()
    rng: np.random.Generator | None = None
    chance: float = 0.5
    _asked: int = 0

    def answers(self) -> Answers:
        return Answers(
            holds=lambda node: self._answer(node, True),
            taken=lambda node: self._answer(node, True),
            fails=lambda node: self._answer(f"{node} fails", False),
            blocked=lambda node: self._answer(f"{node} blocked", False),
        )

    def _answer(self, key: str, default: bool) -> bool:
        if key in self.fixed:
            return self.preset.get(key, default)
        position, self._asked = self._asked, self._asked + 1
        if self.turned is not None and position <= self.turned:
            return self.prefix[position] is not (position == self.turned)
        if self.rng is not None:
            return bool(self.rng.random() < self.chance) if default else bool(self.rng.random() < 0.2)
        return self.preset.get(key, default)


class _Exploration:
    """Walks of one plan, until all branches are explored or a bound is reached."""

    def __init__(
        self,
        walker: Callable[[Answers], ForecastHandler],
        root: plan.Node,
        limit: int,
        seed: int,
        *,
        by_themselves: int,
    ) -> None:
        self._walker, self._root, self._limit, self._by_themselves = walker, root, limit, by_themselves
        self._rng = np.random.default_rng([seed, len(list(plan.walk(root)))])
        self.walks: dict[tuple[Decision, ...], Walk] = {}
        self.broken: dict[str, BrokenBranch] = {}
        self._walked = self._steps = 0
        #: Decisions of the walks with preset answers only.
        self._alike: dict[frozenset[tuple[str, bool]] | None, tuple[Decision, ...]] = {}

    def explore(self) -> Coverage:
        """Walk the branches and return how completely they were covered."""
        local = local_decisions(self._root)
        # Initial walks: first every condition holds and nothing fails, then no condition holds, then the other
        # combinations.
        most = 0
        for preset in _alike(self._root):
            if len(self.walks) < self._limit and (len(self.walks) < 2 or self._steps < MAX_STEPS_ALIKE):
                decisions = self._look(_Script(preset=preset))
                if all(d.sure for d in decisions):
                    return "enumerated"
                most = max(most, sum(_key(d) in local for d in decisions if not d.sure))
        # The following walks have a separate bound; the initial walks are not repeated.
        self._steps = 0
        if most <= self._by_themselves:
            whole: Coverage = "enumerated"
            each, fixed = iter([dict[str, bool]()]), frozenset[str]()
        else:
            whole = "bounded" if len(local) <= _ALIKE else "sampled"
            each, fixed = _combinations(local), frozenset(local)
        if all(self._turn(preset, fixed) for preset in each):
            return whole
        self._draw()
        return "sampled"

    def _turn(self, preset: dict[str, bool], fixed: frozenset[str]) -> bool:
        """Invert each answer that is not fixed, of every walk found; return True if all branches were walked."""
        # Each prefix is tried once: a walk proposes to invert each answer that its own prefix did not determine.
        pending: deque[tuple[tuple[bool, ...], int | None]] = deque([((), None)])
        while pending:
            # If few prefixes are pending, all are walked; otherwise part of the limit is reserved for random branches.
            near = len(pending) <= self._limit // 4
            if not self._room(self._limit if near else self._limit * 3 // 4):
                return False
            prefix, turned = pending.popleft()
            decisions = self._look(_Script(prefix=prefix, turned=turned, preset=preset, fixed=fixed))
            given = tuple(d.answer for d in decisions if not d.sure and _key(d) not in fixed)
            first = 0 if turned is None else turned + 1
            room = self._limit + 1 - len(pending)
            pending.extend((given, i) for i in range(first, min(len(given), first + max(0, room))))
        return True

    def _draw(self) -> None:
        """Walk random branches with varying fractions of conditions that hold."""
        for number in range(self._limit):
            if not self._room(self._limit):
                return
            self._look(_Script(rng=self._rng, chance=(0.5, 0.1, 0.9)[number % 3]))

    def _room(self, limit: int) -> bool:
        return len(self.walks) < limit and self._walked < 4 * self._limit and self._steps < MAX_STEPS

    def _look(self, script: _Script) -> tuple[Decision, ...]:
        """Walk a branch and return its decisions."""
        alike = None if script.turned is not None or script.rng is not None else frozenset(script.preset.items())
        if alike in self._alike:
            return self._alike[alike]
        walker = self._walker(script.answers())
        try:
            walked = walker.run((self._root,))
        except (PlaceError, DriveFault) as error:
            decisions = tuple(walker.decisions)
            steps = tuple(walker.steps)
            branch = BrokenBranch(decisions=decisions, error=error, node=walker.bound_for, steps=steps)
            self.broken.setdefault(str(error), branch)
        else:
            decisions = walked.decisions
            self.walks.setdefault(decisions, walked)
        if alike is not None:
            self._alike[alike] = decisions
        self._walked, self._steps = self._walked + 1, self._steps + len(walker.steps)
        return decisions


def _alike(root: plan.Node) -> Iterator[dict[str, bool]]:
    """Yield initial answers: every combination for the first few conditions, the others all true or all false.

    In the last ones every action inside a ``Try`` fails, and then every drive inside a ``Try`` is blocked.
    """
    asked = [n.id for n in plan.walk(root) if n.tested is not None or n.is_optional]
    tried = [inner.id for n in plan.walk(root) for body in n.caught for inner in plan.walk(body)]
    some, others = asked[:_ALIKE], asked[_ALIKE:]
    for answers in _combinations(some):
        for default in (True, False) if others else (True,):
            yield {**dict.fromkeys(others, default), **answers}
    if tried:
        acts = [act.id for act in plan.acts(root) if act.id in tried]
        for default in (True, False):
            for failing in ({f"{i} fails": True for i in acts}, {f"{i} blocked": True for i in tried}):
                yield {**dict.fromkeys(asked, default), **failing}


def _combinations(keys: Sequence[str]) -> Iterator[dict[str, bool]]:
    """Yield every combination of answers to the first few keys; all others share one answer."""
    some, others = keys[:_ALIKE], keys[_ALIKE:]
    for answers in product((True, False), repeat=len(some)):
        yield {**dict.fromkeys(others, answers[0] if answers else True), **dict(zip(some, answers, strict=True))}


def _key(decision: Decision) -> str:
    """Return the key of a decision in a script."""
    return f"{decision.node} {decision.kind}" if decision.kind in ("fails", "blocked") else decision.node
