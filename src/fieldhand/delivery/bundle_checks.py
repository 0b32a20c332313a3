"""Checks of a signed mission before it is sent, and before a robot accepts it."""

from __future__ import annotations

import hashlib
import re
from collections.abc import Callable, Mapping
from dataclasses import dataclass
from datetime import datetime
from typing import TYPE_CHECKING

from fieldhand.errors import BundleError, NotTrustedError

if TYPE_CHECKING:
    from fieldhand.approval.bundle.opening import Bundle
    from fieldhand.approval.keys.trust import KnownKey, TrustStore
    from fieldhand.robot.model import RobotProfile
    from fieldhand.site.model import Site

#: SHA-256 in an address or a receipt.
SHA256 = re.compile(r"[0-9a-f]{64}")

#: Opens a signed mission, and raises an error if it may not run on this robot.
Accept = Callable[[bytes, str], "Bundle"]


@dataclass(frozen=True, kw_only=True)
class Sendable:
    """A complete signed mission, ready to be sent.

    Attributes:
        hashes: SHA-256 of the file (``bundle``) and of each of its members.
        request: Request that the mission was planned from.
    """

    hashes: Mapping[str, str]
    request: str

    @property
    def sha256(self) -> str:
        """SHA-256 of the file, by which the robot identifies the mission."""
        return self.hashes["bundle"]


def acceptance(
    *, robot: RobotProfile, sites: tuple[Site, ...], trusted: TrustStore, now: Callable[[], datetime]
) -> Accept:
    """Return a function that accepts missions for one robot, signed with a trusted key, on one of its sites.

    Args:
        robot: Profile of the robot; the signed one must have the same SHA-256.
        sites: Sites on which it may work; empty for every site that was signed.
        trusted: Trusted keys, read again for each mission, so that a revocation takes effect at once.
        now: Returns the current time, with time zone.
    """

    def accept(data: bytes, source: str) -> Bundle:
        from fieldhand import mission

        bundle = mission.open_bundle(data, source=source, trusted=trusted, now=now())
        if bundle.robot.sha256 != robot.sha256:
            raise _for_another("robot", bundle.robot.name, robot.name, source)
        if sites and (bundle.site.sha256, bundle.site.content_sha256) not in [
            (site.sha256, site.content_sha256) for site in sites
        ]:
            raise _for_another("site", bundle.site.name, ", ".join(site.name for site in sites), source)
        return bundle

    return accept


def require_sendable(data: bytes, *, source: str, known: Mapping[str, KnownKey], now: datetime) -> Sendable:
    """Require that a signed mission is complete and signed; the robot decides if it trusts the key.

    Args:
        data: Bytes of the file.
        source: Name of the file, for messages.
        known: Keys that this machine knows; a mission signed with a revoked one is not sent.
        now: Current time, with time zone.

    Raises:
        BundleError: The file is not a signed mission, or is damaged.
        NotTrustedError: Its key was revoked here.
        NotApprovedError: Its approval has expired.
        SiteError, ProfileError, TaskError: A member cannot be read.
    """
    from fieldhand.approval.bundle.opening import content_of, manifest_of, require_trusted, unseal
    from fieldhand.approval.memory import require_unexpired

    sealed = unseal(data, source=source)
    manifest = manifest_of(sealed, now=now)
    require_unexpired(manifest, now, now, source)
    try:
        require_trusted(sealed, known)
    except NotTrustedError:
        if sealed.signature.public.fingerprint in known:
            raise
        # The key is unknown here, so the contents are not parsed; the robot does that if it trusts the key.
        return Sendable(hashes=sealed.hashes, request=manifest.task.request)
    content = content_of(sealed, now=now)
    return Sendable(hashes=sealed.hashes, request=content.task.command.request)


def sha256_of(data: bytes) -> str:
    """Return the SHA-256 as in addresses and receipts: hexadecimal, in lower case."""
    return hashlib.sha256(data).hexdigest()


def _for_another(what: str, approved: str, here: str, source: str) -> BundleError:
    return BundleError(
        f"was approved for another {what}: {approved}, byte by byte; the one here is {here}",
        where=source,
        advice=f"approve the mission for the {what} that is here, or give the agent that one with --{what}",
    )
