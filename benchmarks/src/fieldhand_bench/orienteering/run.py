"""Simulate missions with every solver on every graph, and compute rewards, failures and decision times."""

from __future__ import annotations

import sys
import time
from collections.abc import Callable, Iterator, Sequence
from dataclasses import dataclass

import numpy as np
from numpy.typing import NDArray

from fieldhand.orienteering.policy import State
from fieldhand.orienteering.prepared_solver import PreparedSolver
from fieldhand.orienteering.problem import Problem
from fieldhand.orienteering.simulated_mission import simulate_mission
from fieldhand_bench.orienteering.bound import with_perfect_information
from fieldhand_bench.orienteering.engine import spread
from fieldhand_bench.orienteering.graphs import BenchmarkGraph
from fieldhand_bench.orienteering.solvers import Options, prepare

Floats = NDArray[np.float64]

_BATCH = 50
_Z = 1.959964


@dataclass(frozen=True, kw_only=True)
class SolverResult:
    """The results of one solver on one graph.

    Attributes:
        graph, solver: Names of graph and solver.
        budget, failure_probability: Budget of the missions and accepted probability of exceeding it.
        trials: Number of missions.
        reward: Mean reward of the missions within budget, including that of the end.
        reward_interval: 95 % confidence interval of ``reward``.
        reward_over_all: Mean reward of all missions, where one over budget counts 0.
        failures: Fraction of the missions over budget.
        failures_interval: 95 % confidence interval of ``failures`` (Wilson).
        median_ms, p99_ms: Median and 99th percentile of the decision time, without each process's first mission.
        plan_s: Preparation time before the first mission, without compilation, seconds.
        peak_mb: Peak memory of a process that ran missions, including Python and its libraries, MB.
    """

    graph: str
    solver: str
    budget: float
    failure_probability: float
    trials: int
    reward: float
    reward_interval: tuple[float, float]
    reward_over_all: float
    failures: float
    failures_interval: tuple[float, float]
    median_ms: float
    p99_ms: float
    plan_s: float
    peak_mb: float


@dataclass(frozen=True, kw_only=True, eq=False)
class _Piece:
    prepared: PreparedSolver | None
    problem: Problem
    seeds: range


@dataclass(frozen=True, kw_only=True, eq=False)
class _Driven:
    rewards: Floats
    kept: NDArray[np.bool_]
    seconds: Floats
    peak_mb: float


def run(
    graphs: Sequence[BenchmarkGraph],
    *,
    budget: float,
    failure_probability: float,
    trials: int,
    solvers: Sequence[str],
    options: Options,
    engine: str = "local",
    jobs: int = -1,
) -> Iterator[SolverResult]:
    """Yield one row per graph and solver, as they are computed. A seed gives the same rewards on any engine.

    Args:
        graphs: Graphs of the missions.
        budget, failure_probability: Budget of every mission and accepted probability of exceeding it.
        trials: Number of missions per row.
        solvers: Names, see :func:`fieldhand_bench.orienteering.solvers.solver_names`; ``perfect`` is a bound.
        options: Options of the solvers.
        engine, jobs: See :func:`fieldhand_bench.orienteering.engine.spread`.

    Raises:
        ProblemError: A graph, the budget, the probability or a solver is invalid.
    """
    for graph in graphs:
        problem = graph.problem(budget, failure_probability)
        for solver in solvers:
            prepared, plan_s = (None, 0.0) if solver == "perfect" else _prepare(solver, problem, options)
            pieces = [
                _Piece(prepared=prepared, problem=problem, seeds=range(first, min(first + _BATCH, trials)))
                for first in range(0, trials, _BATCH)
            ]
            yield _row(graph, solver, problem, spread(_drive, pieces, engine, jobs), plan_s)


def wilson(part: float, count: int) -> tuple[float, float]:
    """Return the 95 % confidence interval of a probability, given the observed fraction of ``count`` trials."""
    square = _Z**2 / count
    middle = (part + 0.5 * square) / (1.0 + square)
    half = _Z / (1.0 + square) * np.sqrt(part * (1.0 - part) / count + 0.25 * square / count)
    # If none or all failed, rounding could leave the observed fraction outside.
    return max(0.0, min(part, float(middle - half))), min(1.0, max(part, float(middle + half)))


def _prepare(solver: str, problem: Problem, options: Options) -> tuple[PreparedSolver, float]:
    if solver in {"online", "fixed"}:
        # Compile first, since compiled code is cached for later runs.
        prepare("fixed", problem, options)
        simulate_mission(problem, prepare("online", problem, _once(options)).mission(0), np.random.default_rng(0))
    began = time.perf_counter()
    prepared = prepare(solver, problem, options)
    return prepared, time.perf_counter() - began


def _once(options: Options) -> Options:
    return Options(seed=options.seed, daring=options.daring, missions=1)


def _drive(piece: _Piece) -> _Driven:
    """Simulate the missions of a piece; at module level so that other processes can import it."""
    rewards: list[float] = []
    kept: list[bool] = []
    seconds: list[float] = []
    if piece.prepared is not None:
        simulate_mission(piece.problem, piece.prepared.mission(0), np.random.default_rng(0))
    for seed in piece.seeds:
        if piece.prepared is None:
            reward, reached = with_perfect_information(piece.problem, seed)
            rewards.append(reward)
            kept.append(reached)
            continue
        mission = simulate_mission(
            piece.problem, _timed(piece.prepared.mission(seed), seconds), np.random.default_rng([7, seed])
        )
        rewards.append(mission.reward)
        kept.append(mission.kept)
    return _Driven(
        rewards=np.array(rewards), kept=np.array(kept), seconds=np.array(seconds or [0.0]), peak_mb=_peak_mb()
    )


def _timed(following: Callable[[State], int], seconds: list[float]) -> Callable[[State], int]:
    def timed(state: State) -> int:
        began = time.perf_counter()
        vertex = following(state)
        seconds.append(time.perf_counter() - began)
        return vertex

    return timed


def _row(
    graph: BenchmarkGraph, solver: str, problem: Problem, driven: Sequence[_Driven], plan_s: float
) -> SolverResult:
    rewards, kept = np.concatenate([d.rewards for d in driven]), np.concatenate([d.kept for d in driven])
    seconds = np.concatenate([d.seconds for d in driven])
    good = rewards[kept]
    mean = float(good.mean()) if len(good) else 0.0
    half = _Z * float(good.std(ddof=1)) / np.sqrt(len(good)) if len(good) > 1 else 0.0
    failures = float(1.0 - kept.mean())
    return SolverResult(
        graph=graph.name,
        solver=solver,
        budget=problem.limits[0].budget,
        failure_probability=problem.limits[0].failure_probability,
        trials=len(rewards),
        reward=mean,
        reward_interval=(float(mean - half), float(mean + half)),
        reward_over_all=float(np.where(kept, rewards, 0.0).mean()),
        failures=failures,
        failures_interval=wilson(failures, len(rewards)),
        median_ms=1e3 * float(np.median(seconds)),
        p99_ms=1e3 * float(np.quantile(seconds, 0.99)),
        plan_s=plan_s,
        peak_mb=max(d.peak_mb for d in driven),
    )


def _peak_mb() -> float:
    try:
        import resource
    except ImportError:
        return 0.0
    peak = resource.getrusage(resource.RUSAGE_SELF).ru_maxrss
    return peak / (1e6 if sys.platform == "darwin" else 1e3)
