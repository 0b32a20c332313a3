"""Signed missions at the command line: opening, verification and comparison with other options."""

from __future__ import annotations

import os
from dataclasses import asdict
from datetime import datetime
from pathlib import Path
from typing import TYPE_CHECKING, Any

from fieldhand import mission
from fieldhand.compatibility import UTC
from fieldhand.errors import BundleError, InputError
from fieldhand.files import STANDARD
from fieldhand.language import message

if TYPE_CHECKING:
    from fieldhand.approval.bundle.opening import Bundle
    from fieldhand.approval.keys.public import PublicKey
    from fieldhand.task.authorization import Authorization

ENDING = ".mission"


def is_bundle(words: str) -> bool:
    """Return True if an argument is the name of a signed mission, instead of a request."""
    return words.lower().endswith(ENDING) and "\n" not in words


def open_mission(file: str, site: str | None, robot: str | None, *, lenient: bool) -> Bundle:
    """Open a signed mission and verify that it may run here.

    Args:
        file: Name of the file.
        site: Site given as an option, which must be the approved one; None if none is given.
        robot: Robot given as an option, which must be the approved one; None if none is given.
        lenient: True to read the given site leniently.

    Raises:
        BundleError: The file cannot be used, or was approved for another site or robot.
        NotTrustedError: Its key is not trusted here.
        NotApprovedError: Its approval has expired, or a later approval of the mission was used here.
    """
    from fieldhand.approval.bundle.container import read_bundle_file
    from fieldhand.robot.loader import load_robot
    from fieldhand.site.loader import open_site

    bundle = verify(read_bundle_file(Path(file)), file)
    if robot is not None and load_robot(robot).sha256 != bundle.robot.sha256:
        raise _mismatch("--robot", robot, bundle.robot.name)
    if site is not None:
        given = open_site(site, lenient=lenient)
        if (given.sha256, given.content_sha256) != (bundle.site.sha256, bundle.site.content_sha256):
            raise _mismatch("--site", site, bundle.site.name)
    mission.admit_bundle(bundle, source=file, environ=os.environ, now=datetime.now(UTC))
    return bundle


def verify(data: bytes, source: str) -> Bundle:
    """Open a signed mission, and verify its signature with the keys that this machine trusts now.

    Raises:
        BundleError: The file cannot be used.
        NotTrustedError: Its key is not trusted here.
    """
    from fieldhand.approval.memory import trust_store

    trusted = trust_store(os.environ)
    return mission.open_bundle(data, source=source, trusted=trusted, now=datetime.now(UTC))


def require_ending(path: Path) -> None:
    """Require that the name of a signed mission ends in ``.mission``.

    Raises:
        InputError: It does not.
    """
    if path != STANDARD and path.suffix.lower() != ENDING:
        better = path.with_suffix(ENDING) if path.name else f"a file such as mission{ENDING}"
        raise InputError(
            message("the file name of a signed mission ends in .mission"),
            where=str(path),
            advice=message("write it to {better}", better=str(better)),
        )


def signed_record(path: Path, data: bytes, authorization: Authorization, public: PublicKey) -> dict[str, Any]:
    """Return a new signed mission as JSON."""
    from hashlib import sha256

    return {
        "file": str(path),
        "sha256": sha256(data).hexdigest(),
        "bytes": len(data),
        "authorization": asdict(authorization),
        "key": {"name": public.name, "fingerprint": public.fingerprint},
    }


def signer_record(bundle: Bundle) -> dict[str, Any]:
    """Return approval, key and hashes of a signed mission as JSON."""
    return {
        "authorization": asdict(bundle.authorized.authorization),
        "key": {"name": bundle.signer.name, "fingerprint": bundle.signer.fingerprint},
        "hashes": dict(bundle.hashes),
    }


def approval_line(bundle: Bundle) -> str:
    """Return a line with the approval and the key of a signed mission."""
    approved = bundle.manifest.approved
    return message(
        "Approved by {who} at {moment}, signed with {key}",
        who=approved.by,
        moment=approved.at,
        key=bundle.signer.in_words,
    )


def require_site(site: str | None) -> str:
    """Return the site option, which only signed missions do not need.

    Raises:
        InputError: No site is given.
    """
    if site is None:
        raise InputError(
            message("no site is given"),
            where="--site",
            advice=message("give its file, or demo for the built-in orchard"),
        )
    return site


def _mismatch(where: str, given: str, approved: str) -> BundleError:
    return BundleError(
        message(
            "{given} differs from what the mission was approved for ({approved}, compared byte by byte)",
            given=given,
            approved=approved,
        ),
        where=where,
        advice=message("leave it out to use what was approved, or approve the mission for this one"),
    )
