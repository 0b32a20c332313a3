"""Choose the side from which each row's trees are worked on, so that the robot drives through few aisles."""

from __future__ import annotations

import math
from collections.abc import Mapping, Sequence
from dataclasses import dataclass, field

from fieldhand.site.driving.stands import Candidate, LaneKey

#: Cost of a choice: number of lanes to drive through, then metres from the robot to the stands.
Cost = tuple[int, float]


@dataclass(frozen=True)
class RowVisits:
    """The visits of one row: for each the reachable stands by lane, with the metres to them."""

    below: LaneKey
    above: LaneKey
    visits: list[Mapping[LaneKey, tuple[Candidate, float]]] = field(default_factory=list)


def choose_lanes(rows: Mapping[tuple[int, int], RowVisits], used: frozenset[LaneKey]) -> dict[tuple[int, int], LaneKey]:
    """Return the preferred lane of each row, by (group, line).

    Dynamic programming over the rows of a group; the state is whether the lane above the last row is driven through.
    Lanes that are used anyway cost nothing.
    """
    chosen: dict[tuple[int, int], LaneKey] = {}
    for group in sorted({group for group, _ in rows}):
        lines = sorted(line for g, line in rows if g == group)
        # Cost and chosen lanes so far, by the lanes above the last row that are driven through.
        best: dict[frozenset[LaneKey], tuple[Cost, tuple[LaneKey, ...]]] = {frozenset(): ((0, 0.0), ())}
        for line in lines:
            row = rows[group, line]
            following: dict[frozenset[LaneKey], tuple[Cost, tuple[LaneKey, ...]]] = {}
            for open_, ((count, metres), before) in best.items():
                for lane in (row.below, row.above):
                    lanes, far = _taken(row, lane)
                    new = lanes - open_ - used
                    cost = (count + len(new), metres + far)
                    still = frozenset(lanes & {row.above})
                    if still not in following or cost < following[still][0]:
                        following[still] = (cost, (*before, lane))
            best = following
        _, lanes_chosen = min(best.values())
        chosen.update({(group, line): lane for line, lane in zip(lines, lanes_chosen, strict=True)})
    return chosen


def _taken(row: RowVisits, lane: LaneKey) -> tuple[frozenset[LaneKey], float]:
    """Return the lanes that the visits of a row use if this lane is preferred, and the metres to their stands."""
    lanes, metres = set(), 0.0
    for visit in row.visits:
        at = lane if lane in visit else next(iter(visit), None)
        if at is not None:
            lanes.add(at)
            metres += visit[at][1]
    return frozenset(lanes), metres


def pick_candidate(candidates: Sequence[Candidate], lane: LaneKey | None, metres: Sequence[float]) -> Candidate:
    """Return the candidate in the preferred lane, else the nearest reachable one, else the first."""
    able = [k for k, m in enumerate(metres) if math.isfinite(m)]
    if not able:
        return candidates[0]
    return next(
        (candidates[k] for k in able if lane is not None and candidates[k].lane == lane),
        candidates[min(able, key=lambda k: metres[k])],
    )
