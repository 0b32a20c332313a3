"""The readers that are fuzzed: valid seeds, mutations, and a call as with a user's file.

A target may raise only errors that the command line reports as a message (:class:`fieldhand.errors.FieldhandError`).
A document that is read without an error is also used: written again, bound to a site, simulated.
"""

from __future__ import annotations

import json
import random
from collections.abc import Callable
from contextlib import suppress
from dataclasses import asdict, dataclass
from pathlib import Path

from fieldhand import mission
from fieldhand.approval.bundle.container import MANIFEST, ROBOT, SIGNATURE, TASK, wrap
from fieldhand.approval.bundle.opening import open_bundle
from fieldhand.approval.keys.public import parse_public
from fieldhand.approval.keys.signing import OwnKey, SigningKeys
from fieldhand.approval.keys.trust import TrustStore
from fieldhand.errors import FieldhandError, TaskError
from fieldhand.evaluation.calibration.measured_steps import measure_mission
from fieldhand.exchange.btcpp import read_tree, write_tree
from fieldhand.exchange.mcap.reading import read_mcap
from fieldhand.exchange.mcap.writing import McapLog
from fieldhand.execution.drivers.simulation.world_file import load_world
from fieldhand.execution.event_log import read_events
from fieldhand.robot.capabilities import capabilities_of
from fieldhand.robot.loader import parse_profile, profile_bytes, robot_names
from fieldhand.site.formats.files import SiteFiles
from fieldhand.site.formats.geojson import geojson_records
from fieldhand.site.formats.geojson_export import site_document
from fieldhand.site.loader import demo_path, site_of
from fieldhand.task.codec import decode, decode_draft, encode
from fieldhand.task.event_lines import from_json
from fieldhand.task.references import references
from fieldhand.task.schema import require_valid, schema_xsd
from fuzzing import documents as g
from fuzzing.mutate import Mutator, mutate_json, mutate_lines, mutate_text, mutate_xml, mutate_yaml

WORLD = b"""\
seed: 7
charge_percent: 90
begins: 2026-05-01T06:00:00Z
readings:
  co2: 380
  canopy_temperature:
    default: 31
    trees:
    - {id: "5", value: 36.5}
    - {lat: 37.00006, lon: -119.999944, value: 38}
faults:
- {fault: action_fails, action: read_co2, times: 2}
- {fault: sensor_silent, quantity: co2, at: {id: "5"}, times: 1}
- {fault: sensor_absurd, quantity: co2, value: 99999, times: 1}
- {fault: drive_fails, at: {id: "5"}, times: 1}
- {fault: blocked, at: {id: "4"}, within_m: 1.5, times: 1}
- {fault: blocked, between: [{id: "4"}, {id: "5"}], from_s: 60, until_s: 600}
- {fault: localisation_lost, at_s: 12, for_s: 30}
- {fault: localisation_lost, at: {id: "5"}, within_m: 5, for_s: 30, times: 1}
- {fault: battery_drains, factor: 2, from_s: 30}
- {fault: clock_jumps, at_s: 30, by_s: -3600}
- {fault: disk_full, at_s: 600}
- {fault: robot_stops, at_s: 900, why: power cut}
"""
TABLE = b"""\
id,kind,latitude,longitude,row,variety,age (years)
1,tree,37.0,-120.0,R1,"Kerman, old",12
2,tree,37.0,-119.999944,R1,Peters,
3,,37.00006,-120.0,R2,Kerman,7.5
,start,36.99994,-120.0,,,
,end,36.99994,-119.9999,,,
"""


@dataclass(frozen=True, kw_only=True)
class Target:
    """A reader to be fuzzed.

    Attributes:
        seeds: Function that returns valid documents.
        mutate: Function that changes a document.
        read: Function that reads a document; the folder is for readers that take a path.
    """

    seeds: Callable[[Path], list[bytes]]
    mutate: Mutator
    read: Callable[[bytes, Path], None]


def _profile(data: bytes, _: Path) -> None:
    robot = parse_profile(data)
    json.dumps(asdict(robot), ensure_ascii=False).encode()
    capabilities = capabilities_of(robot)
    schema_xsd(capabilities)
    with suppress(TaskError):
        require_valid(encode(g.tasks()[0]), capabilities)


def _world(data: bytes, folder: Path) -> None:
    world = load_world(g.scratch(folder, "world.yaml", data))
    here = g.small_orchard()
    mission.check_world(world, here.site, here.robot)
    g.flown(world)


def _task(data: bytes, _: Path) -> None:
    capabilities = capabilities_of(g.small_orchard().robot)
    with suppress(FieldhandError):
        decode_draft(data)
    with suppress(FieldhandError):
        require_valid(data, capabilities)
    task = decode(data)
    document = encode(task)
    if decode(document) != task:
        raise AssertionError("a Task that is written and read again is another")
    references(task, capabilities)
    with suppress(FieldhandError):
        write_tree(task, capabilities)


def _tree(data: bytes, _: Path) -> None:
    capabilities = capabilities_of(g.small_orchard().robot)
    task = read_tree(data, capabilities, request="Measure CO2.")
    references(task, capabilities)
    require_valid(encode(task), capabilities)


def _bundle(data: bytes, _: Path) -> None:
    open_bundle(data, source="m.mission", known=g.known(), now=g.NOW)


def _site(name: str) -> Callable[[bytes, Path], None]:
    def read(data: bytes, _: Path) -> None:
        files = SiteFiles(parts={name: data}, source=name)
        with suppress(FieldhandError):
            site_of(files, lenient=True)
        site = site_of(files)
        _ = site.content_sha256
        document = json.dumps(site_document(site), allow_nan=False).encode()
        geojson_records(document, "again")

    return read


def _log(data: bytes, folder: Path) -> None:
    path = g.scratch(folder, "events.jsonl", data)
    with suppress(FieldhandError):
        measure_mission(read_events(path, whole=False))
    mission.assess(g.tasks()[2], read_events(path))


def _mcap(data: bytes, folder: Path) -> None:
    read_mcap(g.scratch(folder, "log.mcap", data))


def _key(data: bytes, folder: Path) -> None:
    """Read the bytes as a public key, as the file of a trusted key, and as an own signing key."""
    trusted = folder / "trusted"
    trusted.mkdir(exist_ok=True, mode=0o700)
    g.scratch(trusted, f"{g.key().public.fingerprint}.json", data).chmod(0o600)
    with suppress(FieldhandError):
        TrustStore(folder).known()
    with suppress(FieldhandError):
        SigningKeys(folder).open(_own_key(folder, data), lambda: "wrong")
    parse_public(data.decode(errors="replace"), source="key.pub")


def _own_key(folder: Path, data: bytes) -> OwnKey:
    file = g.scratch(folder, "own.key", data)
    file.chmod(0o600)
    return OwnKey(file=file, public=g.key().public, encrypted=b"ENCRYPTED" in data)


def _mutate_bundle(data: bytes, rng: random.Random) -> bytes:
    """Change a member and sign the bundle again, with or without correct hashes; sometimes change the zip file."""
    if rng.random() < 0.15:
        return mutate_text(data, rng)
    try:
        members = g.members_of(data)
    except FieldhandError:
        members = g.members_of(g.bundle())
    by_member: dict[str, Mutator] = {
        MANIFEST: mutate_json,
        TASK: mutate_xml,
        ROBOT: mutate_yaml,
        SIGNATURE: mutate_text,
        "site.geojson": mutate_json,
    }
    name = rng.choice((MANIFEST, MANIFEST, TASK, ROBOT, "site.geojson", SIGNATURE))
    members = {**members, name: by_member.get(name, mutate_text)(members.get(name, b""), rng)}
    try:
        if name == SIGNATURE:
            return wrap(members)
        return g.sealed(members, hashes=rng.random() < 0.7)
    except (FieldhandError, ValueError, TypeError, KeyError, AttributeError, RecursionError):
        return mutate_text(data, rng)


def _mutate_mcap(data: bytes, rng: random.Random) -> bytes:
    """Change a few bytes, or copy a piece from elsewhere in the file."""
    changed = bytearray(data)
    for _ in range(rng.choice((1, 1, 2, 4, 16))):
        k, other = rng.randrange(len(changed) + 1), rng.randrange(len(changed) + 1)
        size = rng.choice((0, 1, 2, 4, 8, 40))
        new = rng.choice((rng.randbytes(size), changed[other : other + size], b"\xff" * size, b"\0" * size))
        changed[k : k + rng.choice((0, size, len(new)))] = new
    return bytes(changed)


def _mcap_seeds(folder: Path) -> list[bytes]:
    path = folder / "seed.mcap"
    with McapLog(path, site=g.small_orchard().site) as log:
        for line in g.log().splitlines():
            event = from_json(line.decode())
            if event is not None:
                log(event)
    return [path.read_bytes()]


def _trees(_: Path) -> list[bytes]:
    return [write_tree(task, capabilities_of(g.small_orchard().robot)) for task in g.tasks()]


def _key_seeds(folder: Path) -> list[bytes]:
    TrustStore(folder / "seed").trust(g.key().public, name="Ada", at=g.NOW)
    kept = next((folder / "seed" / "trusted").glob("*-*.json")).read_bytes()
    own = [SigningKeys(folder / "seed").make(*words)[1] for words in (("Ada",), ("Bo", "wrong"))]
    return [f"> {g.key().public.line()}\n".encode(), kept, *(path.with_suffix(".key").read_bytes() for path in own)]


TARGETS: dict[str, Target] = {
    "bundle": Target(seeds=lambda _: [g.bundle()], mutate=_mutate_bundle, read=_bundle),
    "task": Target(seeds=lambda _: [encode(t) for t in g.tasks()], mutate=mutate_xml, read=_task),
    "tree": Target(seeds=_trees, mutate=mutate_xml, read=_tree),
    "world": Target(seeds=lambda _: [WORLD], mutate=mutate_yaml, read=_world),
    "profile": Target(
        seeds=lambda _: [profile_bytes(name)[0] for name in robot_names()], mutate=mutate_yaml, read=_profile
    ),
    "site": Target(
        seeds=lambda _: [g.orchard(), demo_path().read_bytes()], mutate=mutate_json, read=_site("site.geojson")
    ),
    "table": Target(seeds=lambda _: [TABLE], mutate=mutate_text, read=_site("site.csv")),
    "log": Target(seeds=lambda _: [g.log()], mutate=mutate_lines, read=_log),
    "mcap": Target(seeds=_mcap_seeds, mutate=_mutate_mcap, read=_mcap),
    "key": Target(seeds=_key_seeds, mutate=mutate_text, read=_key),
}
