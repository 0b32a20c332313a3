"""Benchmark graphs: JSON files with coordinates, rewards, start and end."""

from __future__ import annotations

import json
from pathlib import Path

import numpy as np
from pydantic import BaseModel, ConfigDict, Field, ValidationError

from fieldhand.errors import ProblemError
from fieldhand.orienteering.costs import CostModel
from fieldhand.orienteering.problem import Limit, Problem


class BenchmarkGraph(BaseModel):
    """A graph file. Distances are straight lines, in the unit of the coordinates."""

    model_config = ConfigDict(frozen=True)

    name: str = Field(min_length=1)
    xy: tuple[tuple[float, float], ...]
    reward: tuple[float, ...]
    start: int = 0
    end: int = -1
    alpha: float = 0.5

    def problem(self, budget: float, failure_probability: float, costs: CostModel | None = None) -> Problem:
        """Return the orienteering problem on the graph; a negative ``end`` counts from the last vertex."""
        xy = np.array(self.xy, dtype=np.float64).reshape(-1, 2)
        return Problem(
            distances=np.hypot(*(xy[:, None] - xy[None]).transpose(2, 0, 1)),
            rewards=np.array(self.reward, dtype=np.float64),
            start=self.start,
            end=self.end if self.end >= 0 else len(xy) + self.end,
            limits=(Limit(budget=budget, failure_probability=failure_probability),),
            alpha=self.alpha,
            costs=costs,
        )


def load_graphs(folder: Path) -> tuple[BenchmarkGraph, ...]:
    """Load a graph file, or every ``*.json`` file of a folder, in order of size.

    Raises:
        ProblemError: There is no file, or a file is not a graph.
    """
    files = [folder] if folder.is_file() else sorted(folder.glob("*.json"))
    if not files:
        raise ProblemError("no graphs there", where=str(folder), advice="name a folder with *.json graphs")
    return tuple(sorted((_load(file) for file in files), key=lambda g: (len(g.xy), g.name)))


def _load(file: Path) -> BenchmarkGraph:
    try:
        return BenchmarkGraph.model_validate(json.loads(file.read_text(encoding="utf-8")))
    except OSError as error:
        raise ProblemError(f"cannot be read: {error.strerror}", where=str(file)) from error
    except ValidationError as error:
        first = error.errors()[0]
        at = ".".join(str(part) for part in first["loc"])
        raise ProblemError(f"no graph: {at}: {first['msg']}", where=str(file)) from error
    except ValueError as error:
        raise ProblemError(f"no JSON: {error}", where=str(file)) from error
