"""Estimate of one branch: distributions of distance, time and charge, and the probability of exceeding each limit."""

from __future__ import annotations

from collections.abc import Iterable, Sequence
from dataclasses import asdict, dataclass
from itertools import groupby

import numpy as np
from numpy.typing import NDArray

from fieldhand.forecast.resource_limits import ResourceKind, ResourceLimit, speed_of
from fieldhand.forecast.sampled_costs import SampledCharging, SampledUse
from fieldhand.forecast.walk_steps import Decision, Walk
from fieldhand.robot.model import RobotProfile
from fieldhand.short_repr import short_repr
from fieldhand.site.model import Place
from fieldhand.task.frames import Constraints, Fault

Floats = NDArray[np.float64]


@dataclass(frozen=True, kw_only=True)
class Figure:
    """Summary of a random amount: mean, median and 90th percentile."""

    mean: float
    p50: float
    p90: float


@dataclass(frozen=True, kw_only=True)
class Chance:
    """The probability of exceeding a limit.

    Attributes:
        kind: Kind of budget, or ``reserve``.
        limit: The limit in metres, seconds, or percent of a full battery.
        accepted: The failure probability that the Task accepts.
        draws: Number of sampled missions from which it was estimated.
    """

    kind: ResourceKind
    limit: float
    accepted: float
    chance: float
    draws: int

    @property
    def exceeded(self) -> bool:
        """Return True if the probability exceeds the accepted one by more than sampling noise."""
        noise = 2.0 * np.sqrt(self.accepted * (1.0 - self.accepted) / self.draws)
        return bool(self.chance > self.accepted + noise)


@dataclass(frozen=True, kw_only=True, repr=False)
class BranchEstimate:
    """The estimate of one branch.

    Attributes:
        decisions: Decisions on the branch.
        metres, seconds, percent: Resources used until the end of the mission; charge in percent of a full battery.
        left: Charge left at the end, in percent of a full battery: the median, and the value exceeded in nine missions
            out of ten.
        chances: Overrun probability of each budget, followed by that of the battery reserve.
        captures: Number of captures on the branch.
        visits: Mean number of optional visits and steps.
        shed: Places of optional visits and steps for which the budget will probably not suffice.
        charges: Number of charges; None if the mission does not recharge.
        stranding: Probability of falling to the stop level on the way to the charger or home; 0 if the mission does not
            recharge.
        charged_to: Charge in percent up to which it interrupts the plan to charge, in nine missions of ten; 0 if it
            does not.
        walk: The walk along the branch.
        fault: Fault that ends the branch at its last node; None if none does.
    """

    decisions: tuple[Decision, ...]
    metres: Figure
    seconds: Figure
    percent: Figure
    left: tuple[float, float]
    chances: tuple[Chance, ...]
    captures: int
    visits: float
    shed: tuple[Place, ...]
    walk: Walk
    fault: Fault | None = None
    charges: Figure | None = None
    stranding: float = 0.0
    charged_to: float = 0.0

    __repr__ = short_repr

    @property
    def short(self) -> float:
        """Return the highest probability of exceeding any limit."""
        return max((c.chance for c in self.chances), default=0.0)

    def as_record(self) -> dict[str, object]:
        """Return the estimate as JSON."""
        return {
            "decisions": decisions_record(self.decisions),
            "fault": self.fault,
            "distance_m": asdict(self.metres),
            "duration_s": asdict(self.seconds),
            "battery_percent": asdict(self.percent),
            "battery_left_percent": {"p50": self.left[0], "p90": self.left[1]},
            "captures": self.captures,
            **({} if self.charges is None else self._charging_record(self.charges)),
            "limits": [asdict(chance) for chance in self.chances],
        }

    def _charging_record(self, charges: Figure) -> dict[str, object]:
        return {
            "charges": asdict(charges),
            "charged_to_percent": self.charged_to,
            "stranding_probability": self.stranding,
        }


def decisions_record(decisions: Iterable[Decision]) -> list[dict[str, object]]:
    """Return decisions as JSON: for each run of decisions of one node a string of the letters y and n."""
    return [
        {"node": node, "kind": kind, "answers": "".join("y" if d.answer else "n" for d in some)}
        for (node, kind), some in groupby(decisions, key=lambda d: (d.node, d.kind))
    ]


def estimate_branch(
    walked: Walk,
    resources: Sequence[ResourceLimit],
    constraints: Constraints,
    robot: RobotProfile,
    charge_percent: float,
    fault: Fault | None = None,
) -> BranchEstimate:
    """Estimate a branch from the missions sampled along it (:attr:`Walk.used`)."""
    used = walked.used
    assert used is not None  # noqa: S101  estimates draw missions on every walk
    metres, seconds, percent = amounts(used, constraints, robot)
    charging = used.charging
    amount = {"distance_m": metres, "duration_s": seconds, "energy_percent": percent, "reserve": percent}
    lists = [s for s in walked.steps if s.node.is_optional and s.kind == "visit-list"]
    energy = _figure(percent)
    left = charge_percent - percent if charging is None else charging.left
    return BranchEstimate(
        decisions=walked.decisions,
        metres=_figure(metres),
        seconds=_figure(seconds),
        percent=energy,
        left=(max(0.0, float(np.quantile(left, 0.5))), max(0.0, float(np.quantile(left, 0.1)))),
        chances=tuple(
            Chance(
                kind=r.kind,
                limit=r.limit,
                accepted=r.failure_probability,
                chance=_overrun(r, amount[r.kind], charging, charge_percent),
                draws=len(metres),
            )
            for r in resources
        ),
        captures=sum(s.captures for s in walked.steps),
        visits=sum(s.visit_forecast.visits for s in lists if s.visit_forecast is not None),
        shed=tuple(p for s in lists for p in s.shed),
        charges=None if charging is None else _figure(charging.charges),
        stranding=0.0 if charging is None else float(np.minimum(charging.stranding, 1.0).mean()),
        charged_to=0.0 if charging is None else float(np.quantile(charging.charged_to, 0.9)),
        walk=walked,
        fault=fault,
    )


def _overrun(limit: ResourceLimit, used: Floats, charging: SampledCharging | None, charge_percent: float) -> float:
    """Return the fraction of missions that exceed a limit; with recharging, those that arrive below the reserve."""
    if limit.kind == "reserve" and charging is not None:
        reserve = charge_percent - limit.limit
        return float((charging.lowest < reserve - 1e-9).mean())
    return float((used > limit.limit * (1 + 1e-9)).mean())


def amounts(used: SampledUse, constraints: Constraints, robot: RobotProfile) -> tuple[Floats, Floats, Floats]:
    """Return metres, seconds and percent of a full battery per sampled mission."""
    metres, seconds = used.metres, used.metres / speed_of(constraints, robot) + used.seconds
    driving, idling = robot.percent(1.0, 0.0), robot.percent(0.0, 1.0)
    docked_s = 0.0 if used.charging is None else used.charging.docked_s
    return (
        metres,
        seconds,
        driving * metres + idling * (seconds - docked_s) + robot.percent(0.0, 0.0, 1.0) * used.joules,
    )


def _figure(draws: Floats) -> Figure:
    median, high = np.quantile(draws, (0.5, 0.9)).tolist()
    return Figure(mean=float(draws.mean()), p50=median, p90=high)
