"""On a drive that costs far more than expected the robot turns to its charger, and makes the drive again."""

from __future__ import annotations

from functools import cache

import numpy as np
import pytest

from fieldhand import mission
from fieldhand.approval.authorize import EveryWarning
from fieldhand.places.selectors import EveryNth
from fieldhand.site.model import Site
from fieldhand.task.plan import Act, ForEach
from fieldhand.task.results import Acted, Arrived, ChargeBegun, ChargeEnded, Driving, LimitCrossed
from support.missions.rechargeable import rechargeable, task_of
from support.missions.rig import of_type

FLIGHTS = 8


@cache
def flights() -> tuple[mission.ApprovedMission, tuple[mission.Run, ...]]:
    """Return missions whose farthest places take a fifth of the battery each way, which the profile accepts."""
    site, robot = Site.demo(), rechargeable(115_000, most_percent=90, stranding_probability=0.05)
    plan = ForEach(select=EveryNth(nth=6), body=Act(action="take_thermal_picture"))
    review = mission.review(task_of(plan, site, robot, recharge=True), site, robot)
    approved = mission.authorize(review, by="tests", confirmed=EveryWarning())
    return approved, tuple(mission.simulate(approved, seed=seed) for seed in range(FLIGHTS))


def test_it_charges_and_makes_the_visit_then() -> None:
    turned = 0
    for run in flights()[1]:
        events = list(run.events)
        for number, event in enumerate(events):
            if not isinstance(event, LimitCrossed) or event.level != "costly_drive":
                continue
            turned += 1
            assert event.then == "return"
            broken_off = next(e for e in reversed(events[:number]) if isinstance(e, Driving))
            following = [e for e in events[number:] if isinstance(e, ChargeBegun | ChargeEnded | Driving | Arrived)]
            assert [e.place for e in following[:4]] == ["charger"] * 4
            assert next(e for e in following[4:] if isinstance(e, Arrived)).place == broken_off.place
    assert turned >= 2


def test_everything_is_done_and_no_robot_is_stopped() -> None:
    for run in flights()[1]:
        assert run.status == "completed", run.reason
        assert all(outcome.outcome == "success" for outcome in run.outcomes)
        assert not [e for e in of_type(run.events, LimitCrossed) if e.then == "stop"]
        places = [e.place for e in of_type(run.events, Acted)]
        assert len(places) == len(set(places))


def test_the_forecast_counts_the_drives_broken_off() -> None:
    approved, runs = flights()
    assert approved.estimate is not None
    worst = approved.estimate.worst
    assert worst.charges is not None
    charges = [len(of_type(run.events, ChargeEnded)) for run in runs]
    seconds = [run.result.spent.seconds for run in runs]
    assert np.mean(charges) == pytest.approx(worst.charges.mean, abs=3.0 * np.std(charges) / np.sqrt(FLIGHTS))
    assert np.mean(seconds) == pytest.approx(worst.seconds.mean, abs=3.0 * np.std(seconds) / np.sqrt(FLIGHTS))
