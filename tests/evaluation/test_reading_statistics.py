"""Statistics of the readings of a mission."""

from __future__ import annotations

import pytest

from fieldhand.evaluation.report.reading_statistics import block_names, reading_statistics
from fieldhand.site.model import Place
from fieldhand.task.results import Acted
from support.sites.planted import planted


def acted(place: Place, value: float, **more: object) -> Acted:
    given = {"t": 0.0, "node": "n1", "action": "read_co2", "status": "success", "kind": place.kind, "place": place.id}
    found = {"lat": place.lat, "lon": place.lon, "readings": {"co2": value}, "units": {"co2": "ppm"}}
    return Acted(**(given | found | more))


def test_statistics_are_those_of_all_readings_and_of_each_block() -> None:
    """The blocks of the readings are told apart only where there are several."""
    rows = [[(float(x), 5.0 * y) for y in range(4)] for x in (0, 4)]
    others = [[(x + 60.0, y) for x, y in row] for row in rows]
    site = planted([(0.0, rows), (0.0, others)])
    trees = [tree.place for tree in site.trees]
    values = {tree.id: 300.0 + 10 * k for k, tree in enumerate(trees)}
    events = [acted(place, values[place.id]) for place in trees]
    (found,) = reading_statistics(site, events)
    every = list(values.values())
    assert (found.quantity, found.unit, found.readings.count) == ("co2", "ppm", len(every))
    assert found.readings.mean == pytest.approx(sum(every) / len(every))
    assert (found.readings.minimum, found.readings.maximum) == (min(every), max(every))
    names = block_names(site)
    assert set(found.blocks) == set(names.values())
    assert len(found.blocks) == 2
    for name, one in found.blocks.items():
        inside = [values[tree] for tree, block in names.items() if block == name]
        assert (one.count, one.mean) == (len(inside), pytest.approx(sum(inside) / len(inside)))
    failed = acted(trees[0], 9999.0, status="failed", readings={})
    assert reading_statistics(site, [*events, failed]) == (found,)
    in_one = [event for event in events if names[event.place] == names[trees[0].id]]
    assert reading_statistics(site, in_one)[0].blocks == {}
