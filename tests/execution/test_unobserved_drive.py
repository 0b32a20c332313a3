"""What a robot drove while nobody looked: measured where it counts its metres, else estimated, if plausible."""

import math
from dataclasses import replace

import pytest
from hypothesis import given
from hypothesis import strategies as st

from fieldhand.execution.drivers.protocol import DriveGoal, Position, Progress
from fieldhand.execution.journal.records import Observation, observation_of
from fieldhand.execution.unobserved_drive import UnobservedDrive, drive_since
from fieldhand.site.model import Place

#: Ten metres east, then ten north.
CORNERS = ((0.0, 0.0), (10.0, 0.0), (10.0, 10.0))
GOAL = DriveGoal(
    place=Place(kind="point", id="p", x=10.0, y=10.0, lat=0.0, lon=0.0),
    path_m=CORNERS,
    path_degrees=CORNERS,
    length_m=20.0,
    speed_m_s=0.5,
)


def at(x, y):
    return Position(x=x, y=y, lat=0.0, lon=0.0)


def seen(position, odometer_m=None):
    return Observation(
        t=0.0,
        position=position,
        charge_percent=90.0,
        progress=Progress(state="running"),
        stopped=None,
        lost=None,
        next_in=None,
        order=None,
        odometer_m=odometer_m,
    )


def test_along_the_way_around_its_corner():
    driven = drive_since(seen(at(4.0, 0.0)), GOAL, at(10.0, 7.0), None, within_s=math.inf)
    assert (driven.metres, driven.by) == (pytest.approx(13.0), "path")
    assert driven.seconds == pytest.approx(26.0)
    assert drive_since(seen(at(4.0, 0.0)), GOAL, at(10.0, 7.0), None, within_s=9.0).seconds == 9.0


def test_straight_on_where_it_left_the_way():
    driven = drive_since(seen(at(4.0, 0.0)), GOAL, at(4.0, 8.0), None, within_s=math.inf)
    assert (driven.metres, driven.by) == (pytest.approx(8.0), "line")


def test_nothing_where_it_stands():
    assert drive_since(seen(at(4.0, 0.0)), GOAL, at(4.01, 0.0), None, within_s=60.0) == UnobservedDrive()


@pytest.mark.parametrize(
    ("before_m", "after_m", "by", "metres"),
    [
        (100.0, 115.5, "odometer", 15.5),
        (100.0, 3.0, "path", 13.0),  # it was switched off and on
        (100.0, 900.0, "path", 13.0),  # farther than it can have driven in that time
        (None, 15.0, "path", 13.0),
        (100.0, None, "path", 13.0),
    ],
)
def test_an_odometer_counts_unless_it_was_reset(before_m, after_m, by, metres):
    driven = drive_since(seen(at(4.0, 0.0), before_m), GOAL, at(10.0, 7.0), after_m, within_s=60.0)
    assert (driven.by, driven.metres) == (by, pytest.approx(metres))


@given(st.floats(0.0, 20.0), st.floats(0.0, 20.0))
def test_an_estimate_is_no_shorter_than_the_straight_line(a, b):
    def on_way(m):
        return at(min(m, 10.0), max(0.0, m - 10.0))

    first, then = on_way(min(a, b)), on_way(max(a, b))
    driven = drive_since(seen(first), GOAL, then, None, within_s=math.inf)
    assert driven.metres >= math.dist(first.xy, then.xy) - 0.06
    assert driven.metres == pytest.approx(abs(a - b), abs=0.1)


def test_the_journal_keeps_it():
    whole = replace(seen(at(1.0, 2.0), 4.5), unobserved=UnobservedDrive(metres=3.0, seconds=6.0, by="odometer"))
    assert observation_of(whole.record()) == whole
    assert "odometer" not in seen(at(1.0, 2.0)).record().body
