"""Fields that are no orchards: a vegetable garden of numbered beds, a glasshouse, and a pasture without a plant."""

from __future__ import annotations

from typing import Any

from fieldhand.site.model import Site
from support.sites.points import area, point, read

LON, LAT = -2.5, 51.5
_X, _Y = 1.0 / 69_300.0, 1.0 / 111_200.0


def _at(x: float, y: float) -> list[float]:
    return [LON + x * _X, LAT + y * _Y]


def box(west: float, south: float, east: float, north: float, **properties: Any) -> dict[str, Any]:
    """A rectangle in metres east and north."""
    corners = [(west, south), (east, south), (east, north), (west, north), (west, south)]
    return area([_at(u, v) for u, v in corners], **properties)


def mark(x: float, y: float, **properties: Any) -> dict[str, Any]:
    """A point in metres east and north."""
    return point(*_at(x, y), **properties)


def fence(*corners: tuple[float, float], name: str) -> dict[str, Any]:
    """A line in metres east and north."""
    line = {"type": "LineString", "coordinates": [_at(u, v) for u, v in corners]}
    return {"type": "Feature", "properties": {"kind": "fence", "name": name}, "geometry": line}


def vegetable_garden() -> Site:
    """Six beds of eight plants, running north to south: two of potatoes, then radish, bean, squash and kale."""
    crops = ["potato", "potato", "radish", "bean", "squash", "kale"]
    features = [box(0, 0, 60, 40, kind="boundary", name="allotment")]
    for number, crop in enumerate(crops, start=1):
        x = 5.0 + 3.0 * number
        features.append(box(x - 0.6, 7.4, x + 0.6, 22.6, kind="bed", number=number))
        features += [
            mark(
                x, 8.0 + 2.0 * k, kind="plant", id=f"V{number}{k + 1}", row=number, crop=crop,
                height_cm=10 * number + 2 * k, netted=number in (3, 4), frost_damage=(number == 5 and k in (2, 6)),
            )
            for k in range(8)
        ]  # fmt: skip
    features += [
        box(40, 5, 50, 12, kind="zone", name="rose bed"),
        box(40, 20, 50, 28, kind="zone", name="manure heap"),
        mark(20, 0, kind="gate", name="street gate", width_m=3),
        mark(60, 30, kind="gate", name="river gate", width_m=3),
        mark(3, 3, kind="start", name="tool shed"),
    ]
    return read(*features)


def glasshouse() -> Site:
    """Four rows of ten plants, running east to west, in a hot and a mild bay that are zones and blocks alike."""
    kinds = {1: ("aubergine", "Black King"), 2: ("aubergine", "Black King"), 3: ("melon", "Charente"), 4: ("mint", "")}
    features = [box(0, 0, 50, 30, kind="boundary", name="yard")]
    for number, (crop, cultivar) in kinds.items():
        features += [
            mark(
                6.0 + k, 8.0 + 4.0 * number, kind="plant", id=f"H{number}-{k + 1}", row=number,
                block="hot bay" if number < 3 else "mild bay", crop=crop,
                cultivar="Long Tom" if (number, k > 5) == (2, True) else cultivar or crop,
                moisture=20 + number + k, staked=number != 4,
            )
            for k in range(10)
        ]  # fmt: skip
    features += [
        box(4, 10, 20, 18, kind="zone", name="hot bay"),
        box(4, 18, 20, 27, kind="zone", name="mild bay"),
        box(30, 10, 40, 20, kind="zone", name="seedling table"),
        mark(2, 2, kind="start", name="yard tap"),
    ]
    return read(*features)


def pasture() -> Site:
    """Grass with parts, a pond, a fence with two gates, and no plant."""
    return read(
        box(0, 0, 200, 120, kind="boundary", name="common"),
        fence((100, 0), (100, 120), name="sheep fence"),
        box(2, 2, 98, 118, kind="zone", name="long pasture"),
        box(102, 2, 198, 118, kind="zone", name="cow paddock"),
        box(2, 2, 30, 30, kind="zone", name="boggy corner"),
        box(110, 80, 150, 110, kind="zone", name="bank"),
        box(60, 60, 70, 70, kind="zone", name="cowslip patch"),
        box(160, 40, 165, 45, kind="pond", name="pond"),
        mark(100, 60, kind="gate", name="middle gate", width_m=4),
        mark(50, 0, kind="gate", name="farm gate", width_m=4),
        mark(150, 20, kind="start", name="stable door"),
    )
