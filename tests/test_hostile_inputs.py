"""Text and keys of whatever a mission is planned, signed or carried out with: visible, or refused with the place."""

from __future__ import annotations

import json
import re
from collections.abc import Callable, Iterator
from functools import cache
from typing import Any
from unittest.mock import patch

import pytest
import yaml

from fieldhand import mission
from fieldhand.approval.bundle.container import MANIFEST
from fieldhand.approval.keys.public import parse_public
from fieldhand.errors import FieldhandError
from fieldhand.exchange.btcpp.reading import read_tree
from fieldhand.exchange.btcpp.writing import write_tree
from fieldhand.execution.drivers.simulation.world_file import decode_world, parse_world
from fieldhand.planning.english.planner import EnglishPlanner
from fieldhand.planning.planner import Answer, Planned
from fieldhand.robot.capabilities import capabilities_of
from fieldhand.robot.loader import load_robot, parse_profile, profile_bytes
from fieldhand.site.formats import gis
from fieldhand.site.formats.files import SiteFiles
from fieldhand.site.loader import load_demo, parse_site, site_of
from fieldhand.task.codec import decode, encode
from support.examples import examples
from support.hostile import HIDDEN, each_text, require_visible, texts_of
from support.missions.signed import KEY, manifest_of, members_of, opened, signed_with
from support.missions.signed import good as good_bundle

SITE, HUSKY = load_demo(), load_robot("husky")
CAPABILITIES = capabilities_of(HUSKY)
Case = tuple[str, Callable[[], object]]
#: As it would read if the character had been replaced.
TAKEN_FOR_IT = "zq qz"


def square(at: float) -> list[list[list[float]]]:
    corners = [(0, 0), (0, 3), (3, 3), (3, 0), (0, 0)]
    return [[[round(-120.0 + at + x * 1e-5, 6), round(37.0 + y * 1e-5, 6)] for x, y in corners]]


def feature(geometry: str, coordinates: object, **properties: object) -> dict[str, Any]:
    shape = {"type": geometry, "coordinates": coordinates}
    return {"type": "Feature", "id": "f1", "geometry": shape, "properties": {"note": "any", **properties}}


def orchard() -> dict[str, Any]:
    """A site with everything that can have a name."""
    trees = [
        feature("Point", [-120.0 + 1e-4 * k, 37.0], kind="tree", id=f"t{k}", row="1", block="A", variety="Kerman")
        for k in range(3)
    ]
    others = [
        feature("Point", [-120.0, 37.0002], kind="start", name="Yard"),
        feature("Point", [-119.9999, 37.0002], kind="gate", name="West gate", width_m="4 m"),
        feature("Polygon", square(0.001), kind="zone", name="Wet corner"),
        feature("Polygon", square(0.002), kind="keep_out", name="Pond"),
        feature("LineString", [[-120.0, 37.0005], [-119.9995, 37.0005]], barrier="fence", name="Fence"),
    ]
    return {"type": "FeatureCollection", "name": "Home", "features": [*trees, *others]}


def parsed(document: dict[str, Any]) -> object:
    return parse_site(json.dumps(document).encode(), name="home")


TABLE = [["id", "latitude", "longitude", "variety", "row"], ["a", "37.0", "-120.0", "Kerman", "1"],
         ["b", "37.0001", "-120.0", "Kerman", "1"]]  # fmt: skip


def table(rows: list[list[str]]) -> object:
    text = "\n".join(",".join(f'"{cell}"' for cell in row) for row in rows)
    return site_of(SiteFiles(parts={"home.csv": text.encode()}, source="home.csv"))


KML = ["Home", "t1", "variety", "Kerman"]


def kml(texts: list[str]) -> object:
    home, name, key, value = texts
    document = (
        '<?xml version="1.0" encoding="UTF-8"?><kml xmlns="http://www.opengis.net/kml/2.2"><Document>'
        f"<name>{home}</name><Placemark><name>{name}</name>"
        f'<ExtendedData><Data name="{key}"><value>{value}</value></Data></ExtendedData>'
        "<Point><coordinates>-120,37</coordinates></Point></Placemark></Document></kml>"
    )
    # As it is read in the sandbox, without a process for each.
    with patch.object(gis, "gis_records", gis.read_in_process):
        return site_of(SiteFiles(parts={"home.kml": document.encode("utf-8", "replace")}, source="home.kml"))


def profile(document: dict[str, Any]) -> object:
    return parse_profile(yaml.safe_dump(document).encode(), source="robot.yaml")


def world(document: dict[str, Any]) -> object:
    return decode_world(yaml.safe_dump(document).encode(), source="world.yaml")


WORLD = {
    "readings": {"co2": {"default": 400, "trees": [{"id": "4", "value": 390}]}},
    "faults": [
        {"fault": "action_fails", "action": "read_co2", "at": {"id": "4"}},
        {"fault": "robot_stops", "at_s": 9, "why": "power cut"},
    ],
}


@cache
def planned() -> bytes:
    words = (
        "Read CO2 at tree 4, and if it is below 400 ppm take a thermal picture of the tree next to it; within 200 m."
    )
    outcome = mission.plan(words, SITE, HUSKY, EnglishPlanner())
    assert isinstance(outcome, Planned)
    return encode(outcome.task)


def document(written: bytes, read: Callable[[bytes], object], change: Callable[[str], str]) -> Iterator[Case]:
    """Each attribute and text of an XML document, changed behind its first character."""
    slots = [m for m in re.finditer(rb'(?<==")[^"<>]+(?=")|(?<=>)[^<>]*\S[^<>]*(?=<)', written) if m[0] != b"UTF-8"]
    for slot in slots:
        text = change(slot[0].decode()).encode()
        changed = written[: slot.start()] + text + written[slot.end() :]
        yield slot[0].decode()[:40], lambda changed=changed: read(changed)


def task_xml(change: Callable[[str], str]) -> Iterator[Case]:
    return document(planned(), lambda data: decode(data, source="task.xml"), change)


def tree_xml(change: Callable[[str], str]) -> Iterator[Case]:
    written = write_tree(decode(planned()), CAPABILITIES)
    return document(written, lambda data: read_tree(data, CAPABILITIES, source="tree.xml"), change)


def manifest(changed: dict[str, Any]) -> object:
    return opened(signed_with({MANIFEST: json.dumps(changed).encode()}))


def members(change: Callable[[str], str]) -> Iterator[Case]:
    """The contents of a bundle, signed by whom we trust."""
    for name, data in members_of(good_bundle()).items():
        text = data.decode(errors="replace")
        if name.endswith((".yaml", ".geojson", ".xml")):
            at = text.index("description: ") + 14 if "description: " in text else text.index('"') + 1
            changed = text[:at] + change(text[at]) + text[at + 1 :]
            yield name, lambda name=name, changed=changed: opened(signed_with({name: changed.encode()}))


def each(value: Any, read: Callable[[Any], object]) -> Callable[[Callable[[str], str]], Iterator[Case]]:
    def cases(change: Callable[[str], str]) -> Iterator[Case]:
        for path, changed in each_text(value, change):
            yield path, lambda changed=changed: read(changed)

    return cases


#: Whatever text comes in by before a mission begins, by the name of what holds it.
INPUTS: dict[str, Callable[[Callable[[str], str]], Iterator[Case]]] = {
    "request": each("Read CO2 at tree 4.", lambda text: mission.plan(text, SITE, HUSKY, EnglishPlanner())),
    "answer": each(
        "1", lambda text: mission.plan("Read CO2.", SITE, HUSKY, EnglishPlanner(), (Answer(question="?", answer=text),))
    ),
    "Task": task_xml,
    "tree": tree_xml,
    "site, GeoJSON": each(orchard(), parsed),
    "site, table": each(TABLE, table),
    "site, KML": each(KML, kml),
    "profile": each(yaml.safe_load(profile_bytes("husky")[0]), profile),
    "world": each(WORLD, world),
    "world, sent": each(WORLD, lambda sent: parse_world(sent, source="world")),
    "manifest": each(manifest_of(good_bundle()), manifest),
    "bundle": members,
    "public key": each(KEY.public.line(), lambda line: parse_public(line, source="ada.pub")),
}


def require_refused(place: str, read: Callable[[], object], character: str) -> None:
    """Fail unless a reader refuses what it is given, with its place and what to do, or passes over it."""
    try:
        taken = read()
    except FieldhandError as error:
        refused = error
    else:
        assert not [text for text in texts_of(taken) if character in text or TAKEN_FOR_IT in text], place
        return
    require_visible(str(refused))
    assert refused.where, (place, str(refused))
    assert refused.advice, (place, str(refused))


@pytest.mark.parametrize("name", INPUTS)
def test_text_that_nobody_sees_is_refused_with_its_place_or_passed_over(name: str) -> None:
    for _, read in list(INPUTS[name](lambda text: text))[:1]:
        assert read() is not None
    met = 0
    for number, character in enumerate(HIDDEN):
        cases = list(INPUTS[name](lambda text, hidden=character: f"{text[:1]}zq{hidden}qz{text[1:]}"))
        few, many = len(cases) // examples(8, thorough=1_000), examples(2, thorough=1)
        step = max(1, few, min(many, len(cases)))  # each character at some places, each place with some characters
        for place, read in cases[number % step :: step]:
            met += 1
            require_refused(place, read, character)
    assert met >= len(HIDDEN)
