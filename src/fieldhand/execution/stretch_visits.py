"""The stretches of work along a path during a mission: the current one, those left, those not worked whole."""

from __future__ import annotations

from collections.abc import Sequence

from fieldhand.errors import BlockedFault
from fieldhand.execution.active_mission import ActiveMission
from fieldhand.execution.docking import ChargeFirst
from fieldhand.execution.shed_work import admit, mandatory_visits_left, report_shed
from fieldhand.forecast.mission_state import Visit, VisitChoice
from fieldhand.forecast.working import begin_of, stretches_of, visit_of
from fieldhand.language import counted, message
from fieldhand.language.words import listed
from fieldhand.site.model import Place
from fieldhand.site.working.stretch import Stretch
from fieldhand.task.plan import WorkAlong
from fieldhand.task.results import Visiting

#: Largest number of stretches named in a message.
_NAMED = 8


class StretchVisits:
    """The stretches of a node, with the interface of :class:`~fieldhand.execution.for_each_visits.ForEachVisits`.

    A stretch that obstacles cut off, or a part of one, is given up; if the work is mandatory, the node fails once all
    other stretches are done.

    Args:
        mission: The mission.
        node: The node. Its selector is resolved on construction.

    Attributes:
        current: The current stretch; None before the first.
        place: Place where it begins.

    Raises:
        PlaceError: Nothing can be worked along.
        DriveFault: A place can never be reached.
    """

    def __init__(self, mission: ActiveMission, node: WorkAlong) -> None:
        self.node, self.mission = node, mission
        self.current: Stretch | None = None
        self.place: Place | None = None
        self._missed: list[str] = []
        self._why = ""
        task, site, robot = mission.task, mission.site, mission.robot
        stretches = stretches_of(node, task, site, robot, mission.drives, mission.state().context)
        self._left = [(s, visit_of(s, node, task, site, robot)) for s in stretches]
        names = tuple(s.name for s in stretches)
        mission.emit(Visiting(t=mission.t, node=node.id, places=names, optional=node.optional))

    def next(self, made: int) -> Place | None:
        """Choose the next stretch and make it the current one.

        Args:
            made: Number of stretches worked so far.

        Returns:
            The place where it begins; None if no stretch is left.

        Raises:
            BlockedFault: All others are done, and a mandatory one could not be worked whole.
            GivenUp, Over: As :func:`~fieldhand.execution.shed_work.admit`.
        """
        del made
        self.current = self.place = None
        index = self._chosen() if self.node.optional else 0
        if index is None or not self._left:
            if self._missed and not self.node.optional:
                raise BlockedFault(_missed(self._missed, self._why))
            return None
        self.current, visit = chosen = self._left.pop(index)
        self.place = visit.place
        if not self.node.optional:
            try:
                admit(self.mission, visit, refused=[visit.place, *self.undone()])
            except ChargeFirst:
                self._left.insert(index, chosen)
                raise
        return self.place

    def undone(self) -> tuple[Place, ...]:
        """Return where the remaining stretches begin."""
        return tuple(visit.place for _, visit in self._left)

    def still_to_come(self) -> list[Visit]:
        """Return the stretches after the current one for the guard."""
        return [visit for _, visit in self._left]

    @property
    def is_last_resort(self) -> bool:
        """True if waiting for a way to the current stretch is worthwhile, as it is mandatory."""
        return not self.node.optional

    def permit(self, place: Place) -> None:
        """Ask the guard about the current stretch, or what is left of it from a place on.

        Raises:
            GivenUp, Over: As :func:`~fieldhand.execution.shed_work.admit`.
        """
        stretch, mission = self.current, self.mission
        assert stretch is not None  # noqa: S101  a stretch is current
        visit = visit_of(stretch, self.node, mission.task, mission.site, mission.robot)
        admit(mission, visit, refused=[place, *self.undone()])

    def arrived(self) -> None:
        """Record that the robot has reached the begin of the current stretch."""

    def break_off(self, left: Stretch) -> None:
        """Record what is left of the current stretch, which is interrupted and continued later."""
        self.current, self.place = left, begin_of(left, self.mission.site)

    def cannot_reach(self, fault: BlockedFault) -> None:
        """Give up the current stretch."""
        assert self.place is not None  # noqa: S101  a stretch is current
        self.miss(self.place, fault.what)

    def miss(self, place: Place, why: str) -> None:
        """Record that the stretch that begins at a place was not worked whole, because of an obstacle."""
        self._missed.append(place.id)
        self._why = why
        never = VisitChoice(index=None, reason=why, cause="unreachable")
        report_shed(self.mission, self.node.id, [place], never, optional=self.node.optional)

    def _chosen(self) -> int | None:
        """Let the guard choose the next optional stretch, and report those it gives up; None if none is left."""
        mission = self.mission
        if not self._left:
            return None
        visits = [visit for _, visit in self._left]
        choice = mission.guard.choose(mission.state(), visits, still_to_come=mandatory_visits_left(mission))
        if choice.charge_to:
            raise ChargeFirst(choice.reason, choice.charge_to)
        gone = set(range(len(visits))) if choice.index is None else set(choice.shed) - {choice.index}
        if gone:
            report_shed(mission, self.node.id, [visits[k].place for k in sorted(gone)], choice, optional=True)
        chosen = None if choice.index is None else self._left[choice.index]
        self._left = [pair for k, pair in enumerate(self._left) if k not in gone]
        return None if chosen is None else self._left.index(chosen)


def _missed(names: Sequence[str], why: str) -> str:
    named = listed(list(names[:_NAMED])) + ("" if len(names) <= _NAMED else message(" and others", context="log"))
    return counted(
        "{count} stretch could not be worked whole ({names}): {why}",
        "{count} stretches could not be worked whole ({names}): {why}",
        len(names),
        context="log",
        names=named,
        why=why,
    )
