"""Monitor of battery, distance and time, at every poll of the robot.

The guard decides between drives; this monitor checks during them. Every battery level and every limit that is crossed
is logged once, and its consequence follows at once: at the return level the mission turns home, at the stop level the
robot stops where it stands. A :class:`~fieldhand.execution.guard.Failsafe`, implemented by evaluation, predicts whether
resources suffice for the way home.
"""

from __future__ import annotations

import math
from dataclasses import replace
from typing import Literal

from shapely.geometry import LineString, Point

from fieldhand.errors import DriveFault
from fieldhand.execution.active_mission import ActiveMission
from fieldhand.execution.leg_pace import LegPace
from fieldhand.execution.limit_levels import Consequence, LimitLevel, fastest_drain, levels_of
from fieldhand.execution.open_goals import OpenCapture, OpenDrive, OpenManeuver, OpenStretch
from fieldhand.forecast.failsafe_state import FailsafeForecast, FailsafeState
from fieldhand.forecast.mission_state import Spent, Work
from fieldhand.forecast.recharge_rules import charger_distance
from fieldhand.forecast.resource_limits import reserve_percent, resource_limits, slower_s_per_m, speed_of
from fieldhand.forecast.turning_back import LOOK_M, TurningRule
from fieldhand.forecast.working import use_of
from fieldhand.site.model import Place, Site
from fieldhand.site.stopping import safe_stop
from fieldhand.task.frames import Then as Exit
from fieldhand.task.results import Crossable, Crossing, LimitCrossed
from fieldhand.wording.limits import say_crossing

#: Shortest time in seconds between two checks when time jumps. The next check comes before the fastest drain could
#: reach a level.
SOONEST_S = 0.2

#: Highest plausible speed as a multiple of the robot's speed.
_SPEED = 2.0

#: Fraction of the mean range of the charge within which a safe place is almost certainly reached.
_SURELY = 0.6

#: Charge in percent above a level at which it counts as left again: the battery was changed or charged.
CLEAR_PERCENT = 3.0

#: Charge in percent for which a wait goes on at least, where it can be left off to charge.
PART_PERCENT = 2.0

#: ``plan``: carrying out the plan. ``exit``: on the way home. ``over``: the robot stands, or was ordered to stop.
Phase = Literal["plan", "exit", "over"]
BatteryAlarm = Literal["none", "return", "stop", "shelter"]


class LimitMonitor:
    """Limit monitor of one mission.

    Args:
        mission: The mission.

    Attributes:
        phase: Current phase of the mission.
        alarm: Required response: turn home, stop, or look for a place to stop safely (``shelter``).
        why: Reason in words.
        exit: Destination after an alarm to turn home.
    """

    def __init__(self, mission: ActiveMission) -> None:
        self._mission = mission
        self.phase: Phase = "plan"
        self.alarm: BatteryAlarm = "none"
        self.why = ""
        self.exit = mission.exit_for("low_budget")
        #: A mission that ends at its last visit does not include the way home in its limits: driving home would exceed
        #: them.
        self._has_open_end = mission.task.composition.nominal == "stay"
        self._reach_m = 0.0
        self._levels = levels_of(mission.task.constraints, mission.robot)
        self._crossed: set[LimitLevel] = set()
        self._slow_s: tuple[tuple[tuple[float, float], ...], float, float] | None = None
        self._homes: dict[bool, tuple[tuple[tuple[float, float], ...], float, float]] = {}
        self._foreseen: set[Phase] = set()
        self._fastest = fastest_drain(mission.robot)
        #: True if the battery raised the last alarm, not a budget.
        self._by_charge = False
        #: True if it was raised because the drive cost too much.
        self._turned_back = False
        self._pace = LegPace(mission)
        self._turning = TurningRule(mission.robot)

    def turn(self, phase: Phase) -> None:
        """Enter a phase of the mission; the previous alarm is settled."""
        self.phase, self.alarm, self.why = phase, "none", ""

    def turn_to_charger(self) -> bool:
        """Settle an alarm to turn home by charging instead, if that is possible; return True if it is."""
        mission = self._mission
        charger = mission.charger
        if self.alarm != "return" or not self._by_charge or not mission.may_recharge or charger is None:
            return False
        if not self.reaches(charger):
            return False
        mission.recharge_due, self.alarm = self.why, "none"
        self._foreseen.discard(self.phase)
        if self._turned_back:
            mission.turned_back()
        return True

    def look(self) -> None:
        """Check all levels: record crossings, and raise the alarm if one has consequences."""
        spent, charge = self._mission.spent, self._mission.charge_percent()
        values: dict[Crossable, float] = {
            "charge_percent": charge,
            "distance_m": spent.metres,
            "duration_s": spent.seconds,
            "energy_percent": spent.percent,
        }
        for level in self._levels:
            value = values[level.quantity]
            if level not in self._crossed and level.is_crossed(value):
                self._crossed.add(level)
                self._emit_crossing(level.quantity, level.level, value, level.threshold, self._follows(level))
            elif level in self._crossed and level.quantity == "charge_percent":
                self._clear(level, value)
        if self.alarm == "none" and self.phase not in self._foreseen and not self._mission.recharge_due:
            self._foresee(spent, charge)

    def has_news(self, now: float, charge: float) -> bool:
        """Return True if a standing robot has reached a charge level or a time limit since the last check.

        Args:
            now: Time of the mission clock in seconds.
            charge: Battery charge in percent.
        """
        seconds = self._mission.t + now - self._mission.clock.now()
        values: dict[Crossable, float] = {"charge_percent": charge, "duration_s": seconds}
        if self._mission.next_reading_in() > 0.0 and math.isfinite(self._mission.next_reading_in()):
            del values["charge_percent"]  # read a moment ago
        open_ = (level for level in self._levels if level not in self._crossed and level.quantity in values)
        return any(level.is_crossed(values[level.quantity]) for level in open_)

    def next_look_in(self) -> float:
        """Return the shortest time in seconds until something could be crossed."""
        spent, charge = self._mission.spent, self._mission.charge_percent()
        speed, found = _SPEED * self._mission.robot.speed_m_s, [self._mission.next_reading_in()]
        pace: dict[Crossable, float] = {
            "charge_percent": self._fastest,
            "energy_percent": self._fastest,
            "distance_m": speed,
            "duration_s": 1.0,
        }
        used = {"distance_m": spent.metres, "duration_s": spent.seconds, "energy_percent": spent.percent}
        for level in self._levels:
            if level in self._crossed:
                continue
            room = level.threshold - used.get(level.quantity, 0.0)
            if level.quantity == "charge_percent":
                room = charge - level.threshold
            # While driving out, the way home grows as fast as the remaining resources shrink.
            halved = self.phase == "plan" and level.level in ("reserve", "limit")
            found.append(room / pace[level.quantity] / (2.0 if halved else 1.0))
        return max(SOONEST_S, min([*found, self._pace_look_in(charge)]))

    def refuge(self, home: Place) -> Place | None:
        """Return where the robot can stop safely: on the way home within range of its charge, else at a near marker.

        Return None if there is no such place: then it drives on until the stop level. The alarm ends in both cases.
        """
        self.alarm = "none"
        mission, at = self._mission, self._mission.observation.position
        try:
            way = mission.drives.between(at.as_place(), home)
        except DriveFault:
            return None
        for reach_m in (_SURELY * self._reach_m, self._reach_m):
            if (metres := safe_stop(mission.drives, way, reach_m)) is not None:
                return replace(_point(mission.site, way.at(metres)), id="safe place")
        markers = [m for m in mission.site.markers.values() if mission.drives.reachable((m,), way.start)[0]]
        ways = [(mission.drives.between(way.start, marker).length_m, k) for k, marker in enumerate(markers)]
        nearest_m, k = min(ways, default=(math.inf, -1))
        return markers[k] if nearest_m <= _SURELY * self._reach_m else None

    def reaches(self, home: Place) -> bool:
        """Return True if the charge suffices for the way home from the robot's position."""
        mission = self._mission
        try:
            metres = mission.drives.between(mission.standing, home).length_m
        except DriveFault:
            return False
        ways = (metres, 0.0, 0.0)
        return self._ask_failsafe(mission.spent, mission.charge_percent(), ways, returning=True).alarm == "none"

    # --- crossings -----------------------------------------------------------------------------------------------

    def _follows(self, level: LimitLevel) -> Consequence:
        """Return the consequence of a crossing in this phase."""
        mission = self._mission
        homeward = self.phase == "exit" or mission.to_charger
        if level.quantity == "charge_percent" and (mission.docked or isinstance(mission.doing, OpenManeuver)):
            return "go_on"  # it is at the charger
        if self.phase == "over" or (homeward and level.then == "return"):
            return "go_on"
        if level.then == "return" and self._exit_after(level.quantity) == "stay":
            return "end"
        return level.then

    def _exit_after(self, quantity: Crossable) -> Exit:
        """Return the destination after a limit of that quantity is reached."""
        if self._has_open_end and quantity != "charge_percent":
            return "stay"
        return self._mission.exit_for("low_budget")

    def _clear(self, level: LimitLevel, value: float) -> None:
        if value >= level.threshold + CLEAR_PERCENT and not level.is_crossed(value):
            self._crossed.discard(level)
            self._emit_crossing(level.quantity, level.level, value, level.threshold, "go_on", cleared=True)

    def _emit_crossing(
        self,
        quantity: Crossable,
        level: Crossing,
        value: float,
        threshold: float,
        then: Consequence,
        *,
        cleared: bool = False,
    ) -> None:
        mission, at = self._mission, self._mission.observation.position
        event = LimitCrossed(
            t=mission.t,
            node="" if mission.doing is None else mission.doing.node,
            quantity=quantity,
            level=level,
            value=value,
            threshold=threshold,
            then=then,
            cleared=cleared,
            lat=at.lat,
            lon=at.lon,
            travelled_m=mission.spent.metres,
            charge_percent=mission.charge_percent(),
        )
        mission.emit(event)
        if then != "go_on" and self.alarm != "stop":
            self.alarm = "shelter" if level == "out_of_reach" else "return" if then == "end" else then
            self.why, self.exit = say_crossing(event), self._exit_after(quantity)
            self._by_charge = quantity == "charge_percent"
            self._turned_back = level == "costly_drive"

    # --- the way home --------------------------------------------------------------------------------------------

    def _foresee(self, spent: Spent, charge: float) -> None:
        """Ask the failsafe, during a drive, a capture or a wait, whether resources suffice for the way home."""
        doing = self._mission.doing
        if self.phase == "plan" and self._has_open_end:
            return
        if self.phase == "over" or isinstance(doing, OpenManeuver):
            return
        if doing is None and not self._mission.dwell_left_s:
            return
        if self.phase == "exit" and not isinstance(doing, OpenDrive):
            return
        if self._watches_pace:
            self._pace.look()
        ways, haven = self._ways(doing), None
        if self.phase == "plan" and self._mission.may_recharge:
            haven = self._ways(doing, to_charger=True)
        found = self._ask_failsafe(spent, charge, ways, self._work_left(doing, ways[0]), haven)
        if found.alarm == "none":
            return
        self._foreseen.add(self.phase)
        self._reach_m = found.reach_m
        quantity: Crossable = "charge_percent" if found.limit == "reserve" else found.limit
        if found.alarm == "turn_back":
            self._emit_crossing(quantity, "costly_drive", found.left, found.needed, "return")
        elif found.alarm == "turn_home":
            self._emit_crossing(quantity, "way_home", found.left, found.needed, "return")
        else:
            self._emit_crossing(quantity, "out_of_reach", found.left, found.needed, "stop")

    def _ask_failsafe(
        self,
        spent: Spent,
        charge: float,
        ways: tuple[float, float, float],
        work: Work | None = None,
        haven: tuple[float, float, float] | None = None,
        *,
        returning: bool | None = None,
    ) -> FailsafeForecast:
        """Ask the failsafe; ``ways`` are those of :meth:`_ways` home, ``haven`` those to the charger."""
        on_m, after_m, home_m = ways
        _, charger_after_m, charger_m = ways if haven is None else haven
        homeward = self.phase == "exit" or self._mission.to_charger
        return self._mission.inputs.foresee(
            FailsafeState(
                spent=spent,
                charge_percent=charge,
                on_m=on_m,
                work=work or Work(),
                after_m=after_m,
                home_m=home_m,
                haven_after_m=min(after_m, charger_after_m),
                haven_m=min(home_m, charger_m),
                returning=homeward if returning is None else returning,
                driven_m=self._pace.driven_m,
                done_m=self._pace.done_m,
                charger_after_m=charger_after_m,
                charger_m=charger_m,
                turns=self._mission.turns if haven is not None and self._watches_pace else None,
            )
        )

    @property
    def _watches_pace(self) -> bool:
        """True during a drive that may be broken off for the charger if it costs too much."""
        mission, doing = self._mission, self._mission.doing
        drives = isinstance(doing, OpenDrive) and not isinstance(doing, OpenStretch) and len(mission.driven) > 1
        return drives and self.phase == "plan" and mission.may_recharge

    def _pace_look_in(self, charge: float) -> float:
        """Return the seconds until the pace of the current drive is looked at; infinite if no pace matters."""
        mission, doing = self._mission, self._mission.doing
        if not self._watches_pace or not isinstance(doing, OpenDrive):
            return math.inf
        self._pace.look()
        on_m, after_m, _ = self._ways(doing, to_charger=True)
        constraints, robot = mission.task.constraints, mission.robot
        left = charge - robot.energy.levels(reserve_percent(constraints, robot)).stop
        per_metre = resource_limits(constraints, robot)[-1].per_metre
        if not self._turning.can_turn(left / per_metre, on_m, after_m):
            return math.inf
        return LOOK_M / speed_of(constraints, robot)

    def _ways(self, doing: OpenDrive | OpenCapture | None, *, to_charger: bool = False) -> tuple[float, float, float]:
        """Return metres left of the current drive, from its end home (or to the charger), and at most from here."""
        mission, metres_from = self._mission, self._charger_m if to_charger else self._home_m
        if not isinstance(doing, OpenDrive) or len(mission.driven) < 2:
            home = metres_from(mission.standing)
            return 0.0, home, home
        known = self._homes.get(to_charger)
        if known is None or known[0] is not mission.driven:
            begins, end = _point(mission.site, mission.driven[0]), doing.goal.place
            returning = self.phase == "exit"
            ways = (0.0, 0.0) if returning else (metres_from(begins), metres_from(end))
            known = self._homes[to_charger] = mission.driven, *ways
        path, at = LineString(mission.driven), mission.observation.position
        done = path.project(Point(at.xy))
        on_m = max(0.0, path.length - done)
        _, from_start, from_end = known
        return on_m, from_end, min(done + from_start, on_m + from_end)

    def _home_m(self, at: Place) -> float:
        """Return the metres to the exit for a low budget; 0 if there is no way."""
        mission = self._mission
        home = mission.site.home(mission.exit_for("low_budget"), at)
        try:
            return 0.0 if home.xy == at.xy else mission.drives.between(at, home).length_m
        except DriveFault:
            return 0.0

    def _charger_m(self, at: Place) -> float:
        """Return the metres to the charger; infinity if there is no way."""
        mission, charger = self._mission, self._mission.charger
        if charger is None:
            return math.inf
        metres = charger_distance(mission.drives, at, charger)
        return math.inf if metres is None else metres

    @property
    def _wait_left_s(self) -> float:
        """Return the seconds left of a wait; no more than the next part of it where it can be left off to charge."""
        mission, robot = self._mission, self._mission.robot
        if not mission.may_recharge or not robot.energy.idle_w:
            return mission.dwell_left_s
        return min(mission.dwell_left_s, PART_PERCENT / robot.percent(0.0, 1.0))

    def _work_left(self, doing: OpenDrive | OpenCapture | None, on_m: float) -> Work:
        """Return the work left of a capture, a stretch or a wait, or the time that a pace adds to a drive."""
        if doing is None:
            return Work(seconds=self._wait_left_s)
        constraints, robot = self._mission.task.constraints, self._mission.robot
        if isinstance(doing, OpenStretch):
            rest = doing.stretch.part(self._mission.controller.reached_m, doing.stretch.length_m)
            if rest is None:
                return Work()
            # The metres themselves are those of the current drive.
            use = use_of(rest, doing.work, constraints, robot, self._mission.slow)
            work = replace(use.work(speed_of(constraints, robot)), metres=0.0)
            return work + Work(seconds=self._slow_ground_s(0.0, doing))
        if isinstance(doing, OpenDrive):
            slower = slower_s_per_m(constraints, robot, min(doing.goal.speed_m_s, self._mission.controller.limit_m_s))
            return Work(seconds=on_m * slower + self._slow_ground_s(on_m, doing))
        action = self._mission.robot.action[doing.action]
        left = max(0.0, 1.0 - self._mission.controller.poll().seconds / action.duration_s)
        return Work(seconds=left * action.duration_s, joules=left * action.energy_j)

    def _slow_ground_s(self, on_m: float, doing: OpenDrive) -> float:
        """Return the seconds that slow ground adds to the metres left of a drive, and to the way home from its end."""
        mission = self._mission
        if not mission.slow or len(mission.driven) < 2:
            return 0.0
        speed = speed_of(mission.task.constraints, mission.robot)
        if self._slow_s is None or self._slow_s[0] is not mission.driven:
            whole_m = LineString(mission.driven).length
            here_s = mission.slow.extra_s(mission.driven, min(speed, doing.goal.speed_m_s))
            self._slow_s = (
                mission.driven,
                here_s / whole_m if whole_m else 0.0,
                self._slow_home_s(doing.goal.place, speed),
            )
        _, per_metre, home_s = self._slow_s
        return on_m * per_metre + (0.0 if self.phase == "exit" else home_s)

    def _slow_home_s(self, at: Place, speed_m_s: float) -> float:
        mission = self._mission
        home = mission.site.home(mission.exit_for("low_budget"), at)
        try:
            return 0.0 if home.xy == at.xy else mission.slow.extra_s(mission.drives.between(at, home).points, speed_m_s)
        except DriveFault:
            return 0.0


def _point(site: Site, xy: tuple[float, float]) -> Place:
    """Return a point of a path as a place at which the robot stands."""
    ((lat, lon),) = site.projection.lat_lon([xy])
    return Place.of_robot(xy, lat=lat, lon=lon)
