"""Work along a path in words: what is done along which rows, through which aisles or over which area, and how much."""

from __future__ import annotations

from collections.abc import Mapping, Sequence
from typing import TYPE_CHECKING

from fieldhand.forecast.working import amount_of, implement_of, rounds_side_by_side
from fieldhand.language import Message, counted, joined, labelled, message
from fieldhand.language.words import COMPASS, listed, say_action, say_number, say_quantity, say_rounded
from fieldhand.places.selector import Selector
from fieldhand.places.wording import SelectorWording
from fieldhand.robot.model import RobotProfile
from fieldhand.site.working.stretch import Stretch
from fieldhand.task.nodes.work_along import WorkAlong

if TYPE_CHECKING:
    from fieldhand.wording.resolved_places import ResolvedPlaces

#: Square metres from which an area is given in hectares.
_HECTARE_FROM_M2 = 2_000.0


def say_work(node: WorkAlong, robot: RobotProfile, names: Mapping[str, str]) -> str:
    """Return work along a path: "spray along rows 3 to 8 at 300 l/ha, on both sides"."""
    rows = node.mode not in ("area", "perimeter")
    doing, where = _doing(node, robot), say_along(node.along, names, rows=rows, between=node.mode == "aisles")
    match node.mode:
        case "rows":
            text = message("{action} along {rows}", action=doing, rows=where)
        case "aisles" if node.every == 2:
            text = message("{action} along every other aisle between {rows}", action=doing, rows=where)
        case "aisles" if node.every > 2:
            text = message(
                "{action} along one aisle in {count} between {rows}", action=doing, count=node.every, rows=where
            )
        case "aisles":
            text = message("{action} along the aisles between {rows}", action=doing, rows=where)
        case "headlands":
            text = message("{action} along the headlands of {rows}", action=doing, rows=where)
        case "area":
            text = message("{action} over {area}, lane by lane", action=doing, area=where)
        case "perimeter":
            text = message("{action} around {area}", action=doing, area=where)
    more = [text, *_settings(node, robot)]
    if node.sides == "both":
        more.append(message("on both sides"))
    elif node.sides != "one":
        more.append(message("on the {side} side", side=COMPASS[node.sides]))
    if node.heading in ("north_south", "east_west"):
        lanes = message("lanes running north to south"), message("lanes running east to west")
        more.append(lanes[node.heading == "east_west"])
    elif node.heading in ("clockwise", "counterclockwise"):
        more.append(message("clockwise") if node.heading == "clockwise" else message("counterclockwise"))
    elif node.heading != "any":
        more.append(message("driving to the {side}", side=COMPASS[node.heading]))
    if rounds_side_by_side(node, robot):
        more.append(message("{count} rounds side by side", count=node.laps))
    elif node.laps > 1:
        more.append(message("{count} times", count=node.laps, context="laps"))
    if node.gaps == "on" and node.mode == "rows":
        more.append(message("without a break in gaps"))
    if node.optional:
        more.append(message("as much as the budget allows"))
    return joined(", ", more)


def say_along(selector: Selector, names: Mapping[str, str], *, rows: bool, between: bool = False) -> str:
    """Return rows, a block, a zone or an area in words, without the trees on it where it has a name of its own.

    Args:
        selector: Its trees.
        names: Names of zones and markers.
        rows: True for rows, rather than an area.
        between: True if it follows "between".
    """
    wording = SelectorWording(dict(names))
    phrase = wording.phrase(selector)
    if phrase.plain:
        return message("all rows", context="along") if rows else message("the whole site")
    if phrase.bare and phrase.rows_and_block:
        if between and not phrase.row:
            return message("the rows of {part}", part=phrase.block)
        return phrase.outer_rows_and_block if between else phrase.rows_and_block
    if len(selector.members) > 1:
        return listed([say_along(part, names, rows=rows, between=between) for part in selector.members])
    return selector.as_origin(wording)


def say_extent(node: WorkAlong, robot: RobotProfile, resolved: ResolvedPlaces | None) -> str:
    """Return the expected extent of work: "6 passes, 1,200 m worked, about 43 l"; empty if it is not known."""
    if resolved is None or not resolved.stretches:
        return ""
    stretches = resolved.stretches
    parts = [counted("{count} pass", "{count} passes", len(stretches))]
    metres = sum(s.length_m for s in stretches)
    if not node.action:
        parts.append(message("{metres} m", metres=say_rounded(metres)))
        return message("({facts})", facts=joined(", ", parts))
    on_m = sum(s.on_m for s in stretches)
    parts.append(message("{metres} m worked", metres=say_rounded(on_m)))
    implement = implement_of(node, robot)
    if implement is not None and implement.width_m is not None:
        parts.append(say_area(on_m * implement.width_m))
    parts += say_amount(node, robot, stretches)
    if resolved.shed:
        parts.append(counted("{count} more left out", "{count} more left out", len(resolved.shed), context="passes"))
    return message("({facts})", facts=joined(", ", parts))


def say_amount(node: WorkAlong, robot: RobotProfile, stretches: Sequence[Stretch]) -> list[Message]:
    """Return the amount that is applied, in a list; empty if nothing is."""
    amount = amount_of(node, robot, sum(s.on_m for s in stretches))
    if amount is None:
        return []
    return [message("about {amount}", amount=say_quantity(_rounded(amount.value), amount.unit))]


def say_area(square_m: float) -> Message:
    """Return an area: in hectares, or in square metres if it is small."""
    if square_m >= _HECTARE_FROM_M2:
        return message("{area} ha", area=say_number(round(square_m / 10_000.0, 2)))
    return message("{area} m²", area=say_rounded(square_m))


def _rounded(value: float) -> float:
    return round(value, 1) if value < 10.0 else float(round(value))


def _doing(node: WorkAlong, robot: RobotProfile) -> str:
    if not node.action:
        return message("drive", context="along")
    action = robot.action.get(node.action)
    doing = say_action(node.action)
    return doing if action is None else labelled(doing, action.labels)


def _settings(node: WorkAlong, robot: RobotProfile) -> list[Message]:
    """Return the parameters: "at 300 l/ha" for the rate, also where it is the default, "with X 3" for others."""
    action = robot.action.get(node.action)
    if action is None:
        return []
    given, found = dict(node.parameters), []
    implement = action.implement
    for parameter in action.parameters:
        value = given.get(parameter.name)
        is_rate = implement is not None and parameter.name == implement.rate
        if is_rate:
            value = parameter.default if value is None else value
        if value is None:
            continue
        said = say_quantity(value, parameter.unit) if isinstance(value, float | int) else value
        found.append(message("at {rate}", rate=said) if is_rate else message("with {setting}", setting=said))
    return found
