"""The rows of the published experiment, their published verdicts and their cases (``published.yaml``)."""

from __future__ import annotations

from collections.abc import Iterable
from dataclasses import dataclass
from functools import cache
from importlib import resources
from typing import Literal

import yaml

from fieldhand_bench.missions.trial import CaseTrial


@dataclass(frozen=True, kw_only=True)
class PublishedRow:
    """A row of the published table.

    Attributes:
        case: Id of the case that reproduces the row.
        row: Title of the row.
        spatial: True if the request refers to places other than by the ids of trees.
        verdict: Published verdict on the published system.
    """

    case: str
    row: str
    spatial: bool
    verdict: Literal["right", "wrong", "far from best"]


@dataclass(frozen=True, kw_only=True)
class Tally:
    """Counts of the rows of one kind: tried, fulfilled as asked here, and published as right."""

    spatial: bool
    tried: int
    as_asked: int
    published_right: int


@cache
def published() -> tuple[PublishedRow, ...]:
    """Return the rows in the order in which they were published."""
    text = (resources.files("fieldhand_bench.missions") / "published.yaml").read_text(encoding="utf-8")
    return tuple(PublishedRow(**row) for row in yaml.safe_load(text))


def row_of(case: str) -> PublishedRow | None:
    """Return the row that a case reproduces; None if it reproduces none."""
    return next((row for row in published() if row.case == case), None)


def sorted_by_row(trials: Iterable[CaseTrial]) -> tuple[CaseTrial, ...]:
    """Sort trials: rows of the published table first, in its order, then all others in their own order."""
    place = {row.case: number for number, row in enumerate(published())}
    return tuple(sorted(trials, key=lambda trial: place.get(trial.id, len(place))))


def tallies(trials: Iterable[CaseTrial]) -> tuple[Tally, ...]:
    """Count the rows that are not spatial, then those that are; kinds without trials are left out."""
    known = [(row, trial) for trial in trials if (row := row_of(trial.id)) is not None]
    return tuple(
        Tally(
            spatial=spatial,
            tried=len(ours),
            as_asked=sum(trial.as_asked for _, trial in ours),
            published_right=sum(row.verdict == "right" for row, _ in ours),
        )
        for spatial in (False, True)
        if (ours := [(row, trial) for row, trial in known if row.spatial is spatial])
    )
