"""What of a selector can be looked up before the robot moves."""

from __future__ import annotations

import pytest

from fieldhand.places import selectors as s
from fieldhand.planning.foreseen import foreseeable

START, POND = s.Marker(name="start"), s.InZone(zone="pond")


@pytest.mark.parametrize(
    ("selector", "parts"),
    [
        (POND, [POND]),
        (s.Here(), []),
        (s.Take(count=2, of=POND), [s.Take(count=2, of=POND)]),
        (s.Nearest(to=s.Here(), of=POND), [POND]),
        (s.Nearest(to=START, fresh=True, of=POND), [START, POND]),
        (s.RowOf(over=2, of=POND), [POND]),
        (s.AlongRow(trees=3), []),
        (s.Successive(count=5), [s.Successive(count=5, near=START)]),
        (s.Spaced(apart_m=9.0, zone="pond"), [s.Spaced(apart_m=9.0, zone="pond", near=START)]),
        (s.Spaced(apart_m=9.0, of=s.RowOf()), [s.Trees()]),
        (s.Ordered(by="nearest_first", of=POND), [s.Ordered(by="nearest_first", of=POND)]),
    ],
)
def test_the_largest_parts_that_do_not_depend_on_the_mission(selector: s.Selector, parts: list[s.Selector]) -> None:
    assert list(foreseeable(selector)) == parts
