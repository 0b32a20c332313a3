"""Solvers by name, from the entry points of the group ``fieldhand.solvers``.

A solver is prepared once for a problem and then decides in any number of missions.
"""

from __future__ import annotations

from collections.abc import Callable
from dataclasses import dataclass

from fieldhand.errors import ProblemError
from fieldhand.orienteering.policy import Policy
from fieldhand.orienteering.prepared_solver import NextVertex, PreparedSolver
from fieldhand.orienteering.problem import Problem
from fieldhand.orienteering.route import StoppingCriterion, solve
from fieldhand.plugins import active


@dataclass(frozen=True, kw_only=True)
class Options:
    """Options of the solvers.

    Attributes:
        seed: Random seed.
        milp_s: Time limit of the mixed-integer program, seconds.
        daring: Risk tolerance of the online policy, 0 to 1.
        missions: Number of missions from which the online policy learns its price of a failure; 0 for none.
        simulations: Number of simulations of the tree search per decision.
    """

    seed: int = 0
    milp_s: float = 60.0
    daring: float = 0.6
    missions: int = 400
    simulations: int = 2000


@dataclass(frozen=True, eq=False)
class _Online:
    policy: Policy

    def mission(self, seed: int) -> NextVertex:
        return self.policy.again(seed, self.policy.price).next


@dataclass(frozen=True)
class _Fixed:
    vertices: tuple[int, ...]

    def mission(self, seed: int) -> NextVertex:  # noqa: ARG002
        ahead = iter(self.vertices[1:])
        return lambda _: next(ahead)


@dataclass(frozen=True, eq=False)
class _Greedy:
    problem: Problem

    def mission(self, seed: int) -> NextVertex:  # noqa: ARG002
        from fieldhand_bench.orienteering.greedy import Greedy

        return Greedy(self.problem).next


@dataclass(frozen=True, eq=False)
class _TreeSearch:
    problem: Problem
    simulations: int

    def mission(self, seed: int) -> NextVertex:
        from fieldhand_bench.orienteering.mcts import TreeSearch

        return TreeSearch(self.problem, seed, self.simulations).next


@dataclass(frozen=True, kw_only=True)
class Solver:
    """A solver of stochastic orienteering problems, registered under ``fieldhand.solvers``.

    Attributes:
        prepare: Function that prepares the solver for a problem with the given options.
        summary: One line for help texts.
    """

    prepare: Callable[[Problem, Options], PreparedSolver]
    summary: str


def _prepare_online(problem: Problem, options: Options) -> PreparedSolver:
    from fieldhand.orienteering.price_tuning import tune_price

    policy = Policy(problem, options.seed, risk_tolerance=options.daring)
    return _Online(tune_price(policy, problem, options.seed + 1, options.missions))


def _prepare_fixed(problem: Problem, options: Options) -> PreparedSolver:
    return _Fixed(solve(problem, options.seed, StoppingCriterion(rounds=20_000)).vertices)


def _prepare_tree_search(problem: Problem, options: Options) -> PreparedSolver:
    from fieldhand_bench.orienteering.mcts import require_supported

    require_supported(problem)
    return _TreeSearch(problem, options.simulations)


def _prepare_milp(problem: Problem, options: Options) -> PreparedSolver:
    from fieldhand_bench.orienteering.milp import solve_milp

    return _Fixed(solve_milp(problem, options.seed, options.milp_s).vertices)


ONLINE = Solver(prepare=_prepare_online, summary="decides anew after every leg (this library)")
FIXED = Solver(prepare=_prepare_fixed, summary="best fixed route (this library)")
GREEDY = Solver(prepare=lambda problem, _: _Greedy(problem), summary="greedy by reward per distance")
MCTS = Solver(prepare=_prepare_tree_search, summary="plain Monte Carlo tree search")
MILP = Solver(prepare=_prepare_milp, summary="sample-average MILP, HiGHS")


def solver_names() -> tuple[str, ...]:
    """Return the names of all installed solvers, without importing any."""
    return tuple(active("fieldhand.solvers"))


def prepare(name: str, problem: Problem, options: Options) -> PreparedSolver:
    """Prepare a solver for a problem.

    Raises:
        ProblemError: No solver has that name, or it finds no solution.
        PluginError: The entry point cannot be imported, or is not a :class:`Solver`.
    """
    plugins = active("fieldhand.solvers")
    if name not in plugins:
        raise ProblemError(f"no solver is called '{name}'", advice=f"use {', '.join(plugins)}")
    solver = plugins[name].load()
    if not isinstance(solver, Solver):
        raise plugins[name].error("is no Solver")
    return solver.prepare(problem, options)
