"""The solvers of the benchmark by name. Each is prepared once for a problem, then drives any number of missions."""

from __future__ import annotations

from collections.abc import Callable
from dataclasses import dataclass
from typing import Protocol

from fieldhand.errors import ProblemError
from fieldhand.orienteering.policy import Policy, State
from fieldhand.orienteering.problem import Problem
from fieldhand.orienteering.route import StoppingCriterion, solve

Next = Callable[[State], int]

#: Name of each, and what it is in words.
NAMES = {
    "online": "decides anew after every leg (this library)",
    "fixed": "best fixed route (this library)",
    "greedy": "greedy by reward per distance",
    "mcts": "plain Monte Carlo tree search",
    "milp": "sample-average MILP, HiGHS",
    "perfect": "perfect information: a bound, no solver",
}


class Prepared(Protocol):
    """A solver that has done what it does before a mission. It can be sent to another process."""

    def mission(self, seed: int) -> Next:
        """What decides in one mission."""
        ...


@dataclass(frozen=True, kw_only=True)
class Options:
    """How the solvers are prepared.

    Attributes:
        seed: Of all that is random in them.
        milp_s: Time limit of the mixed-integer programme, seconds.
        daring: Of the policy.
        missions: From which the policy learns its price of a failure before the trials; 0 for none.
        simulations: Of the tree search at each decision.
    """

    seed: int = 0
    milp_s: float = 60.0
    daring: float = 0.6
    missions: int = 400
    simulations: int = 2000


@dataclass(frozen=True, eq=False)
class _Online:
    policy: Policy

    def mission(self, seed: int) -> Next:
        return self.policy.again(seed, self.policy.price).next


@dataclass(frozen=True)
class _Fixed:
    vertices: tuple[int, ...]

    def mission(self, seed: int) -> Next:  # noqa: ARG002
        ahead = iter(self.vertices[1:])
        return lambda _: next(ahead)


@dataclass(frozen=True, eq=False)
class _Greedy:
    problem: Problem

    def mission(self, seed: int) -> Next:  # noqa: ARG002
        from fieldhand_bench.orienteering.greedy import Greedy

        return Greedy(self.problem).next


@dataclass(frozen=True, eq=False)
class _TreeSearch:
    problem: Problem
    simulations: int

    def mission(self, seed: int) -> Next:
        from fieldhand_bench.orienteering.mcts import TreeSearch

        return TreeSearch(self.problem, seed, self.simulations).next


def prepare(name: str, problem: Problem, options: Options) -> Prepared:
    """Do what a solver does before its missions.

    Raises:
        ProblemError: No solver has that name, or it finds nothing.
    """
    match name:
        case "online":
            from fieldhand.orienteering.price_tuning import tune_price

            policy = Policy(problem, options.seed, risk_tolerance=options.daring)
            return _Online(tune_price(policy, problem, options.seed + 1, options.missions))
        case "fixed":
            return _Fixed(solve(problem, options.seed, StoppingCriterion(rounds=20_000)).vertices)
        case "greedy":
            return _Greedy(problem)
        case "mcts":
            return _TreeSearch(problem, options.simulations)
        case "milp":
            from fieldhand_bench.orienteering.milp import solve_milp

            return _Fixed(solve_milp(problem, options.seed, options.milp_s).vertices)
        case _:
            raise ProblemError(f"no solver is called '{name}'", advice=f"use {', '.join(NAMES)}")
