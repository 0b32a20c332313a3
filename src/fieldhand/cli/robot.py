"""``fieldhand robot``: describe a robot; ``robot calibrate`` and ``robot check`` are in files of their own."""

from __future__ import annotations

from pathlib import Path
from typing import TYPE_CHECKING, Annotated

import typer

from fieldhand.cli.calibrate import calibrate
from fieldhand.cli.default_command import GroupWithDefault
from fieldhand.cli.options import JsonOption
from fieldhand.cli.outputs import to_file
from fieldhand.cli.robot_check import check

if TYPE_CHECKING:
    from fieldhand.robot.model import Action, RobotProfile


class _ShowByDefault(GroupWithDefault):
    """``fieldhand robot husky`` is ``fieldhand robot show husky``."""

    default = "show"


robot = typer.Typer(
    name="robot",
    cls=_ShowByDefault,
    help="Describe a robot (fieldhand robot husky), check its profile, or fit it to the cost of its missions.",
    no_args_is_help=True,
)
robot.command("calibrate")(calibrate)
robot.command("check")(check)


@robot.command("show")
def show_robot(
    name: Annotated[str, typer.Argument(help="Built-in robot (husky, amiga, tractor) or a profile file (YAML).")],
    xsd: Annotated[
        Path | None, typer.Option("--xsd", callback=to_file, help="Write the schema of this robot's Tasks here.")
    ] = None,
    yaml: Annotated[
        Path | None, typer.Option("--yaml", callback=to_file, help="Write its profile here, to be changed.")
    ] = None,
    json: JsonOption = False,
) -> None:
    """Describe what a robot can do and measure; --xsd writes the schema of its Tasks, --yaml its profile."""
    from dataclasses import asdict

    from fieldhand.cli import show
    from fieldhand.robot.loader import parse_profile, profile_bytes

    data, source = profile_bytes(name)
    profile = parse_profile(data, source=source)
    if xsd is not None:
        from fieldhand.cli.inputs import write_file
        from fieldhand.robot.capabilities import capabilities_of
        from fieldhand.task.schema import schema_xsd

        write_file(xsd, schema_xsd(capabilities_of(profile)))
    if yaml is not None:
        from fieldhand.cli.inputs import write_file

        write_file(yaml, data)
    if json:
        show.print_json(asdict(profile))
        return
    for line in _lines(profile):
        show.out.print(line)
    if xsd is not None:
        show.out.print(f"Schema: {xsd}")
    if yaml is not None:
        show.out.print(f"Profile: {yaml}")


def _lines(profile: RobotProfile) -> list[str]:
    from fieldhand.cli.bindings import binding_lines

    energy = profile.energy
    battery = energy.levels(energy.reserve_percent)
    lines = [
        f"{profile.name}: {profile.description}",
        f"  drives {profile.speed_m_s:g} m/s, {profile.width_m:g} m wide, works {profile.standoff_m:g} m from a trunk",
        *([] if profile.turn_deg_s is None else [f"  turns on the spot at {profile.turn_deg_s:g} degrees/s"]),
        f"  battery {energy.capacity_j / 3.6e6:.2f} kWh, {energy.reserve_percent:g} % kept in reserve;"
        f" warns at {battery.warn:g} %, turns home at {battery.home:g} %, stops at {battery.stop:g} %",
        f"  a leg of d metres costs d·({profile.leg_cost.alpha:g} + Exp({1 - profile.leg_cost.alpha:g}))",
        "Actions",
    ]
    for action in profile.actions:
        lines.append(f"  {action.name}: {_cost(profile, action)}")
        lines.append(f"    say: {', '.join(action.words)}")
        for parameter in action.parameters:
            bounds = ", ".join(parameter.choices) or f"{parameter.minimum} to {parameter.maximum} {parameter.unit}"
            lines.append(f"    parameter {parameter.name}: {bounds.strip()}, else {parameter.default}")
    lines.append("Words for readings")
    for quantity in profile.quantities:
        levels = ", ".join(f"{w} is {lv.direction} {lv.value:g} {quantity.unit}" for w, lv in quantity.levels.items())
        lines.append(f"  {quantity.name}: {levels or 'none'}")
    if profile.events:
        lines.append("Events, detected all the time")
    for event in profile.events:
        unit = f" in {event.unit}" if event.unit else ""
        silent = "holds" if event.unless_heard == "holds" else "is ignored"
        lines.append(f"  {event.name}{unit}: {event.description}; over after {event.clear_s:g} s; {silent} if unheard")
    lines.extend(binding_lines(profile))
    return lines


#: Place of a plant that a camera on each side sees.
_BESIDE = {"left": "on its left", "right": "on its right", "front": "in front of it", "back": "behind it"}


def _cost(profile: RobotProfile, action: Action) -> str:
    """Return what an action takes, and what it measures or covers."""
    implement = action.implement
    if implement is None:
        measures = ", ".join(f"{q} ({profile.quantity[q].unit})" for q in action.measures) or "nothing"
        camera = "" if action.camera is None else f"; with the plant {_BESIDE[action.camera.side]}"
        return f"{action.duration_s:g} s, {action.energy_j:g} J; measures {measures}{camera}"
    wide = "" if implement.width_m is None else f", {implement.width_m:g} m wide"
    tank = "" if implement.tank is None else f", tank for {implement.tank:g}"
    side = {"both": "on either side", "under": "below the robot"}.get(implement.side, f"on its {implement.side} side")
    return f"while driving at {implement.speed_m_s:g} m/s, {implement.power_w:g} W{wide}, {side}{tank}"
