"""Preview, simulated robot, replay of the log and exported tree carry a plan out alike."""

from __future__ import annotations

from hypothesis import given, settings
from hypothesis import strategies as st

from missions.agreement import disagreements, simulated
from support.examples import examples


@settings(max_examples=examples(25, thorough=3000), deadline=None)
@given(st.integers(0, 2**32 - 1))
def test_whoever_carries_a_plan_out_comes_to_the_same_places_in_the_same_order_and_makes_the_same_captures(seed):
    assert disagreements(simulated(seed)) == []
