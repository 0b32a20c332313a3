"""``fieldhand robot calibrate``: fit the profile of a robot to the cost of its missions."""

from __future__ import annotations

from collections.abc import Iterator
from pathlib import Path
from typing import TYPE_CHECKING, Annotated, Any

import typer

from fieldhand.cli.options import JsonOption
from fieldhand.cli.outputs import to_file

if TYPE_CHECKING:
    from fieldhand.evaluation.calibration.calibrate import Calibration
    from fieldhand.evaluation.calibration.estimators import FittedValue
    from fieldhand.robot.model import RobotProfile


def calibrate(
    name: Annotated[str, typer.Argument(metavar="ROBOT", help="Built-in robot or a profile file (YAML).")] = "husky",
    events: Annotated[
        list[Path] | None, typer.Argument(help="Event logs of its missions; else the recorded missions.")
    ] = None,
    output: Annotated[
        Path | None, typer.Option("-o", "--out", callback=to_file, help="Write the new profile (YAML) here.")
    ] = None,
    simulated: Annotated[
        bool, typer.Option("--simulated", help="Fit to recorded missions in simulation, not to driven ones.")
    ] = False,
    json: JsonOption = False,
) -> None:
    """Fit speed, energy, durations and the spread of legs to past missions, and show how well that predicts them."""
    import os
    from datetime import datetime

    from fieldhand import finished_missions
    from fieldhand.cli import show
    from fieldhand.cli.inputs import write_file
    from fieldhand.compatibility import UTC
    from fieldhand.robot.loader import load_robot

    robot = load_robot(name)
    missions = finished_missions.measured_missions(
        robot, events or (), finished_missions.history_folder(os.environ), simulated=simulated
    )
    calibration = finished_missions.calibrate(robot, missions)
    if output is not None:
        write_file(output, finished_missions.calibrated_profile(robot, calibration, at=datetime.now(UTC)))
    if json:
        show.print_json(_record(robot, calibration, output))
        return
    for line in _lines(robot, calibration):
        show.out.print(line, highlight=False)
    if output is not None:
        show.out.print_lines("", f"Profile: {output}")
        show.out.print("  This is a new profile: missions that were approved for the old one must be approved again.")
    else:
        show.out.print_lines("", "Give -o profile.yaml to write the new profile.")


def _rows(robot: RobotProfile, calibration: Calibration) -> Iterator[tuple[str, float, FittedValue | None, str]]:
    """Yield name, value in the profile, fitted value and unit of each figure."""
    fit, energy = calibration.fit, robot.energy
    yield "leg cost, alpha", robot.leg_cost.alpha, fit.legs.alpha, ""
    yield "metres driven for one planned", 1.0, fit.legs.scale, ""
    yield "speed", robot.speed_m_s, fit.speed, "m/s"
    yield "driving", energy.drive_j_per_m, fit.drive, "J/m"
    yield "idle", energy.idle_w, fit.idle, "W"
    for action in robot.actions:
        yield f"{action.name}, duration", action.duration_s, fit.durations.get(action.name), "s"
        yield f"{action.name}, energy", action.energy_j, fit.energies.get(action.name), "J"


def _lines(robot: RobotProfile, calibration: Calibration) -> Iterator[str]:
    from fieldhand.language.words import say_count

    yield (
        f"{robot.name}: {say_count(calibration.missions, 'mission')}, {say_count(calibration.legs, 'leg')},"
        f" {say_count(calibration.captures, 'capture')}"
    )
    for why, count in calibration.left_out.items():
        yield f"  left out: {count} ({why})"
    yield "Fitted (with 95 % confidence)"
    for what, before, fitted, unit in _rows(robot, calibration):
        if fitted is None:
            yield f"  {what:<38} {before:>10.4g} {unit:<4} kept"
            continue
        yield (
            f"  {what:<38} {fitted.value:>10.4g} {unit:<4} {fitted.low:.4g} to {fitted.high:.4g}"
            f" from {fitted.count}; was {before:.4g}"
        )
    for why in calibration.fit.kept:
        yield f"  kept {why}"
    if calibration.fit.stretch != 1.0:
        longer = 100 * (calibration.fit.stretch - 1)
        yield (
            f"  Legs are {longer:+.1f} % longer than planned: speed and energy in the profile are per planned metre."
            " A distance budget is still compared with the odometer."
        )
    if calibration.fit.legs.likely < 0.01:
        yield "  The legs do not spread as the model says (Kolmogorov-Smirnov, p < 0.01): take its chances with care."
    seconds, percent = calibration.actual
    yield "Predicted against actual (after: by fits that had not seen what they predict)"
    for when, quality in (("before", calibration.before), ("after", calibration.after)):
        yield (
            f"  {when:<7} time {_off(quality.seconds, seconds)}, {quality.errors[0]:.2f} s a step;"
            f" battery {_off(quality.percent, percent)}, {quality.errors[1]:.4f} % a step;"
            f" {100 * quality.beyond:.0f} % of the legs longer than nine in ten should be"
        )


def _off(predicted: float, actual: float) -> str:
    return f"{100 * (predicted / actual - 1):+.1f} %" if actual else "unknown"


def _record(robot: RobotProfile, calibration: Calibration, output: Path | None) -> dict[str, Any]:
    from dataclasses import asdict

    return {
        "robot": robot.name,
        "robot_sha256": robot.sha256,
        **{key: value for key, value in asdict(calibration).items() if key != "fit"},
        "figures": {
            what: {"before": before, "unit": unit, **({} if fitted is None else asdict(fitted))}
            for what, before, fitted, unit in _rows(robot, calibration)
        },
        "likely": calibration.fit.legs.likely,
        "kept": list(calibration.fit.kept),
        "profile": None if output is None else str(output),
    }
