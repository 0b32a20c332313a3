"""Constructions of the direction of a round: "clockwise", "keeping it on your left", "the camera looking outwards".

An implement on one side of the robot faces what is driven around, and the edge of what is driven along inside; said of
it, that changes nothing, and the other way round is driven the other way round.
"""

from __future__ import annotations

from dataclasses import dataclass, replace
from typing import Literal

from fieldhand.places import selectors as s
from fieldhand.planning.grammar.chart import Grammar
from fieldhand.planning.grammar.commands.laps import goes_around
from fieldhand.planning.grammar.commands.sampling import SamplingWay
from fieldhand.planning.grammar.commands.working import Tract
from fieldhand.planning.grammar.meaning import WorkCommand
from fieldhand.planning.grammar.places.sampling import SamplingPath, is_keep_out
from fieldhand.planning.grammar.words import Lex
from fieldhand.planning.selections import as_zone
from fieldhand.robot.model import RobotProfile
from fieldhand.site.model import Site
from fieldhand.task.nodes.work_along import WorkHeading

GRAMMAR = Grammar()
construction = GRAMMAR.construction

Hand = Literal["left", "right"]


@dataclass(frozen=True, slots=True)
class Faced:
    """The ground that an implement faces.

    Attributes:
        out: True if it faces away from the ground.
        what: The ground, if the phrase names it.
    """

    out: bool = False
    what: s.Selector | None = None


_OTHER: dict[WorkHeading, WorkHeading] = {"clockwise": "counterclockwise", "counterclockwise": "clockwise"}


def _way(word: Lex) -> WorkHeading:
    return "counterclockwise" if "against" in word.features else "clockwise"


# --- clockwise --------------------------------------------------------------------------------------------------------


@construction(
    "edge: way=CLOCKWISE where=edge", "edge: way=CLOCKWISE ONCE where=edge", "edge: where=edge way=CLOCKWISE", cost=0.1
)
def edge_clockwise(way: Lex, where: Tract) -> Tract | None:
    """Compose "clockwise round the pond" behind a verb."""
    return None if where.heading != "any" else replace(where, heading=_way(way))


@construction(
    "work: one=work [COMMA] [and_or_but] way=CLOCKWISE", "work: one=work [COMMA] GO way=CLOCKWISE",
    "work: one=work FULLSTOP [GO] way=CLOCKWISE", "work: way=CLOCKWISE [COMMA] one=work", cost=0.1,
)  # fmt: skip
def worked_clockwise(one: WorkCommand, way: Lex, used: int) -> WorkCommand | None:
    """Compose "film round the pond, clockwise"."""
    if one.mode != "perimeter" or one.heading != "any" or one.sides != "one" or one.along is None:
        return None
    return replace(one, heading=_way(way), used=used)


@construction(
    "path_over: GO way=CLOCKWISE along=edge_way", "path_over: way=CLOCKWISE along=edge_way",
    "path_over: along=path_over [COMMA] [GO] way=CLOCKWISE", cost=0.1,
)  # fmt: skip
def path_clockwise(along: SamplingWay, way: Lex) -> SamplingWay | None:
    """Compose "once round the pond, clockwise", of points along it, which are in that order."""
    path, where = along
    if not isinstance(path, SamplingPath) or path.shape != "edge" or path.in_order or "against" in way.features:
        return None
    return replace(path, in_order=True), where


@construction(
    "edge_way: AROUND where=region", "edge_way: AROUND line=edge_line", "edge_way: ALONG line=edge_line", cost=0.0
)
@construction("edge_way: ONCE along=edge_way", "edge_way: ALONG fence=region", cost=0.0)
def edge_way(
    where: s.Selector | None = None,
    line: s.Selector | None = None,
    fence: s.Selector | None = None,
    along: SamplingWay | None = None,
) -> SamplingWay | None:
    """Compose "once round the pond" behind "clockwise"."""
    if along is not None:
        return along
    area = where or line or fence
    zone = None if area is None else as_zone(area)
    if area is not None and area != s.Trees() and (zone is None or zone != s.InZone(zone=zone.zone)):
        return None
    return SamplingPath("edge", 1), None if area == s.Trees() else area


# --- what the implement faces, and what is on which hand --------------------------------------------------------------


def mounted_side(action: str, robot: RobotProfile) -> Hand | None:
    """Return the side of the robot on which an implement works; None for others, and without one."""
    implement = robot.action[action].implement if action in robot.action else None
    side = None if implement is None else implement.side
    return side if side == "left" or side == "right" else None


def usual_way(hand: Hand, *, outside: bool) -> WorkHeading:
    """Return the direction in which an implement faces what is driven around, or the edge that is driven along."""
    return "clockwise" if (hand == "left") != outside else "counterclockwise"


@construction("faced: LOOKING OUTWARDS", cost=0.0)
def outwards() -> Faced:
    """Compose "looking outwards"."""
    return Faced(out=True)


@construction("faced: LOOKING INWARDS", cost=0.0)
def inwards() -> Faced:
    """Compose "looking inwards"."""
    return Faced()


@construction(
    "faced: LOOKING where=region", "faced: LOOKING AT where=region", "faced: LOOKING it=IT", "faced: LOOKING AT it=IT",
    cost=0.0,
)  # fmt: skip
def facing_it(where: s.Selector | None = None, it: Lex | None = None) -> Faced:
    """Compose "facing the pond"."""
    del it
    return Faced(what=where)


@construction("faced: LOOKING AWAY where=region", "faced: LOOKING AWAY it=IT", cost=0.0)
def facing_away(where: s.Selector | None = None, it: Lex | None = None) -> Faced:
    """Compose "facing away from the pond"."""
    del it
    return Faced(out=True, what=where)


@construction(
    "work: one=work [COMMA] faced=faced", "work: one=work [COMMA] [WITH] [DET] verb=WORKN faced=faced",
    "work: one=work [COMMA] [and_or_but] [WITH] [DET] verb=WORKN faced=faced",
    "work: one=work [COMMA] [and_or_but] [WITH] [DET] INSTRUMENT faced=faced",
    "work: one=work FULLSTOP [DET] verb=WORKN MUST faced=faced", cost=0.1, given=("robot", "site"),
)  # fmt: skip
def worked_facing(
    one: WorkCommand, faced: Faced, used: int, robot: RobotProfile, site: Site, verb: Lex | None = None
) -> WorkCommand | None:
    """Compose "film round the paddock with the side camera looking outwards"."""
    hand = mounted_side(one.action, robot)
    if hand is None or one.along is None or one.mode != "perimeter" or one.sides != "one":
        return None
    if (verb is not None and verb.value != one.action) or faced.what not in (None, one.along):
        return None
    outside = is_keep_out(one.along, site)
    if outside and goes_around(one.along, site):
        return None
    usual = usual_way(hand, outside=outside)
    needed = usual if faced.out != outside else _OTHER[usual]
    if one.heading not in ("any", needed):
        return None
    kept = one.heading == "any" and needed == usual  # as it is driven anyway
    return replace(one, heading="any" if kept else needed, faced=True, used=used)


@construction("hand_kept: [KEEPSIT] [it=IT] ONYOURRIGHT", "hand_kept: KEEPSIT where=region ONYOURRIGHT", cost=0.0)
@construction(
    "hand_kept: KEEPSIT where=rows ONYOURRIGHT", "hand_kept: KEEPSIT where=crop_area ONYOURRIGHT",
    "hand_kept: KEEPSIT DET ROW ONYOURRIGHT", cost=0.0,
)  # fmt: skip
def kept_on_the_right(where: s.Selector | None = None, it: Lex | None = None) -> tuple[Hand, s.Selector | None]:
    """Compose "keeping it on your right"."""
    del it
    return "right", where


@construction("hand_kept: [KEEPSIT] [it=IT] ONYOURLEFT", "hand_kept: KEEPSIT where=region ONYOURLEFT", cost=0.0)
@construction(
    "hand_kept: KEEPSIT where=rows ONYOURLEFT", "hand_kept: KEEPSIT where=crop_area ONYOURLEFT",
    "hand_kept: KEEPSIT DET ROW ONYOURLEFT", cost=0.0,
)  # fmt: skip
def kept_on_the_left(where: s.Selector | None = None, it: Lex | None = None) -> tuple[Hand, s.Selector | None]:
    """Compose "with the pond on your left"."""
    del it
    return "left", where


@construction(
    "work: one=work [COMMA] [and_or_but] kept=hand_kept", "work: one=work FULLSTOP kept=hand_kept",
    "work: kept=hand_kept COMMA one=work", cost=0.1, given=("robot", "site"),
)  # fmt: skip
def worked_on_hand(
    one: WorkCommand, kept: tuple[Hand, s.Selector | None], used: int, robot: RobotProfile, site: Site
) -> WorkCommand | None:
    """Compose "film the fence, keeping it on your right", and "drive round the pond with it on your left"."""
    hand, what = kept
    if one.along is None or what not in (None, one.along) or one.optional:
        return None
    mounted = mounted_side(one.action, robot)
    if one.mode in ("rows", "perimeter") and mounted is not None:
        faces = one.mode == "rows" or is_keep_out(one.along, site)
        turned = one.heading in _OTHER and one.heading != usual_way(mounted, outside=True)
        return replace(one, used=used) if mounted == hand and faces and not turned else None
    if one.mode != "perimeter" or one.heading != "any" or not is_keep_out(one.along, site) or one.sides != "one":
        return None
    return replace(one, heading="clockwise" if hand == "right" else "counterclockwise", used=used)
