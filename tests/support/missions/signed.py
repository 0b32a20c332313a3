"""Signed missions on a small site, and ways to make bundles that nobody should take."""

from __future__ import annotations

import io
import json
import zipfile
from collections.abc import Mapping
from dataclasses import replace
from datetime import datetime
from functools import cache
from typing import Any

from cryptography.hazmat.primitives.asymmetric.ed25519 import Ed25519PrivateKey

from fieldhand.approval.authorize import EveryWarning, approve
from fieldhand.approval.bundle.container import MANIFEST, SIGNATURE, wrap
from fieldhand.approval.bundle.opening import Bundle, open_bundle
from fieldhand.approval.bundle.packing import pack
from fieldhand.approval.bundle.signature import sign_manifest
from fieldhand.approval.checks import examine
from fieldhand.approval.keys.public import PublicKey
from fieldhand.approval.keys.signing import SigningKey
from fieldhand.approval.keys.trust import KnownKey
from fieldhand.compatibility import UTC
from fieldhand.places.selectors import TreeIs
from fieldhand.robot.loader import parse_profile, profile_bytes
from fieldhand.site.formats.files import SiteFiles
from fieldhand.site.loader import site_of
from fieldhand.task.plan import Act
from fieldhand.task.timing import Timing
from fieldhand.testing.small_orchard import at, task_for
from support.sites.points import collection, point

WHEN = "2026-05-01T08:00:00+02:00"
NOW = datetime(2026, 5, 1, 12, tzinfo=UTC)
Members = dict[str, bytes]


def signing_key(seed: int = 1, name: str = "Ada") -> SigningKey:
    """A key that is the same each time."""
    private = Ed25519PrivateKey.from_private_bytes(bytes([seed]) * 32)
    return SigningKey(public=PublicKey(raw=private.public_key().public_bytes_raw(), name=name), _private=private)


KEY = signing_key()


def known(*keys: SigningKey, revoked: str | None = None) -> dict[str, KnownKey]:
    """Return the known keys of a machine that trusts these keys."""
    found = [key.public for key in keys or (KEY,)]
    return {
        public.fingerprint: KnownKey(
            fingerprint=public.fingerprint, name=public.name, since=WHEN, public=public, revoked=revoked
        )
        for public in found
    }


def orchard_files(trees: int = 6) -> SiteFiles:
    """A small orchard in one row, as a file."""
    features = [point(*at(-1, 0), kind="start"), *(point(*at(0, k), kind="tree", id=k + 1) for k in range(trees))]
    return SiteFiles(parts={"orchard.geojson": collection(*features)}, source="orchard.geojson")


def pack_mission(
    files: SiteFiles | None = None,
    *,
    key: SigningKey = KEY,
    lenient: bool = False,
    at: str = WHEN,
    by: str = "Ada",
    timing: Timing | None = None,
    **more: Any,
) -> bytes:
    """A good bundle: CO2 at tree 1, with what is warned of (once, not three times) confirmed."""
    files = files or orchard_files()
    profile, source = profile_bytes("husky")
    robot = parse_profile(profile, source=source)
    site = site_of(files, lenient=lenient)
    act = Act(id="", action="read_co2", at=TreeIs(tree="1"), said=((0, 30),))
    task = task_for(site, act, "Take 3 CO2 readings at tree 1.")
    task = replace(task, timing=timing)
    authorized = approve(examine(task, site, robot), by=by, at=at, confirmed=EveryWarning())
    return pack(
        authorized, site, robot, files=files, lenient=lenient, profile=profile, key=key, planner="english", **more
    )


@cache
def good() -> bytes:
    """The bundle that the others are made from."""
    return pack_mission()


def members_of(data: bytes) -> Members:
    """The files of a bundle, as any tool sees them."""
    with zipfile.ZipFile(io.BytesIO(data)) as archive:
        return {name: archive.read(name) for name in archive.namelist()}


def manifest_of(data: bytes) -> dict[str, Any]:
    """Its manifest."""
    found: dict[str, Any] = json.loads(members_of(data)[MANIFEST])
    return found


def opened(data: bytes, keys: Mapping[str, KnownKey] | None = None, now: datetime = NOW) -> Bundle:
    """The mission, on a machine that trusts the key of these tests."""
    return open_bundle(data, source="m.mission", known=known() if keys is None else keys, now=now)


def signed_with(changes: Mapping[str, bytes], *, key: SigningKey = KEY) -> bytes:
    """The good bundle with other files, signed again by a trusted key: what a faulty program would write."""
    members = members_of(good()) | dict(changes)
    members[SIGNATURE] = sign_manifest(members[MANIFEST], key).text()
    return wrap(members)


def archive_of(*files: tuple[zipfile.ZipInfo | str, bytes], method: int = zipfile.ZIP_STORED) -> bytes:
    """A zip file of any kind, written by the common library."""
    packed = io.BytesIO()
    with zipfile.ZipFile(packed, "w", method) as archive:
        for name, data in files:
            archive.writestr(name, data, method)
    return packed.getvalue()


def undated(data: bytes) -> bytes:
    """The same mission as a version before would have signed it: without number, and without an end."""
    manifest = manifest_of(data)
    del manifest["approved"]["until"], manifest["approved"]["number"]
    document = (json.dumps(manifest | {"format": 1}, ensure_ascii=False, indent=2) + "\n").encode()
    members = members_of(data) | {MANIFEST: document}
    members[SIGNATURE] = sign_manifest(document, KEY).text()
    return wrap(members)
