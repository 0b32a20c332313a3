"""Calibration of a robot's cost model from its missions."""

from __future__ import annotations

import math
from collections.abc import Mapping, Sequence
from dataclasses import dataclass, field, replace

import numpy as np

from fieldhand.errors import InputError
from fieldhand.evaluation.calibration.estimators import (
    FittedValue,
    LegFit,
    apart,
    fit_legs,
    fit_mean,
    fit_ratio,
    fit_shares,
    plausible,
)
from fieldhand.evaluation.calibration.measured_steps import MeasuredMission, MeasuredStep, predicted
from fieldhand.robot.model import LegCost, RobotProfile

#: Fewer legs, or captures of an action, than these say too little.
LEAST_LEGS, LEAST_CAPTURES = 20, 5
#: Shorter legs are mostly the error of the odometry.
SHORTEST_M = 1.0
_FOLDS = 5


@dataclass(frozen=True, kw_only=True)
class CostModelFit:
    """A fitted cost model; what the data do not determine is None or missing and stays as in the profile.

    Attributes:
        legs: Alpha and scale; metres driven are ``scale`` times those planned, on average.
        speed: Metres driven a second.
        drive, idle: Joules a metre driven, and watts all the time.
        durations, energies: Seconds and joules of one capture, by action.
        kept: What the data could not determine, in words.
    """

    legs: LegFit
    speed: FittedValue | None = None
    drive: FittedValue | None = None
    idle: FittedValue | None = None
    durations: Mapping[str, FittedValue] = field(default_factory=dict)
    energies: Mapping[str, FittedValue] = field(default_factory=dict)
    kept: tuple[str, ...] = ()

    @property
    def stretch(self) -> float:
        """Return metres driven per metre planned; 1 if the legs do not show otherwise."""
        return 1.0 if self.legs.scale.contains(1.0) else self.legs.scale.value

    def profile(self, robot: RobotProfile) -> RobotProfile:
        """Return the profile with the fitted values, for metres as planned."""
        energy = robot.energy
        drive = self.drive.value * self.stretch if self.drive else energy.drive_j_per_m
        idle = self.idle.value if self.idle else energy.idle_w
        actions = tuple(
            replace(
                a,
                duration_s=self.durations[a.name].value if a.name in self.durations else a.duration_s,
                energy_j=self.energies[a.name].value if a.name in self.energies else a.energy_j,
            )
            for a in robot.actions
        )
        return replace(
            robot,
            actions=actions,
            speed_m_s=self.speed.value / self.stretch if self.speed else robot.speed_m_s,
            energy=replace(energy, drive_j_per_m=drive, idle_w=idle),
            leg_cost=LegCost(alpha=self.legs.alpha.value),
        )


@dataclass(frozen=True, kw_only=True)
class PredictionError:
    """Predicted against actual cost.

    Attributes:
        seconds, percent: Sum of what is predicted; ``actual`` has the same of what was used.
        errors: Mean absolute error of a step: seconds, and percent of the battery.
        beyond: Share of legs that were longer than nine in ten should be.
    """

    seconds: float
    percent: float
    errors: tuple[float, float]
    beyond: float


@dataclass(frozen=True, kw_only=True)
class Calibration:
    """A fit, its data, and its accuracy.

    Attributes:
        missions, legs, captures: Number of missions, legs and captures used.
        left_out: Steps that could not be used, by why.
        actual: Seconds and percent of the battery that the steps compared took.
        before: Prediction error of the profile before calibration.
        after: Prediction error by cross-validation.
    """

    fit: CostModelFit
    missions: int
    legs: int
    captures: int
    left_out: Mapping[str, int]
    actual: tuple[float, float]
    before: PredictionError
    after: PredictionError


def calibrate(robot: RobotProfile, missions: Sequence[MeasuredMission], *, seed: int = 0) -> Calibration:
    """Fit the cost model of a robot to its missions.

    Args:
        robot: The profile as it is.
        missions: Missions of this robot.
        seed: Seed of the draws for the intervals.

    Raises:
        InputError: There are too few legs.
    """
    steps = [step for mission in missions for step in mission.steps]
    fit = _fit(robot, steps, seed)
    if fit is None:
        legs = len(_legs(steps))
        raise InputError(
            f"{legs} legs of at least {SHORTEST_M:g} m are too few for a fit",
            where=robot.name,
            advice=f"drive more: {LEAST_LEGS} legs are the least, 200 give useful figures",
        )
    compared = [s for s in steps if _comparable(s)]
    parts = np.array_split(np.arange(len(steps)), _FOLDS)
    after: list[tuple[MeasuredStep, RobotProfile]] = []
    for part in parts:
        held = set(part.tolist())
        other = _fit(robot, [s for k, s in enumerate(steps) if k not in held], seed) or fit
        known = other.profile(robot)
        after += [(steps[k], known) for k in part.tolist() if _comparable(steps[k])]
    left_out = {
        "values that are not numbers": sum(m.left_out for m in missions),
        "legs too short": sum(s.kind == "leg" and s.done and 0 < s.planned_m < SHORTEST_M for s in steps),
        "not timed, or charge not known": sum(
            s.kind != "rest" and not (s.sure and math.isfinite(s.seconds)) for s in steps
        ),
    }
    return Calibration(
        fit=fit,
        missions=len(missions),
        legs=len(_legs(steps)),
        captures=sum(s.kind == "capture" for s in steps),
        left_out={why: count for why, count in left_out.items() if count},
        actual=(math.fsum(s.seconds for s in compared), math.fsum(s.percent for s in compared)),
        before=_quality([(s, robot) for s in compared]),
        after=_quality(after),
    )


def _fit(robot: RobotProfile, steps: Sequence[MeasuredStep], seed: int) -> CostModelFit | None:
    legs = _legs(steps)
    if len(legs) < LEAST_LEGS:
        return None
    ratios = np.array([s.metres / s.planned_m for s in legs])
    fit = CostModelFit(legs=fit_legs(ratios, np.random.default_rng(seed)))
    fit = replace(fit, speed=_speed(robot, legs), durations=_durations(robot, steps))
    fit = _with_energy(fit, robot, steps)
    kept = list(fit.kept)
    if fit.speed is None:
        kept.append("speed: too few legs at the robot's own speed")
    kept += [f"{a.name}: fewer than {LEAST_CAPTURES} captures" for a in robot.actions if a.name not in fit.durations]
    return replace(fit, kept=tuple(kept))


def _comparable(step: MeasuredStep) -> bool:
    return step.done and step.sure and math.isfinite(step.seconds) and step.kind != "rest"


def _legs(steps: Sequence[MeasuredStep]) -> list[MeasuredStep]:
    return [s for s in steps if s.kind == "leg" and s.done and s.planned_m >= SHORTEST_M and s.metres > 0]


def _speed(robot: RobotProfile, legs: Sequence[MeasuredStep]) -> FittedValue | None:
    """Fit the speed on legs driven at the robot's own speed."""
    free = [s for s in legs if s.seconds > 0 and not s.speed_m_s < robot.speed_m_s * (1 - 1e-9)]
    if len(free) < LEAST_LEGS:
        return None
    metres, seconds = np.array([s.metres for s in free]), np.array([s.seconds for s in free])
    sound = plausible((seconds / metres).tolist())
    pace = fit_ratio(seconds[sound], metres[sound])
    slowest = 1.0 / pace.high
    return FittedValue(value=1.0 / pace.value, low=slowest, high=1.0 / max(pace.low, 1e-9), count=pace.count)


def _durations(robot: RobotProfile, steps: Sequence[MeasuredStep]) -> dict[str, FittedValue]:
    found = {}
    for action in robot.actions:
        seconds = [s.seconds for s in steps if s.kind == "capture" and s.name == action.name and s.done]
        timed = np.array([t for t in seconds if math.isfinite(t) and t > 0])
        timed = timed[plausible(timed.tolist())] if len(timed) else timed
        if len(timed) >= LEAST_CAPTURES:
            found[action.name] = fit_mean(timed)
    return found


def _with_energy(fit: CostModelFit, robot: RobotProfile, steps: Sequence[MeasuredStep]) -> CostModelFit:
    """Fit energy by metres, time and captures; what cannot be distinguished stays as in the profile."""
    rows = [s for s in steps if s.sure and s.whole_s > 0]
    counts = {a.name: np.array([float(s.name == a.name and s.kind == "capture") for s in rows]) for a in robot.actions}
    asked = [name for name, made in counts.items() if made.sum() >= LEAST_CAPTURES]
    joules = np.array([s.percent for s in rows]) * robot.energy.capacity_j / 100.0
    for action in robot.actions:
        if action.name not in asked and len(rows):
            joules = joules - action.energy_j * counts[action.name]
    metres, seconds = np.array([s.moved_m for s in rows]), np.array([s.whole_s for s in rows])
    causes = [metres, *(counts[name] for name in asked)]
    with_time = np.column_stack([*causes, seconds]) if len(rows) else np.zeros((0, 0))
    if len(rows) < len(causes) + 1 + LEAST_LEGS or not apart(with_time[:, :-1]):
        return replace(fit, kept=("energy: the log contains too few charge values",))
    if apart(with_time):
        found = fit_shares(with_time, joules)
        return replace(fit, drive=found[0], idle=found[-1], energies=dict(zip(asked, found[1:-1], strict=True)))
    found = fit_shares(with_time[:, :-1], joules - robot.energy.idle_w * seconds)
    why = (
        "idle_w: it cannot be separated from driving and capturing, which always took the same time; drive some"
        " missions slower, or let the robot wait"
    )
    return replace(fit, drive=found[0], energies=dict(zip(asked, found[1:], strict=True)), kept=(why,))


def _quality(pairs: Sequence[tuple[MeasuredStep, RobotProfile]]) -> PredictionError:
    expected = [predicted(step, robot) for step, robot in pairs]
    apart_s = [abs(s.seconds - e[0]) for (s, _), e in zip(pairs, expected, strict=True)]
    apart_percent = [abs(s.percent - e[1]) for (s, _), e in zip(pairs, expected, strict=True)]
    long = [
        # In the profile's own terms: a leg's metres are those that its time stands for.
        s.seconds * min(r.speed_m_s, s.speed_m_s if s.speed_m_s > 0 else math.inf) > s.planned_m * _nine_in_ten(r)
        for s, r in pairs
        if s.kind == "leg" and s.planned_m >= SHORTEST_M
    ]
    return PredictionError(
        seconds=math.fsum(e[0] for e in expected),
        percent=math.fsum(e[1] for e in expected),
        errors=(math.fsum(apart_s) / max(1, len(pairs)), math.fsum(apart_percent) / max(1, len(pairs))),
        beyond=sum(long) / max(1, len(long)),
    )


def _nine_in_ten(robot: RobotProfile) -> float:
    """Return metres driven per metre planned that nine legs in ten stay within."""
    alpha = robot.leg_cost.alpha
    return alpha + (1.0 - alpha) * math.log(10.0)
