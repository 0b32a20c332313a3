"""The sample-average mixed-integer program for a fixed route, solved by HiGHS within a time limit.

Binary ``x`` selects the legs, ``u`` orders the vertices (Miller, Tucker and Zemlin 1960), and binary ``z`` marks the
sampled worlds in which the budget may be exceeded: at most the failure probability times their number.
Source: Varakantham and Kumar, *Optimization approaches for solving chance constrained stochastic orienteering
problems*, 2013.
"""

from __future__ import annotations

from dataclasses import dataclass
from typing import TYPE_CHECKING

import numpy as np
from numpy.typing import NDArray

from fieldhand.errors import ProblemError
from fieldhand.orienteering.problem import Problem

if TYPE_CHECKING:
    from highspy import HighsLp

Floats = NDArray[np.float64]

#: Maximum excess in a sampled world in which the budget may be exceeded, in multiples of the budget.
_MORE = 2.0


@dataclass(frozen=True, kw_only=True)
class MilpRoute:
    """A route found by the mixed-integer program.

    Attributes:
        vertices: Vertices of the route, from start to end.
        reward: Total reward of its stops.
        bound: Upper bound on the reward of any route that satisfies the sampled constraint.
        optimal: True if the route was proven optimal.
    """

    vertices: tuple[int, ...]
    reward: float
    bound: float
    optimal: bool


def solve_milp(problem: Problem, seed: int, seconds: float, samples: int = 40) -> MilpRoute:
    """Return the best fixed route over sampled worlds that HiGHS finds in the given time.

    Args:
        problem: Problem with one limit and distances, without legs after the end.
        seed: Random seed of the samples.
        seconds: Time limit, seconds.
        samples: Number of sampled worlds.

    Raises:
        ProblemError: More than one limit, legs after the end, no distances, or no route found in the time.
    """
    import highspy

    if len(problem.limits) != 1 or not len(problem.distances) or problem.legs_after or problem.start == problem.end:
        raise ProblemError("the programme takes problems with distances, one limit and two ends only")
    n = problem.size
    ends = [(i, j) for i in range(n) for j in range(n) if i != j and i != problem.end and j != problem.start]
    model = _model(problem, ends, np.random.default_rng(seed), samples)
    solver = highspy.Highs()  # type: ignore[no-untyped-call]
    solver.setOptionValue("output_flag", False)
    solver.setOptionValue("time_limit", float(seconds))
    solver.setOptionValue("random_seed", int(seed) % 2**31)
    solver.setOptionValue("threads", 1)
    solver.passModel(model)
    solver.run()
    info = solver.getInfo()
    if info.primal_solution_status != 2:
        raise ProblemError(f"HiGHS found no route in {seconds:g} s", advice="raise --milp-time")
    taken = np.array(solver.getSolution().col_value)[: len(ends)] > 0.5
    following = {i: j for (i, j), on in zip(ends, taken, strict=True) if on}
    route = [problem.start]
    while route[-1] != problem.end:
        route.append(following[route[-1]])
    return MilpRoute(
        vertices=tuple(route),
        reward=float(problem.rewards[route[1:-1]].sum()),
        bound=float(info.mip_dual_bound) * -1.0,
        optimal=solver.getModelStatus() == highspy.HighsModelStatus.kOptimal,
    )


def _model(problem: Problem, ends: list[tuple[int, int]], rng: np.random.Generator, samples: int) -> HighsLp:
    import highspy
    from scipy.sparse import coo_array

    n, limit, m = problem.size, problem.limits[0], len(ends)
    i, j = np.array(ends).T
    columns = m + n + samples
    rows: list[tuple[Floats, NDArray[np.int64], float, float]] = []

    def row(positions: NDArray[np.intp], values: Floats, low: float, high: float) -> None:
        rows.append((values, positions.astype(np.int64), low, high))

    for v in range(n):
        out, into = np.flatnonzero(i == v), np.flatnonzero(j == v)
        if v == problem.start:
            row(out, np.ones(len(out)), 1.0, 1.0)
        elif v == problem.end:
            row(into, np.ones(len(into)), 1.0, 1.0)
        else:
            row(out, np.ones(len(out)), 0.0, 1.0)
            row(np.concatenate([out, into]), np.repeat([1.0, -1.0], [len(out), len(into)]), 0.0, 0.0)
    for leg, (a, b) in enumerate(ends):
        row(np.array([m + a, m + b, leg]), np.array([1.0, -1.0, float(n)]), -np.inf, n - 1.0)
    if problem.max_visits is not None:
        rewarded = np.flatnonzero((problem.rewards[j] > 0.0) & (j != problem.end))
        row(rewarded, np.ones(len(rewarded)), 0.0, float(problem.max_visits))
    lengths = problem.distances[i, j]
    service = 0.0 if limit.service is None else limit.service[j]
    for q in range(samples):
        costs = lengths * problem.model.draw(rng, m) + service
        positions = np.append(np.arange(m), m + n + q)
        row(positions, np.append(costs, -_MORE * limit.budget), -np.inf, limit.budget)
    allowed = float(int(limit.failure_probability * samples + 1e-9))
    row(m + n + np.arange(samples), np.ones(samples), 0.0, allowed)
    lengths_of = [len(r[0]) for r in rows]
    entries = coo_array(
        (np.concatenate([r[0] for r in rows]),
         (np.repeat(np.arange(len(rows)), lengths_of), np.concatenate([r[1] for r in rows]))),
        shape=(len(rows), columns),
    ).tocsr()  # fmt: skip
    worth = problem.rewards.copy()
    worth[[problem.start, problem.end]] = 0.0
    model = highspy.HighsLp()
    model.num_col_, model.num_row_ = columns, len(rows)
    model.col_cost_ = np.concatenate([-worth[j], np.zeros(n + samples)])
    model.col_lower_ = np.zeros(columns)
    model.col_upper_ = np.concatenate([np.ones(m), np.full(n, float(n)), np.ones(samples)])
    model.row_lower_ = np.array([r[2] for r in rows])
    model.row_upper_ = np.array([r[3] for r in rows])
    model.a_matrix_.format_ = highspy.MatrixFormat.kRowwise
    model.a_matrix_.start_ = entries.indptr
    model.a_matrix_.index_ = entries.indices
    model.a_matrix_.value_ = entries.data
    whole, real = highspy.HighsVarType.kInteger, highspy.HighsVarType.kContinuous
    model.integrality_ = [whole] * m + [real] * n + [whole] * samples
    return model
