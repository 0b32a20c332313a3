"""Every solver of the benchmarks keeps the contract of solvers, and careless ones do not."""

from __future__ import annotations

from dataclasses import dataclass

import pytest

from fieldhand.orienteering.policy import State
from fieldhand.orienteering.prepared_solver import NextVertex, PreparedSolver
from fieldhand.orienteering.problem import Problem
from fieldhand.testing.solver_contract import SolverContract
from fieldhand_bench.orienteering.solvers import Options, prepare, solver_names


class BenchmarkContract(SolverContract):
    name: str

    def prepare(self, problem: Problem, seed: int) -> PreparedSolver:
        return prepare(self.name, problem, Options(seed=seed, milp_s=20.0, missions=8, simulations=120))


class TestOnline(BenchmarkContract):
    name = "online"


class TestFixed(BenchmarkContract):
    name = "fixed"


class TestGreedy(BenchmarkContract):
    name = "greedy"


class TestTreeSearch(BenchmarkContract):
    name = "mcts"


class TestProgramme(BenchmarkContract):
    name = "milp"
    seeds = (1,)


def test_every_solver_of_the_benchmarks_is_tested():
    tested = {kind.name for kind in BenchmarkContract.__subclasses__()}
    assert set(solver_names()) <= tested


@dataclass(frozen=True)
class Insatiable:
    """A solver that breaks the contract: it visits every vertex, whatever that costs."""

    problem: Problem

    def mission(self, seed: int) -> NextVertex:
        return self._next

    def _next(self, state: State) -> int:
        open_ = set(range(self.problem.size)) - state.visited - {self.problem.start, self.problem.end}
        return min(open_, default=self.problem.end)


class InsatiableContract(SolverContract):
    def prepare(self, problem: Problem, seed: int) -> PreparedSolver:
        return Insatiable(problem)


@dataclass(frozen=True)
class Undecided:
    """A solver that breaks the contract: it never leaves the start."""

    def mission(self, seed: int) -> NextVertex:
        return lambda state: state.vertex


class UndecidedContract(SolverContract):
    def prepare(self, problem: Problem, seed: int) -> PreparedSolver:
        return Undecided()


@pytest.mark.parametrize(
    "test",
    [
        InsatiableContract.test_a_mission_whose_costs_are_certain_keeps_to_its_budget,
        InsatiableContract.test_budgets_are_exceeded_no_more_often_than_accepted,
        InsatiableContract.test_no_more_vertices_are_visited_than_allowed,
        InsatiableContract.test_a_vertex_without_a_way_to_it_is_never_visited,
        InsatiableContract.test_a_budget_that_is_not_safe_enough_is_refused_or_spent_on_the_way_to_the_end,
    ],
)
def test_a_solver_that_spends_too_much_fails(test):
    with pytest.raises(AssertionError):
        test(InsatiableContract())


def test_a_solver_that_never_arrives_fails():
    with pytest.raises(AssertionError, match="does not end"):
        UndecidedContract().test_a_mission_ends_at_the_end_and_visits_nothing_twice()
