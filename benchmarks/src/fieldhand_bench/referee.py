"""Judge a finished mission from its Task, its site and its event log alone, independent of the guard."""

from __future__ import annotations

import itertools
import math
import re
from collections import Counter
from collections.abc import Mapping, Sequence
from dataclasses import dataclass

from fieldhand.errors import TaskError
from fieldhand.robot.model import RobotProfile
from fieldhand.site.model import Place, Site
from fieldhand.task.build import FAULTED_EXITS
from fieldhand.task.frames import Task, Then
from fieldhand.task.plan import ForEach, walk
from fieldhand.task.results import (
    Arrived,
    Ended,
    Event,
    Exited,
    Faulted,
    LimitCrossed,
    MissionStatus,
    Shed,
    Started,
)
from fieldhand_bench.account import Undone
from fieldhand_bench.follow import follow

#: Relative tolerance of floating-point sums.
_SUMS = 1e-6
#: Maximum distance between the last arrival and the final position, metres.
_THERE_M = 0.5
_WORD = re.compile(r"[A-Za-z]{3,}")


@dataclass(frozen=True, kw_only=True)
class LimitUse:
    """The use of a limit in metres, seconds or percent of the battery; ``reserve``: of the charge above the reserve."""

    kind: str
    used: float
    limit: float

    @property
    def exceeded(self) -> bool:
        """Return True if more was used than the limit."""
        return self.used > self.limit + _SUMS * max(1.0, self.limit)

    @property
    def share(self) -> float:
        """Amount used divided by the limit."""
        return self.used / self.limit if self.limit > 0 else math.inf


@dataclass(frozen=True, kw_only=True)
class Judgement:
    """The judgement of a mission.

    Attributes:
        status: Final status of the mission.
        uses: Use of each budget and of the charge above the reserve.
        done: Number of mandatory pieces of work that were done.
        given_up: Mandatory work that was given up, with node, place and reason.
        silent: Mandatory work that was not done and for which the log gives no readable reason.
        faulted: Fault that ended the mission, empty for none; work lost by it does not count as ``silent``.
        visits: Number of completed optional visits.
        left_out: Number of optional visits that were given up.
        caution: Lowest logged overrun probability at which work was given up; None if none was. Below the accepted
            probability the guard gave up more than necessary.
        reward: Total reward of the completed optional visits.
        doubled: Places that a loop visited twice.
        misplaced: Description of a wrong end of the mission; empty if the end is right.
        odd: Contradictions between log and plan, one sentence each.
    """

    status: MissionStatus
    uses: tuple[LimitUse, ...]
    done: int
    given_up: tuple[str, ...]
    silent: tuple[str, ...]
    faulted: str
    visits: int
    left_out: int
    caution: float | None
    reward: float
    doubled: tuple[str, ...]
    misplaced: str
    odd: tuple[str, ...]

    @property
    def exceeded(self) -> tuple[str, ...]:
        """Kinds of the limits that were exceeded."""
        return tuple(use.kind for use in self.uses if use.exceeded)


def judge(task: Task, site: Site, robot: RobotProfile, events: Sequence[Event]) -> Judgement:
    """Judge a mission.

    Raises:
        TaskError: The log does not contain a whole mission.
    """
    if not events or not isinstance(events[0], Started) or not isinstance(events[-1], Ended):
        raise TaskError("the log does not hold a whole mission", advice="give one that begins and ends")
    ended = events[-1]
    account = follow(task.composition.plan, site, events)
    fault = next((e.what for e in events if isinstance(e, Faulted) and not e.handled), "")
    words = {
        (e.node, place): e.reason
        for e in account.rest
        if isinstance(e, Shed) and not e.optional and _WORD.search(e.reason)
        for place in (*e.places, "")
    }
    missed = [(u.node, place) for u in account.undone for place in u.places or ("",)]
    silent = [] if fault else [_named(*m) for m in missed if m not in words]
    if account.undone and not fault and not _WORD.search(ended.reason):
        silent.append("the mission's end gives no reason")
    again = Counter((m.node, m.run, m.place) for m in account.made)
    return Judgement(
        status=ended.status,
        uses=_uses(task, robot, events[0], ended),
        done=account.done,
        given_up=tuple(f"{_named(*m)} ({words[m]})" for m in missed if m in words),
        silent=tuple(silent),
        faulted=fault,
        visits=len(account.made),
        left_out=account.left_out,
        caution=min((e.chance_short for e in events if isinstance(e, Shed) and e.chance_short > 0), default=None),
        reward=sum(_worth(task, site, m.node, m.place) for m in account.made),
        doubled=tuple(f"{node}: {place}" for (node, _, place), times in again.items() if times > 1),
        misplaced=_misplaced(task, site, events, ended, account.undone),
        odd=(*account.odd, *_sums(events, ended)),
    )


def _named(node: str, place: str) -> str:
    return f"{node} at {place}" if place else node


def _uses(task: Task, robot: RobotProfile, started: Started, ended: Ended) -> tuple[LimitUse, ...]:
    percent = started.charge_percent - ended.charge_percent
    used: Mapping[str, float] = {
        "distance_m": ended.travelled_m,
        "duration_s": ended.t - started.t,
        "energy_percent": percent,
    }
    asked = task.constraints.reserve_percent
    reserve = robot.energy.reserve_percent if asked is None else asked
    budgets = tuple(LimitUse(kind=b.kind, used=used[b.kind], limit=b.limit) for b in task.constraints.budgets)
    return (*budgets, LimitUse(kind="reserve", used=percent, limit=started.charge_percent - reserve))


def _worth(task: Task, site: Site, node: str, place: str) -> float:
    """Return the reward of a visit according to the Task and the site."""
    loop = next(n for n in walk(task.composition.plan) if isinstance(n, ForEach) and n.id == node)
    if not loop.reward:
        return 1.0
    tree = next((t for t in site.trees if t.place.id == place), None)
    value = None if tree is None else tree.properties.get(loop.reward)
    return max(0.0, float(value)) if isinstance(value, int | float) else 0.0


def _misplaced(task: Task, site: Site, events: Sequence[Event], ended: Ended, undone: Sequence[Undone]) -> str:
    """Describe how the end differs from the one that the Task requires; return an empty text if it does not."""
    leaving = [k for k, e in enumerate(events) if isinstance(e, Exited)]
    if not leaving:
        return "no exit was taken"
    if ended.status in ("faulted", "aborted"):
        return ""
    exits = {e.fault: e.then for e in (*FAULTED_EXITS, *task.composition.faulted)}
    turned = any(isinstance(e, LimitCrossed) and e.then in ("return", "end") for e in events)
    then: Then = exits["low_budget"] if undone or turned else task.composition.nominal
    taken = events[leaving[-1]]
    if not isinstance(taken, Exited) or taken.then != then:
        return f"the exit {then} was to be taken"
    said_done = ended.status == "completed" or (ended.status == "exceeded" and taken.exit == "nominal")
    if said_done == (bool(undone) or turned):
        return f"it ended as {ended.status} with {len(undone)} things undone"
    arrivals = [e for e in events if isinstance(e, Arrived)]
    if then == "stay":
        moved = any(isinstance(e, Arrived) for e in events[leaving[-1] :])
        return "it drove on where it was to stay" if moved else ""
    home: Place = site.home(then, site.start)
    if not arrivals or arrivals[-1].place != home.id:
        return f"it did not come to the {home.id}"
    away = math.dist(_metres(site, arrivals[-1].lat, arrivals[-1].lon), _metres(site, ended.lat, ended.lon))
    return f"it ended {away:.1f} m from where it had come to" if away > _THERE_M else ""


def _metres(site: Site, lat: float, lon: float) -> tuple[float, float]:
    x, y = site.projection.metres([lat], [lon])[0]
    return float(x), float(y)


def _sums(events: Sequence[Event], ended: Ended) -> list[str]:
    """Return inconsistencies between the distances and times of the log."""
    wrong = []
    legs = sum(e.leg_m for e in events if isinstance(e, Arrived))
    # A drive that was interrupted to turn home counts as distance but is not recorded as a leg.
    broken_off = any(isinstance(e, LimitCrossed) and e.then != "go_on" for e in events)
    missing = ended.travelled_m - legs
    wrong_sum = missing < -_SUMS * max(1.0, legs) if broken_off else abs(missing) > _SUMS * max(1.0, legs)
    if ended.status != "faulted" and wrong_sum:
        wrong.append(f"legs of {legs:.1f} m are not the {ended.travelled_m:.1f} m that were driven")
    if any(b.t < a.t - _SUMS for a, b in itertools.pairwise(events)):
        wrong.append("time runs backwards")
    return wrong
