"""Valid documents for the targets, all generated: a small orchard, a robot, Tasks, an event log, a signed bundle."""

from __future__ import annotations

import hashlib
import json
from dataclasses import dataclass
from datetime import datetime
from functools import cache
from pathlib import Path
from typing import Any

from cryptography.hazmat.primitives.asymmetric.ed25519 import Ed25519PrivateKey

from fieldhand import mission
from fieldhand.approval.authorize import EveryWarning, approve
from fieldhand.approval.bundle.container import MANIFEST, ROBOT, SIGNATURE, TASK, unwrap, wrap
from fieldhand.approval.bundle.packing import pack
from fieldhand.approval.bundle.signature import sign_manifest
from fieldhand.approval.checks import examine
from fieldhand.approval.keys.public import PublicKey
from fieldhand.approval.keys.signing import SigningKey
from fieldhand.approval.keys.trust import KnownKey
from fieldhand.compatibility import UTC
from fieldhand.execution.drivers.simulation.world import World
from fieldhand.planning.english.planner import EnglishPlanner
from fieldhand.planning.planner import Planned
from fieldhand.robot.loader import parse_profile, profile_bytes
from fieldhand.robot.model import RobotProfile
from fieldhand.site.formats.files import SiteFiles
from fieldhand.site.loader import site_of
from fieldhand.site.model import Site
from fieldhand.task.authorization import AuthorizedTask
from fieldhand.task.event_lines import to_json
from fieldhand.task.frames import Task
from fieldhand.task.results import Event

NOW = datetime(2026, 5, 1, 12, tzinfo=UTC)
WHEN = "2026-05-01T08:00:00+02:00"
REQUESTS = (
    "Measure CO2 at tree 5.",
    "Take thermal pictures of as many trees as you can in 20 minutes and return to the start.",
    "Take a thermal picture of each corner tree. If it is below 33 C, read the CO2 there.",
    "Take a picture of the yellow trees. Then read the CO2 at the tree nearest to the end, 3 times, and come back.",
    "Read the CO2 at trees 1 to 4 without tree 3, and go to the start when the battery is below 30 %.",
    "Visit every second tree of row 2 and take pictures. Repeat twice.",
)


@dataclass(frozen=True, kw_only=True)
class SiteAndRobotFiles:
    """A site and a robot with the bytes from which they were read."""

    files: SiteFiles
    site: Site
    profile: bytes
    robot: RobotProfile


@cache
def small_orchard() -> SiteAndRobotFiles:
    """Return an orchard of 3 rows of 5 trees with a pond and a fence, and the husky."""
    files = SiteFiles(parts={"orchard.geojson": orchard()}, source="orchard.geojson")
    profile, source = profile_bytes("husky")
    return SiteAndRobotFiles(
        files=files, site=site_of(files), profile=profile, robot=parse_profile(profile, source=source)
    )


def orchard() -> bytes:
    """Return the GeoJSON of the orchard."""

    def at(row: float, column: float) -> list[float]:
        return [round(-120.0 + column * 5.6e-5, 7), round(37.0 + row * 6e-5, 7)]

    def feature(shape: str, where: Any, **properties: Any) -> dict[str, Any]:
        return {"type": "Feature", "properties": properties, "geometry": {"type": shape, "coordinates": where}}

    def ring(south: float, west: float, north: float, east: float) -> list[list[float]]:
        return [at(south, west), at(south, east), at(north, east), at(north, west), at(south, west)]

    trees = [
        feature("Point", at(r, c), id=5 * r + c + 1, row=f"R{r}", variety="Kerman", age_years=7 + c, yellow=c % 2 == 0)
        for r in range(3)
        for c in range(5)
    ]
    rest = [
        feature("Point", at(-1, 0), kind="start"),
        feature("Point", at(-1, 4), **{"marker-symbol": "end"}),
        feature("Polygon", [ring(-3, -3, 5, 8)], kind="boundary", name="fence"),
        feature("Polygon", [ring(3.2, 1, 3.6, 2)], kind="keep-out", name="pond"),
        feature("MultiPolygon", [[ring(0, 0, 1, 1)]], name="wet corner"),
        feature("LineString", [at(-1.5, -1), at(-1.5, 6)], kind="wall"),
        feature("Point", at(-1.5, 2), kind="gate", width_m="4 m"),
    ]
    return json.dumps({"type": "FeatureCollection", "name": "small", "features": [*trees, *rest]}, indent=1).encode()


@cache
def tasks() -> tuple[Task, ...]:
    """Return a Task for each request that can be planned without a question."""
    here, planner = small_orchard(), EnglishPlanner()
    outcomes = (planner.plan(request, here.site, here.robot) for request in REQUESTS)
    return tuple(outcome.task for outcome in outcomes if isinstance(outcome, Planned))


@cache
def approved() -> AuthorizedTask:
    """Return the first Task, approved."""
    here = small_orchard()
    return approve(examine(tasks()[0], here.site, here.robot), by="Ada", at=WHEN, confirmed=EveryWarning())


def flown(world: World, *, approved_mission: mission.ApprovedMission | None = None) -> tuple[Event, ...]:
    """Return the events of a mission simulated in a world."""
    here = small_orchard()
    given = mission.ApprovedMission(authorized=approved(), site=here.site, robot=here.robot)
    return mission.simulate(approved_mission or given, world=world).events


@cache
def log() -> bytes:
    """Return the event log of a mission that tests a condition."""
    here = small_orchard()
    review = mission.review(tasks()[2], here.site, here.robot)
    given = mission.authorize(review, by="Ada", at=NOW, confirmed=EveryWarning())
    return b"".join(to_json(event).encode() + b"\n" for event in flown(World(), approved_mission=given))


@cache
def key() -> SigningKey:
    """Return the signing key, which is fixed and trusted nowhere else."""
    private = Ed25519PrivateKey.from_private_bytes(b"\1" * 32)
    return SigningKey(public=PublicKey(raw=private.public_key().public_bytes_raw(), name="Ada"), _private=private)


@cache
def known() -> dict[str, KnownKey]:
    """Return the trusted keys of a robot that trusts this key."""
    public = key().public
    return {public.fingerprint: KnownKey(fingerprint=public.fingerprint, name="Ada", since=WHEN, public=public)}


@cache
def bundle() -> bytes:
    """Return the approved mission as a signed bundle."""
    here = small_orchard()
    return pack(
        approved(),
        here.site,
        here.robot,
        files=here.files,
        lenient=False,
        profile=here.profile,
        key=key(),
        planner="english",
    )


def sealed(members: dict[str, bytes], *, hashes: bool) -> bytes:
    """Return a bundle of these members, signed by a trusted key, as a faulty program could write it.

    Args:
        members: Contents of the members by name.
        hashes: True to update the hashes in the manifest, so that the checks after the hash check are reached.
    """
    if hashes:
        manifest = json.loads(members[MANIFEST])
        rest = {name: data for name, data in members.items() if name not in (MANIFEST, SIGNATURE)}
        manifest["files"] = {name: hashlib.sha256(data).hexdigest() for name, data in sorted(rest.items())}
        for part, name in (("task", TASK), ("robot", ROBOT), ("site", "site.geojson")):
            manifest[part]["sha256"] = hashlib.sha256(members[name]).hexdigest()
        members = {**members, MANIFEST: json.dumps(manifest, ensure_ascii=False, indent=2).encode() + b"\n"}
    return wrap({**members, SIGNATURE: sign_manifest(members[MANIFEST], key()).text()})


def members_of(data: bytes) -> dict[str, bytes]:
    """Return the members of a bundle that can still be unpacked."""
    return dict(unwrap(data, source="bundle"))


def scratch(folder: Path, name: str, data: bytes) -> Path:
    """Write a file for readers that take a path, and return its path."""
    path = folder / name
    path.write_bytes(data)
    return path
