"""Properties of every solver: subclass :class:`SolverContract` for your own and return it, prepared for a problem.

::

    class TestMySolver(SolverContract):
        def prepare(self, problem: Problem, seed: int) -> PreparedSolver:
            return MY_SOLVER.prepare(problem, Options(seed=seed))
"""

from __future__ import annotations

import pickle
from abc import ABC, abstractmethod
from collections.abc import Iterator
from dataclasses import replace
from typing import ClassVar

import numpy as np

from fieldhand.errors import ProblemError
from fieldhand.orienteering.policy import State
from fieldhand.orienteering.prepared_solver import PreparedSolver
from fieldhand.orienteering.problem import Limit, Problem, count_visits
from fieldhand.orienteering.simulated_mission import SimulatedMission, simulate_mission

__all__ = ["PreparedSolver", "SolverContract", "random_problem"]

#: Part of a budget by which it may be exceeded because of rounding.
ROUNDING = 1e-9


class SolverContract(ABC):
    """The contract of the solvers of the group ``fieldhand.solvers``, as tests on small random problems.

    A solver may refuse a kind of problem (several limits, legs after the end, one vertex as start and end) with a
    :class:`~fieldhand.errors.ProblemError`. What it accepts, it must solve.

    Attributes:
        seeds: Seeds of the problems that every test takes.
        size: Number of vertices of a problem, start and end included.
        missions: Number of missions on each problem; four times as many where chances are counted.
        keeps_chance: True if the solver promises that a mission as a whole exceeds its budget no more often than the
            problem accepts; False if it only looks at the next visit. Costs that are certain keep to the budget either
            way.
    """

    seeds: ClassVar[tuple[int, ...]] = (0, 1)
    size: ClassVar[int] = 7
    missions: ClassVar[int] = 8
    keeps_chance: ClassVar[bool] = True

    @abstractmethod
    def prepare(self, problem: Problem, seed: int) -> PreparedSolver:
        """Return the solver, prepared for the missions of a problem.

        Args:
            problem: The problem.
            seed: Seed of everything in the solver that is random.

        Raises:
            ProblemError: The solver takes no problems of this kind, or finds no route that is safe enough.
        """

    def test_a_mission_ends_at_the_end_and_visits_nothing_twice(self) -> None:
        for problem in self._problems():
            for mission in self._missions(problem):
                inner = mission.path[1:-1]
                assert mission.path[0] == problem.start
                assert mission.path[-1] == problem.end
                assert len(set(inner)) == len(inner), f"a vertex is visited twice: {mission.path}"
                assert not {problem.start, problem.end} & set(inner), f"it passes its start or end: {mission.path}"

    def test_a_mission_whose_costs_are_certain_keeps_to_its_budget(self) -> None:
        for problem in self._problems(alpha=1.0):
            for mission in self._missions(problem):
                for left, limit in zip(mission.left, problem.limits, strict=True):
                    assert left >= -ROUNDING * limit.budget, f"{-left:g} over the budget of {limit.budget:g}"

    def test_budgets_are_exceeded_no_more_often_than_accepted(self) -> None:
        if not self.keeps_chance:
            return
        for accepted in (0.05, 0.2):
            problems = self._problems(chance=accepted)
            driven = [m for problem in problems for m in self._missions(problem, 4 * self.missions)]
            most = len(driven) * accepted + 3.0 * (len(driven) * accepted * (1.0 - accepted)) ** 0.5
            failed = sum(not mission.kept for mission in driven)
            assert failed <= most, f"{failed} of {len(driven)} missions exceeded a budget, {accepted:.0%} are accepted"

    def test_reward_is_collected_where_the_budget_allows(self) -> None:
        for problem in self._problems(alpha=1.0, budget=10.0):
            for mission in self._missions(problem):
                assert mission.reward > 0.0, "nothing is visited though everything is within reach"

    def test_the_same_seed_drives_the_same_missions(self) -> None:
        for problem in self._problems():
            first, second = (self._missions(problem) for _ in range(2))
            assert [m.path for m in first] == [m.path for m in second]

    def test_a_mission_does_not_depend_on_those_before_it(self) -> None:
        for problem in self._problems():
            if (prepared := self._prepared(problem)) is not None:
                first, *_, again = (drive(problem, prepared, seed).path for seed in (0, 1, 2, 0))
                assert first == again

    def test_a_prepared_solver_can_be_sent_to_another_process(self) -> None:
        for problem in self._problems():
            if (prepared := self._prepared(problem)) is not None:
                sent = pickle.loads(pickle.dumps(prepared))  # noqa: S301  written on the same line
                assert drive(problem, sent, 0).path == drive(problem, prepared, 0).path

    def test_the_problem_is_left_as_it_was(self) -> None:
        for problem in self._problems():
            rewards, distances = problem.rewards.copy(), problem.distances.copy()
            self._missions(problem)
            assert np.array_equal(problem.rewards, rewards)
            assert np.array_equal(problem.distances, distances)

    def test_no_more_vertices_are_visited_than_allowed(self) -> None:
        for problem in self._problems(budget=10.0):
            few = replace(problem, max_visits=2)
            for mission in self._missions(few):
                assert count_visits(few, mission.path) <= 2, f"two visits are allowed: {mission.path}"

    def test_a_vertex_without_a_way_to_it_is_never_visited(self) -> None:
        for problem in self._problems(budget=10.0):
            distances, rewards = problem.distances.copy(), problem.rewards.copy()
            distances[1, :] = distances[:, 1] = np.inf
            distances[1, 1], rewards[1] = 0.0, 100.0
            for mission in self._missions(replace(problem, distances=distances, rewards=rewards)):
                assert 1 not in mission.path, f"no way leads to vertex 1: {mission.path}"

    def test_a_budget_that_is_not_safe_enough_is_refused_or_spent_on_the_way_to_the_end(self) -> None:
        for problem in self._problems():
            direct = problem.length(problem.start, problem.end)
            if problem.start == problem.end:
                continue
            tight = replace(problem, limits=(Limit(budget=direct * 1.01, failure_probability=0.01),))
            for mission in self._missions(tight):
                assert mission.path == (tight.start, tight.end), f"{mission.path} though the way itself is not safe"

    def _problems(self, *, alpha: float = 0.5, chance: float = 0.1, budget: float = 2.0) -> Iterator[Problem]:
        """Yield problems with two ends, with one vertex as start and end, and with work at each vertex."""
        for seed in self.seeds:
            problem = random_problem(self.size, seed, budget=budget, chance=chance, alpha=alpha)
            yield problem
            yield replace(problem, end=problem.start)
            work = np.random.default_rng([seed, 3]).random(self.size) * 0.1
            yield replace(problem, limits=(replace(problem.limits[0], service=work),))

    def _prepared(self, problem: Problem) -> PreparedSolver | None:
        try:
            return self.prepare(problem, 0)
        except ProblemError:
            return None

    def _missions(self, problem: Problem, count: int | None = None) -> list[SimulatedMission]:
        """Return the missions of a newly prepared solver; none if it refuses the problem."""
        prepared = self._prepared(problem)
        return [] if prepared is None else [drive(problem, prepared, n) for n in range(count or self.missions)]


def random_problem(size: int, seed: int, *, budget: float = 2.0, chance: float = 0.1, alpha: float = 0.5) -> Problem:
    """Return a problem of random points in the unit square with random rewards.

    Args:
        size: Number of vertices; the first is the start, the last the end.
        seed: Seed of points and rewards.
        budget: Budget, in sides of the square.
        chance: Accepted failure probability.
        alpha: Certain part of a leg's cost, 0 to 1.
    """
    points = np.random.default_rng(seed).random((size, 2))
    return Problem(
        distances=np.hypot(*(points[:, None] - points[None]).transpose(2, 0, 1)),
        rewards=np.random.default_rng([seed, 1]).random(size),
        start=0,
        end=size - 1,
        limits=(Limit(budget=budget, failure_probability=chance),),
        alpha=alpha,
    )


def drive(problem: Problem, prepared: PreparedSolver, seed: int) -> SimulatedMission:
    """Drive one mission; fail if a decision names no vertex, or if the mission does not end."""
    decide, decisions = prepared.mission(seed), 0

    def following(state: State) -> int:
        nonlocal decisions
        decisions += 1
        assert decisions <= problem.size, "the mission does not end"
        vertex = decide(state)
        assert 0 <= vertex < problem.size, f"it goes to vertex {vertex}, there are {problem.size}"
        return vertex

    return simulate_mission(problem, following, np.random.default_rng([seed, 2]))
