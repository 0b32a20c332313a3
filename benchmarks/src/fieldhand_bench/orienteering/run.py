"""Drive missions with every solver on every graph, and say what they collected and how often they failed."""

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
from fieldhand_bench.orienteering.graphs import Graph
from fieldhand_bench.orienteering.solvers import Options, prepare

Floats = NDArray[np.float64]

_BATCH = 50
_Z = 1.959964


@dataclass(frozen=True, kw_only=True)
class Row:
    """What one solver did on one graph.

    Attributes:
        graph, solver: Their names.
        budget, failure_probability: Of the missions.
        trials: How many were driven.
        reward: Mean over the missions that kept to the budget, every vertex arrived at counted, the end's too.
        reward_interval: Its 95 % confidence interval.
        reward_over_all: Mean over all missions, where one over budget counts 0.
        failures: Part of the missions that went over budget.
        failures_interval: Its 95 % confidence interval (Wilson).
        median_ms, p99_ms: Time of a decision, in each process after its first mission.
        plan_s: Time before the first mission, compilation not counted.
        peak_mb: Most memory of a process that drove missions, with Python and its libraries.
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
    graphs: Sequence[Graph],
    *,
    budget: float,
    failure_probability: float,
    trials: int,
    solvers: Sequence[str],
    options: Options,
    engine: str = "local",
    jobs: int = -1,
) -> Iterator[Row]:
    """One row for each graph and solver, as they are done. The same seed gives the same rewards on any engine.

    Args:
        graphs: What to drive on.
        budget, failure_probability: Of every mission.
        trials: Missions for each row.
        solvers: Names, see :func:`fieldhand_bench.orienteering.solvers.solver_names`; ``perfect`` is a bound.
        options: Of the solvers.
        engine, jobs: See :func:`fieldhand_bench.orienteering.engine.spread`.

    Raises:
        ProblemError: A graph, a budget, a probability or a solver that is none.
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
    """95 % confidence interval of a probability of which ``part`` was seen in ``count`` trials."""
    square = _Z**2 / count
    middle = (part + 0.5 * square) / (1.0 + square)
    half = _Z / (1.0 + square) * np.sqrt(part * (1.0 - part) / count + 0.25 * square / count)
    # Where none or all failed, rounding may leave the part itself outside.
    return max(0.0, min(part, float(middle - half))), min(1.0, max(part, float(middle + half)))


def _prepare(solver: str, problem: Problem, options: Options) -> tuple[PreparedSolver, float]:
    if solver in {"online", "fixed"}:
        # Compile first: that is waited for once in the life of an installation.
        prepare("fixed", problem, options)
        simulate_mission(problem, prepare("online", problem, _once(options)).mission(0), np.random.default_rng(0))
    began = time.perf_counter()
    prepared = prepare(solver, problem, options)
    return prepared, time.perf_counter() - began


def _once(options: Options) -> Options:
    return Options(seed=options.seed, daring=options.daring, missions=1)


def _drive(piece: _Piece) -> _Driven:
    """Missions with the given seeds; at the top of the module so that other processes find it."""
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


def _row(graph: Graph, solver: str, problem: Problem, driven: Sequence[_Driven], plan_s: float) -> Row:
    rewards, kept = np.concatenate([d.rewards for d in driven]), np.concatenate([d.kept for d in driven])
    seconds = np.concatenate([d.seconds for d in driven])
    good = rewards[kept]
    mean = float(good.mean()) if len(good) else 0.0
    half = _Z * float(good.std(ddof=1)) / np.sqrt(len(good)) if len(good) > 1 else 0.0
    failures = float(1.0 - kept.mean())
    return Row(
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
