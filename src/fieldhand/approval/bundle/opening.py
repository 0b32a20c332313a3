"""A bundle, checked before anything of it is used: container, signature, trust, manifest, every byte."""

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
from fieldhand.errors import BundleError, NotTrustedError
from fieldhand.language import message
from fieldhand.robot.capabilities import capabilities_of
from fieldhand.robot.loader import parse_profile
from fieldhand.robot.model import RobotProfile
from fieldhand.site.formats.files import SiteFiles, is_plain
from fieldhand.site.geojson import site_of
from fieldhand.site.model import Site
from fieldhand.task.authorization import Authorization, AuthorizedTask
from fieldhand.task.codec import decode, encode
from fieldhand.task.frames import Task
from fieldhand.task.schema import require_valid

#: Clocks of two machines differ by a time zone that is set wrongly; by more only if one of them is wrong altogether.
FUTURE_ALLOWED = timedelta(days=1)
_AGAIN = message("ask for the file again from whoever approved it")


@dataclass(frozen=True, kw_only=True)
class Sealed:
    """A bundle whose signature is good, whoever made it.

    Attributes:
        members: Its files by name.
        hashes: SHA-256 of the whole (``bundle``) and of each file.
        source: What to call it in messages.
    """

    members: Mapping[str, bytes]
    signature: Signature
    hashes: Mapping[str, str]
    source: str


@dataclass(frozen=True, kw_only=True)
class Content:
    """What was approved, read again from the bytes that were approved."""

    task: Task
    site: Site
    robot: RobotProfile
    manifest: Manifest
    files: SiteFiles
    profile: bytes


@dataclass(frozen=True, kw_only=True)
class Bundle:
    """A mission that may run here.

    Attributes:
        authorized: The Task with its authorization, as it was signed.
        site, robot: For which it was approved.
        files, profile: What these were read from, byte for byte.
        signer: The trusted key that signed it.
        hashes: SHA-256 of the whole (``bundle``) and of each file: what was verified, for whoever sent it.
        data: The bundle itself, for whoever keeps it to check it again.
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
    """A mission from a bundle that a trusted person has signed.

    Args:
        data: The file.
        source: What to call it in messages.
        known: The keys that this machine knows (:meth:`fieldhand.approval.keys.trust.TrustStore.known`).
        now: With time zone.

    Raises:
        BundleError: It is no bundle, was damaged or changed, or is of another format.
        NotTrustedError: Its key is unknown here, or was revoked.
        SiteError, ProfileError, TaskError: What was signed cannot be used here.
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
    """A bundle whose signature is one of its manifest; says nothing of who signed it.

    Raises:
        BundleError: It is no bundle, or its signature is broken.
    """
    members = unwrap(data, source=source)
    signature = require_signature(members[SIGNATURE], members[MANIFEST], source=source)
    hashes = {"bundle": _sha256(data)} | {name: _sha256(member) for name, member in members.items()}
    return Sealed(members=members, signature=signature, hashes=hashes, source=source)


def require_trusted(sealed: Sealed, known: Mapping[str, KnownKey]) -> KnownKey:
    """The key that signed, if it is trusted here.

    Raises:
        NotTrustedError: It is unknown, or was revoked.
    """
    fingerprint = sealed.signature.public.fingerprint
    key = known.get(fingerprint)
    if key is None:
        raise NotTrustedError(
            message("signed with a key that is not trusted here ({fingerprint})", fingerprint=fingerprint),
            where=sealed.source,
            advice=message(
                "if you know whose it is, compare the fingerprint with its owner and give fieldhand keys trust"
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
    """Return the manifest, held against the files of the bundle. Nothing else is read of them.

    Raises:
        BundleError: The manifest cannot be used, or a file is not the one that it names.
    """
    manifest = parse_manifest(sealed.members[MANIFEST], source=sealed.source)
    _require_files(manifest, sealed)
    _require_past(manifest, now, sealed.source)
    return manifest


def content_of(sealed: Sealed, *, now: datetime, stranger: bool = False) -> Content:
    """Task, site and robot, read again and held against the manifest.

    Args:
        sealed: The bundle.
        now: With time zone.
        stranger: Nobody who is trusted here signed it: a site that takes a program like GDAL to read is not read.

    Raises:
        NotTrustedError: It is of a stranger, and has such a site.
        BundleError: The manifest cannot be used, a file is not the one that it names, or is read otherwise here.
        SiteError, ProfileError, TaskError: One of the files cannot be used.
    """
    source, members = sealed.source, sealed.members
    manifest = manifest_of(sealed, now=now)
    robot = parse_profile(members[ROBOT], source=f"{source}, {ROBOT}")
    files = site_files_of(members, manifest.site.file, source=source)
    if stranger and not is_plain(files):
        raise NotTrustedError(
            message("its site is read only if someone trusted has signed it (Shapefile, GeoPackage, KML, zip)"),
            where=files.source,
            advice=message(
                "compare the fingerprint with the owner of the key and give fieldhand keys trust, then look again"
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
    """What the manifest says of the approval."""
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
    """Every byte: the files are those that the manifest names, no more and no fewer."""
    named = manifest.files
    held = {name: sha256 for name, sha256 in sealed.hashes.items() if name not in ("bundle", MANIFEST, SIGNATURE)}
    wrong = sorted(name for name in named.keys() | held.keys() if named.get(name) != held.get(name))
    if wrong:
        raise BundleError(
            message("{wrong} is not what was approved", wrong=wrong[0][:60]), where=sealed.source, advice=_AGAIN
        )


def _require_past(manifest: Manifest, now: datetime, source: str) -> None:
    """A date far ahead authorizes nothing more; but then a clock is wrong, and every time in the log would be, too."""
    if datetime.fromisoformat(manifest.approved.at) > now + FUTURE_ALLOWED:
        raise BundleError(
            message(
                "was approved at {at}, and the clock of this machine says {now}",
                at=manifest.approved.at,
                now=now.isoformat(timespec="seconds"),
            ),
            where=source,
            advice=message(
                "set the clock that is wrong: this one, or that of whoever approves, who then approves again"
            ),
        )


def _require_the_same(source: str, *parts: tuple[str, object, object]) -> None:
    for name, approved, here in parts:
        if approved != here:
            raise BundleError(
                message("the {name} is read here as something else than was approved", name=name),
                where=source,
                advice=message(
                    "use the version of the program that it was approved with, or approve it again with this one"
                ),
            )


def _sha256(data: bytes) -> str:
    return hashlib.sha256(data).hexdigest()
