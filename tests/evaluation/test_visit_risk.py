"""How safe one visit must be so that a mission of many that will not all last keeps to what is accepted."""

import numpy as np
import pytest

from fieldhand.evaluation.visit_risk import VisitRisk
from fieldhand.forecast.mission_state import Visit
from fieldhand.orienteering.costs import ShiftedExponential
from fieldhand.orienteering.overrun import overrun_probability
from fieldhand.site.model import Place

COSTS = ShiftedExponential(0.5)


def place(x, y=0.0):
    return Place(kind="point", id=f"{x:g},{y:g}", x=x, y=y, lat=0.0, lon=0.0)


def metres(a, b):
    return float(np.hypot(a.x - b.x, a.y - b.y))


def missions(threshold, chance, stops, left, count, seed):
    """Return how many run short and how many visits they make, driven one by one, home at 0."""
    rng, failed, visits = np.random.default_rng(seed), 0, 0
    for _ in range(count):
        at, room = threshold.here, left
        for stop in stops:
            legs = np.array([metres(at, stop), metres(stop, place(0.0))])
            risk = overrun_probability(legs.sum(), 0.25 * (legs**2).sum(), 0.25 * (legs**3).sum(), room)
            if float(risk) > chance:
                break
            room -= legs[0] * float(COSTS.draw(rng, 1)[0])
            at, visits = stop, visits + 1
        failed += room - metres(at, place(0.0)) * float(COSTS.draw(rng, 1)[0]) < 0.0
    return failed, visits


@pytest.mark.parametrize("accepted", [0.05, 0.2])
@pytest.mark.parametrize("spread", [5.0, 40.0])
def test_a_mission_that_will_not_last_runs_short_no_more_often_than_accepted(accepted, spread):
    rng = np.random.default_rng(int(spread))
    stops = [place(*xy) for xy in rng.uniform(-spread, spread, (60, 2))]
    left = 12.0 * spread
    threshold = VisitRisk(
        here=place(0.0),
        stops=[Visit(place=p) for p in stops],
        length=metres,
        home=lambda _: place(0.0),
        service=np.zeros((len(stops), 1)),
        left=np.array([left]),
        costs=COSTS,
    )
    (chance,) = threshold.accepted_chance(np.array([accepted]), np.random.default_rng(0))
    # One visit may be riskier than the mission: few missions come to it.
    assert 0.0 < chance <= 0.5
    failed, visits = missions(threshold, chance, stops, left, 600, 1)
    assert failed <= accepted * 600 + 3 * np.sqrt(accepted * (1 - accepted) * 600)
    assert visits > 600
    # Allowing each visit more would be too much: the figure is no larger than it has to be by far.
    assert missions(threshold, min(0.9, 4 * chance), stops, left, 600, 2)[0] > 0.5 * failed


def test_work_and_several_limits_count():
    stops = [place(float(x)) for x in range(1, 40)]

    def within(service, left):
        return VisitRisk(
            here=place(0.0),
            stops=[Visit(place=p) for p in stops],
            length=metres,
            home=lambda _: place(0.0),
            service=np.full((len(stops), len(left)), service),
            left=np.array(left),
            costs=COSTS,
        ).accepted_chance(np.full(len(left), 0.1), np.random.default_rng(3))

    alone = within(0.0, [30.0])
    assert within(0.0, [30.0, 1e6])[0] == alone[0]
    assert (within(2.0, [30.0]) <= 0.5).all()
