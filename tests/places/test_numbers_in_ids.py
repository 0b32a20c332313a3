"""Trees of a row count from where the numbers in their ids begin."""

from __future__ import annotations

import json
from pathlib import Path

import pytest

from fieldhand.places import selectors as s
from fieldhand.places.context import Context
from fieldhand.places.resolution import resolve
from fieldhand.site.model import Site

EAST_M, NORTH_M = 1 / 70_000, 1 / 111_200


def beds(tmp_path: Path, name_of: str, *, rising_to_north: bool) -> Site:
    """Return three beds of six plants; ``name_of`` is the format of ids by bed and number, from the end at which
    numbers begin."""
    features = []
    for bed in range(1, 4):
        for number in range(1, 7):
            north = number if rising_to_north else 7 - number
            features.append(
                {
                    "type": "Feature",
                    "properties": {"row": bed, "id": name_of.format(bed=bed, number=number, all=6 * bed + number)},
                    "geometry": {
                        "type": "Point",
                        "coordinates": [3.65 + bed * 2.5 * EAST_M, 51.01 + north * 0.6 * NORTH_M],
                    },
                }
            )
    path = tmp_path / "beds.geojson"
    path.write_text(json.dumps({"type": "FeatureCollection", "features": features}))
    return Site.read(path)


def ids(site: Site, selector: s.Selector) -> list[str]:
    return [place.id for place in resolve(selector, site, Context(here=site.start))]


@pytest.mark.parametrize("rising_to_north", [True, False])
@pytest.mark.parametrize("name_of", ["B{bed:02}-{number:02}", "{bed}.{number}", "bed {bed} plant {number}"])
def test_the_first_tree_is_the_one_with_the_lowest_number(tmp_path: Path, name_of: str, rising_to_north: bool) -> None:
    site = beds(tmp_path, name_of, rising_to_north=rising_to_north)
    expected = [name_of.format(bed=2, number=n) for n in range(1, 7)]
    row = s.Rows(first="2", last="2")
    assert ids(site, s.InRow(first=1, last=1, of=row)) == expected[:1]
    assert ids(site, s.InRow(first=-1, last=-1, of=row)) == expected[-1:]
    assert sorted(ids(site, s.EveryNth(nth=2, start=2, of=row))) == expected[1::2]


def test_a_side_that_is_named_goes_before_the_numbers(tmp_path: Path) -> None:
    site = beds(tmp_path, "B{bed}-{number}", rising_to_north=True)
    first = s.InRow(first=1, last=1, counted_from="north", of=s.Rows(first="2", last="2"))
    assert ids(site, first) == ["B2-6"]


@pytest.mark.parametrize("name_of", ["N{all}", "{all}", "plant {all}"])
def test_numbers_of_the_whole_site_are_no_numbers_in_a_row(tmp_path: Path, name_of: str) -> None:
    site = beds(tmp_path, name_of, rising_to_north=True)
    first = ids(site, s.InRow(first=1, last=1, of=s.Rows(first="2", last="2")))
    assert first == [name_of.format(all=18)]
