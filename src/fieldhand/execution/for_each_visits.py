"""Visits of a for-each during a mission: the next one, those left, those that cannot be reached."""

from __future__ import annotations

from collections.abc import Sequence
from dataclasses import dataclass, replace

from fieldhand.errors import BlockedFault, NoPlaceError, OccupiedFault
from fieldhand.execution.active_mission import ActiveMission
from fieldhand.execution.docking import ChargeFirst
from fieldhand.execution.obstacles import cut_off_places
from fieldhand.execution.shed_work import admit, mandatory_visit, mandatory_visits_left, report_shed
from fieldhand.forecast.mission_state import Visit, VisitChoice
from fieldhand.forecast.visit_order import home_if_last, order_visits, reachable, visits_in_order, with_stands
from fieldhand.language import message
from fieldhand.language.words import listed
from fieldhand.site.model import Place, Site
from fieldhand.task.earlier import may_have_none
from fieldhand.task.plan import ForEach
from fieldhand.task.results import Visiting

#: Largest number of places named in a message.
_NAMED = 8


@dataclass(frozen=True, kw_only=True)
class OptionalStepVisit:
    """The single visit of an optional step.

    Attributes:
        place: Place at which it begins.
    """

    place: Place

    def undone(self) -> tuple[Place, ...]:
        """Return the places of later visits: there are none."""
        return ()


class ForEachVisits:
    """The visits of a for-each.

    A place that obstacles make unreachable is postponed to the end. If it is then still unreachable, it is given up; if
    the visits were mandatory, the loop fails once all others are made. If only something stands where the robot would
    stand, it does not fail where there is other work and no ``try`` that expects the failure.

    Args:
        mission: The mission.
        node: The for-each. Its selector is resolved on construction.

    Attributes:
        left: Remaining visits in planned order.
        cut_off: Visits to places that cannot be reached at present.
        place: Place of the current visit.

    Raises:
        PlaceError: The selector gives no place.
        DriveFault: A mandatory place can never be reached.
    """

    def __init__(self, mission: ActiveMission, node: ForEach) -> None:
        self.node, self.mission = node, mission
        self.place: Place | None = None
        self.left: list[Visit] = []
        self.cut_off: list[Visit] = []
        self._missed: list[Place] = []
        self._occupied: set[tuple[str, str, str]] = set()
        self._made = 0
        self._why = ""
        self._ways = mission.blockages.version
        try:
            places = mission.resolve(node.select)
        except NoPlaceError:
            if not may_have_none(mission.task, node.select):
                raise
            places = ()
        closed: tuple[Place, ...] = ()
        cut_off: tuple[Place, ...] = ()
        if node.optional:
            places, closed = reachable(mission.drives, places)
            ordered = with_stands(mission.drives, mission.standing, places)
            self.left = list(mission.visits.of_places(node, ordered, mission.state().context))
        else:
            places, cut_off = self._parted(places)
            ordered = visits_in_order(node, mission.drives, mission.standing, places, self._home(), mission.robot)
            self.left = [mandatory_visit(mission, place, node.body) for place in ordered]
            self.cut_off = [mandatory_visit(mission, place, node.body) for place in cut_off]
        ids = tuple(place.id for place in (*ordered, *cut_off))
        sides = tuple(place.side for place in (*ordered, *cut_off))
        sides = sides if any(sides) else ()
        mission.emit(Visiting(t=mission.t, node=node.id, places=ids, optional=node.optional, sides=sides))
        if closed:
            why = f"{closed[0].kind} {closed[0].id} is {mission.drives.problem(closed[0])}"
            self._give_up(closed, f"cannot be reached: {why}")

    def next(self, made: int) -> Place | None:
        """Choose the next visit and make it the current one.

        Args:
            made: Number of visits made so far.

        Returns:
            Its place; None if no visit is left.

        Raises:
            BlockedFault: All others are made, and a mandatory one could not be reached.
            GivenUp, Over: As :func:`~fieldhand.execution.shed_work.admit`.
        """
        self.place, self._made = None, made
        if self._ways != self.mission.blockages.version:
            self._look_again()
        if self.left:
            self.place = self._chosen() if self.node.optional else self._in_order()
        elif self.cut_off:
            self.place = self.cut_off[0].place
        elif missed := self._failing():
            raise BlockedFault(f"{_missed(missed)}: {self._why}")
        return self.place

    def _failing(self) -> list[Place]:
        """Return the places for which the loop fails."""
        run = self.mission.run
        if run.is_caught or not (self._made or any(frame.left for frame in run.outwards())):
            return self._missed
        return [place for place in self._missed if place.key not in self._occupied]

    def undone(self) -> tuple[Place, ...]:
        """Return the places of the remaining visits."""
        return tuple(v.place for v in (*self.left, *self.cut_off))

    def still_to_come(self) -> list[Visit]:
        """Return the visits after the current one for the guard."""
        if self.node.at_most is None:
            return list(self.left)
        return self.left[: max(0, self.node.at_most - self._made - 1)]

    @property
    def is_last_resort(self) -> bool:
        """True if the current visit was postponed before, so that waiting for a way is worthwhile."""
        return bool(self.cut_off) and self.place == self.cut_off[0].place

    def permit(self, place: Place) -> None:
        """Ask the guard about a visit.

        Raises:
            GivenUp, Over: As :func:`~fieldhand.execution.shed_work.admit`.
        """
        visit = mandatory_visit(self.mission, place, self.node.body)
        admit(self.mission, visit, refused=[place, *self.undone()])

    def arrived(self) -> None:
        """Record that the robot has reached the place of the visit."""
        if self.is_last_resort:
            self.cut_off.pop(0)

    def skip(self, why: str, *, row: bool) -> None:
        """Leave out the current visit, and with ``row`` all remaining ones to trees of its row.

        Args:
            why: Reason in words.
            row: True to leave out the rest of the row.
        """
        place = self.place
        assert place is not None  # noqa: S101  a visit is current
        ids = _row_mates(self.mission.site, place) if row else frozenset[str]()
        others = [v.place for v in (*self.left, *self.cut_off) if v.place.kind == "tree" and v.place.id in ids]
        skipped = [place, *(p for p in others if p != place)]
        self.left = [v for v in self.left if v.place not in skipped]
        self.cut_off = [v for v in self.cut_off if v.place not in skipped]
        choice = VisitChoice(index=None, reason=why, cause="event")
        report_shed(self.mission, self.node.id, skipped, choice, optional=True)
        self.place = None

    def cannot_reach(self, fault: BlockedFault) -> None:
        """Postpone the current visit or, if it was postponed already, give it up with all others that cannot be
        reached.
        """
        place = self.place
        assert place is not None  # noqa: S101  a visit is current
        if isinstance(fault, OccupiedFault):
            self._occupied.add(place.key)
        if self.node.optional:
            self._give_up([place], fault.what)
        elif not self.is_last_resort and cut_off_places(self.mission, [place])[0]:
            self.cut_off.append(mandatory_visit(self.mission, place, self.node.body))
        else:
            off = [v.place for v in self.cut_off]
            gone = [p for p, cut in zip(off, cut_off_places(self.mission, off), strict=True) if cut]
            given_up = [place, *(p for p in gone if p != place)] if self.is_last_resort else [place]
            self.cut_off = [v for v in self.cut_off if v.place not in given_up]
            self._missed += given_up
            self._give_up(given_up, fault.what)

    def _home(self) -> Place | None:
        return home_if_last(self.mission.task, self.mission.site, self.node.id, self.mission.here)

    def _give_up(self, places: Sequence[Place], why: str) -> None:
        self._why = why
        choice = VisitChoice(index=None, reason=why, cause="unreachable")
        report_shed(self.mission, self.node.id, places, choice, optional=self.node.optional)

    def _parted(self, places: Sequence[Place]) -> tuple[tuple[Place, ...], tuple[Place, ...]]:
        """Split places into those that can be reached from the robot's position and those that obstacles cut off."""
        gone = cut_off_places(self.mission, places)
        return (
            tuple(p for p, cut in zip(places, gone, strict=True) if not cut),
            tuple(p for p, cut in zip(places, gone, strict=True) if cut),
        )

    def _look_again(self) -> None:
        """Update the visits after drives have changed: places cut off, stands of the others, their order."""
        mission, node = self.mission, self.node
        self._ways = mission.blockages.version
        if not mission.blockages.stretches and not self.cut_off:
            return
        visits = {v.place.key: v for v in (*self.left, *self.cut_off)}
        near, far = self._parted([v.place for v in visits.values()])
        if node.optional and far:
            self._give_up(far, "no way to it is left: obstacles that the robot found block it")
            far = ()
        open_ = [replace(p, stand=None) if p.planted else p for p in near]
        ordered = with_stands(mission.drives, mission.standing, open_)
        if node.order == "best" and not node.optional:
            ordered = tuple(ordered[k] for k in order_visits(mission.drives, mission.standing, ordered, self._home()))
        self.left = [replace(visits[p.key], place=p) for p in ordered]
        self.cut_off = [replace(visits[p.key], place=replace(p, stand=None)) for p in far]

    def _in_order(self) -> Place:
        """Return the next visit in planned order, if the guard permits it."""
        visit = self.left.pop(0)
        self.place = visit.place
        try:
            admit(self.mission, visit, refused=[visit.place, *self.undone()])
        except ChargeFirst:
            self.left.insert(0, visit)
            raise
        return visit.place

    def _chosen(self) -> Place | None:
        """Let the guard choose the next optional visit, and report those it gives up."""
        mission, node = self.mission, self.node
        at_most = None if node.at_most is None else node.at_most - self._made
        state = mission.state()
        choice = mission.guard.choose(
            state, list(self.left), at_most=at_most, still_to_come=mandatory_visits_left(mission)
        )
        if choice.charge_to:
            raise ChargeFirst(choice.reason, choice.charge_to)
        given_up = set(range(len(self.left))) if choice.index is None else set(choice.shed) - {choice.index}
        if given_up:
            places = [self.left[i].place for i in sorted(given_up)]
            report_shed(mission, node.id, places, choice, optional=True)
        chosen = None if choice.index is None else self.left[choice.index].place
        self.left = [v for i, v in enumerate(self.left) if i not in given_up and i != choice.index]
        return chosen


def _row_mates(site: Site, place: Place) -> frozenset[str]:
    """Return the ids of all trees in the row of a tree; none for a place in no row."""
    at = next((k for k, tree in enumerate(site.trees) if place.kind == "tree" and tree.place.id == place.id), None)
    row = -1 if at is None else int(site.planting.row_of[at])
    return frozenset(site.trees[k].place.id for k in site.planting.rows[row].trees) if row >= 0 else frozenset()


def _ids(places: Sequence[Place]) -> str:
    return listed([p.id for p in places[:_NAMED]]) + (" and others" if len(places) > _NAMED else "")


def _missed(places: Sequence[Place]) -> str:
    if len(places) == 1:
        return message("1 place could not be reached ({ids})", context="log", ids=_ids(places))
    return message("{count} places could not be reached ({ids})", context="log", count=len(places), ids=_ids(places))
