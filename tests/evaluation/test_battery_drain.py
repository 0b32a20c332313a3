"""The drain of a battery beside its model, when the program was dead for a while."""

import pytest

from fieldhand.evaluation.battery_drain import BatteryDrain
from fieldhand.forecast.mission_state import Spent
from fieldhand.testing.small_orchard import husky

ROBOT = husky()
#: Seconds without the program, and what the robot uses meanwhile where it stands.
LUNCH_S = 3600.0
LUNCH = ROBOT.percent(0.0, LUNCH_S)


def driven(metres, factor=1.0, lunch=0.0, absent_s=LUNCH_S, before=None):
    """Spent after so many metres, and lunch after 100 of them; the battery drains so much faster."""
    percent = factor * ROBOT.percent(metres, metres)
    is_back = metres >= 100.0
    return Spent(
        metres=metres, seconds=metres, percent=percent + lunch * is_back, absent_s=absent_s if is_back else 0.0
    )


def learned(*spent):
    drain = BatteryDrain(ROBOT)
    for one in spent:
        drain.learn(one)
    return drain


def test_a_robot_that_stood_meanwhile_does_not_empty_faster():
    assert LUNCH > 5.0
    way = [driven(metres, lunch=LUNCH) for metres in range(0, 600, 5)]
    assert learned(*way).factor == pytest.approx(1.0, abs=0.06)
    forgotten = [driven(metres, lunch=LUNCH, absent_s=0.0) for metres in range(0, 600, 5)]
    assert learned(*forgotten).factor > 1.5


def test_the_charge_that_is_read_late_counts_as_well():
    late = driven(101.0, lunch=0.0)
    way = [driven(99.0), late, driven(102.0, lunch=LUNCH), *(driven(m, lunch=LUNCH) for m in range(105, 600, 5))]
    assert learned(*way).factor == pytest.approx(1.0, abs=0.06)


@pytest.mark.parametrize("lunch", [0.0, LUNCH])
def test_a_battery_that_empties_too_fast_is_found_all_the_same(lunch):
    way = [driven(metres, factor=2.0, lunch=lunch) for metres in range(0, 1500, 5)]
    assert learned(*way).factor > 1.7


def test_more_than_standing_takes_is_not_excused():
    way = [driven(metres, lunch=3.0 * LUNCH) for metres in range(0, 600, 5)]
    assert learned(*way).factor > 1.5
