"""Open a bundle and verify it before use: container, signature, trust, manifest, every byte."""

from __future__ import annotations

import hashlib
from collections.abc import Mapping
from dataclasses import dataclass
from datetime import datetime, timedelta

from fieldhand.approval.authorize import uphold
from fieldhand.approval.bundle.container import MANIFEST, ROBOT, SIGNATURE, TASK, unwrap
from fieldhand.approval.bundle.manifest import Manifest, parse_manifest
from fieldhand.approval.bundle.members import site_files_of
from fieldhand.approval.bundle.signature import Signature, require_signature
from fieldhand.approval.keys.trust import KnownKey
from fieldhand.compatibility import datetime_from_iso
from fieldhand.errors import BundleError, NotTrustedError
from fieldhand.language import message
from fieldhand.robot.capabilities import capabilities_of
from fieldhand.robot.loader import parse_profile
from fieldhand.robot.model import RobotProfile
from fieldhand.site.formats.files import SiteFiles, is_plain
from fieldhand.site.loader import site_of
from fieldhand.site.model import Site
from fieldhand.task.authorization import Authorization, AuthorizedTask
from fieldhand.task.codec import decode, encode
from fieldhand.task.frames import Task
from fieldhand.task.schema import require_valid

#: Maximum clock difference between two machines: one day covers a wrong time zone.
FUTURE_ALLOWED = timedelta(days=1)
_AGAIN = message("ask for the file again from whoever approved it")


@dataclass(frozen=True, kw_only=True)
class Sealed:
    """A bundle with a valid signature, made by a trusted or an unknown key.

    Attributes:
        members: Files by member name.
        hashes: SHA-256 of the whole bundle (key ``bundle``) and of each file.
        source: Name of the bundle in error messages.
    """

    members: Mapping[str, bytes]
    signature: Signature
    hashes: Mapping[str, str]
    source: str


@dataclass(frozen=True, kw_only=True)
class Content:
    """The approved Task, site and robot profile, read from the approved bytes."""

    task: Task
    site: Site
    robot: RobotProfile
    manifest: Manifest
    files: SiteFiles
    profile: bytes


@dataclass(frozen=True, kw_only=True)
class Bundle:
    """A verified mission that may run on this machine.

    Attributes:
        authorized: Task with its authorization, as signed.
        site, robot: Site and robot profile of the approval.
        files, profile: Original bytes of the site and the robot profile.
        signer: Trusted key that signed the bundle.
        hashes: SHA-256 of the whole bundle (key ``bundle``) and of each file, for the sender's receipt.
        data: Bytes of the bundle, for verifying it again later.
    """

    authorized: AuthorizedTask
    site: Site
    robot: RobotProfile
    manifest: Manifest
    files: SiteFiles
    profile: bytes
    signer: KnownKey
    hashes: Mapping[str, str]
    data: bytes


def open_bundle(data: bytes, *, source: str, known: Mapping[str, KnownKey], now: datetime) -> Bundle:
    """Verify a bundle and return the mission signed by a trusted person.

    Args:
        data: Bytes of the bundle.
        source: Name of the bundle in error messages.
        known: Keys known to this machine (:meth:`fieldhand.approval.keys.trust.TrustStore.known`).
        now: Current time, with time zone.

    Raises:
        BundleError: The data is not a bundle, is damaged or changed, or has another format version.
        NotTrustedError: The signing key is unknown here or revoked.
        SiteError, ProfileError, TaskError: A signed file cannot be used here.
    """
    sealed = unseal(data, source=source)
    signer = require_trusted(sealed, known)
    content = content_of(sealed, now=now)
    return Bundle(
        authorized=uphold(content.task, authorization_of(content.manifest)),
        site=content.site,
        robot=content.robot,
        manifest=content.manifest,
        files=content.files,
        profile=content.profile,
        signer=signer,
        hashes=sealed.hashes,
        data=data,
    )


def unseal(data: bytes, *, source: str) -> Sealed:
    """Unpack a bundle and verify its signature, without checking trust in the signer.

    Raises:
        BundleError: The data is not a bundle, or its signature is invalid.
    """
    members = unwrap(data, source=source)
    signature = require_signature(members[SIGNATURE], members[MANIFEST], source=source)
    hashes = {"bundle": _sha256(data)} | {name: _sha256(member) for name, member in members.items()}
    return Sealed(members=members, signature=signature, hashes=hashes, source=source)


def require_trusted(sealed: Sealed, known: Mapping[str, KnownKey]) -> KnownKey:
    """Return the signing key if this machine trusts it.

    Raises:
        NotTrustedError: The key is unknown or revoked.
    """
    fingerprint = sealed.signature.public.fingerprint
    key = known.get(fingerprint)
    if key is None:
        raise NotTrustedError(
            message("signed with a key that is not trusted here ({fingerprint})", fingerprint=fingerprint),
            where=sealed.source,
            advice=message(
                "if you know whose key it is, compare the fingerprint with its owner and run fieldhand keys trust"
            ),
        )
    if key.state != "trusted":
        raise NotTrustedError(
            message(
                "signed with the key of {name} ({fingerprint}), which was revoked on {revoked}",
                name=key.name,
                fingerprint=fingerprint,
                revoked=str(key.revoked),
            ),
            where=sealed.source,
            advice=message("have the mission approved again with a key that is trusted"),
        )
    return key


def manifest_of(sealed: Sealed, *, now: datetime) -> Manifest:
    """Return the manifest after checking its file list against the bundle; no other file is parsed.

    Raises:
        BundleError: The manifest is invalid, or a file differs from the one that it lists.
    """
    manifest = parse_manifest(sealed.members[MANIFEST], source=sealed.source)
    _require_files(manifest, sealed)
    _require_past(manifest, now, sealed.source)
    return manifest


def content_of(sealed: Sealed, *, now: datetime, stranger: bool = False) -> Content:
    """Read Task, site and robot profile from the bundle and check them against the manifest.

    Args:
        sealed: The bundle.
        now: Current time, with time zone.
        stranger: The signer is not trusted; site formats that need an external library such as GDAL are refused.

    Raises:
        NotTrustedError: The signer is not trusted and the site needs such a library.
        BundleError: The manifest is invalid, a file differs from the listed one, or is read differently here.
        SiteError, ProfileError, TaskError: One of the files cannot be used.
    """
    source, members = sealed.source, sealed.members
    manifest = manifest_of(sealed, now=now)
    robot = parse_profile(members[ROBOT], source=f"{source}, {ROBOT}")
    files = site_files_of(members, manifest.site.file, source=source)
    if stranger and not is_plain(files):
        raise NotTrustedError(
            message(
                "its site is not read before a trusted key has signed the mission (Shapefile, GeoPackage, KML, zip)"
            ),
            where=files.source,
            advice=message(
                "compare the fingerprint with the owner of the key, run fieldhand keys trust, and try again"
            ),
        )
    site = site_of(files, lenient=manifest.site.lenient)
    require_valid(members[TASK], capabilities_of(robot), source=f"{source}, {TASK}")
    task = decode(members[TASK], source=f"{source}, {TASK}")
    _require_the_same(
        source,
        ("Task document", manifest.task.sha256, sealed.hashes[TASK]),
        ("Task", (manifest.task.sha256, manifest.task.id), (_sha256(encode(task)), task.id)),
        ("request", manifest.task.request, task.command.request),
        ("robot profile", (manifest.robot.sha256, manifest.robot.name), (robot.sha256, robot.name)),
        ("site file", (manifest.site.sha256, manifest.site.name), (site.sha256, site.name)),
        ("site", manifest.site.content_sha256, site.content_sha256),
    )
    return Content(task=task, site=site, robot=robot, manifest=manifest, files=files, profile=members[ROBOT])


def authorization_of(manifest: Manifest) -> Authorization:
    """Return the authorization recorded in the manifest."""
    approved = manifest.approved
    return Authorization(
        by=approved.by,
        at=approved.at,
        task_sha256=manifest.task.sha256,
        site_sha256=manifest.site.sha256,
        robot_sha256=manifest.robot.sha256,
        confirmed=tuple(approved.confirmed),
        language=approved.language,
    )


def _require_files(manifest: Manifest, sealed: Sealed) -> None:
    """Require exactly the files listed in the manifest, byte for byte."""
    named = manifest.files
    held = {name: sha256 for name, sha256 in sealed.hashes.items() if name not in ("bundle", MANIFEST, SIGNATURE)}
    wrong = sorted(name for name in named.keys() | held.keys() if named.get(name) != held.get(name))
    if wrong:
        raise BundleError(
            message("{wrong} is not what was approved", wrong=wrong[0][:60]), where=sealed.source, advice=_AGAIN
        )


def _require_past(manifest: Manifest, now: datetime, source: str) -> None:
    """Refuse an approval date in the future: one of the clocks is wrong, and so would be every time in the log."""
    if datetime_from_iso(manifest.approved.at) > now + FUTURE_ALLOWED:
        raise BundleError(
            message(
                "was approved at {at}, but the clock of this machine shows {now}",
                at=manifest.approved.at,
                now=now.isoformat(timespec="seconds"),
            ),
            where=source,
            advice=message(
                "correct the clock that is wrong: if it is the approver's, have the mission approved again afterwards"
            ),
        )


def _require_the_same(source: str, *parts: tuple[str, object, object]) -> None:
    for name, approved, here in parts:
        if approved != here:
            raise BundleError(
                message("this program reads the {name} differently from what was approved", name=name),
                where=source,
                advice=message(
                    "use the version of the program that it was approved with, or approve it again with this one"
                ),
            )


def _sha256(data: bytes) -> str:
    return hashlib.sha256(data).hexdigest()
