"""What must hold of a bundle before it is sent, and before a robot takes it."""

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

#: A SHA-256 as it stands in an address and in a receipt.
SHA256 = re.compile(r"[0-9a-f]{64}")

#: Reads a bundle, and refuses what may not run on this robot.
Accept = Callable[[bytes, str], "Bundle"]


@dataclass(frozen=True, kw_only=True)
class Sendable:
    """A bundle that is whole, as whoever sends it sees it.

    Attributes:
        hashes: SHA-256 of the whole (``bundle``) and of each file.
        request: What was asked.
    """

    hashes: Mapping[str, str]
    request: str

    @property
    def sha256(self) -> str:
        """Of the whole: by this the robot knows the mission."""
        return self.hashes["bundle"]


def acceptance(
    *, robot: RobotProfile, sites: tuple[Site, ...], trusted: TrustStore, now: Callable[[], datetime]
) -> Accept:
    """What one robot takes: missions that somebody trusted has signed for this robot and, if sites are given, for one of them.

    Args:
        robot: Of this robot, byte by byte what has to be in the bundle.
        sites: On which it may work; empty for every site that was signed.
        trusted: The keys that it trusts; read anew each time, so that a revoked one is revoked at once.
        now: With time zone.
    """  # noqa: E501

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
    """See whether a bundle is whole and signed; whether its signer is trusted is for the robot to say.

    Args:
        data: The file.
        source: What to call it in messages.
        known: The keys that this machine knows: one that it knows to be revoked is not sent.
        now: With time zone.

    Raises:
        BundleError: It is no bundle, or was damaged or changed.
        NotTrustedError: Its key was revoked here.
        NotApprovedError: Its approval has run out.
        SiteError, ProfileError, TaskError: What was signed cannot be read.
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
        # The robot reads what is in it, if it trusts the signer. Here nobody vouches for it.
        return Sendable(hashes=sealed.hashes, request=manifest.task.request)
    content = content_of(sealed, now=now)
    return Sendable(hashes=sealed.hashes, request=content.task.command.request)


def sha256_of(data: bytes) -> str:
    """As it stands in addresses and receipts."""
    return hashlib.sha256(data).hexdigest()


def _for_another(what: str, approved: str, here: str, source: str) -> BundleError:
    return BundleError(
        f"was approved for another {what}: {approved}, byte by byte; here it is {here}",
        where=source,
        advice=f"approve the mission for the {what} that is here, or give the agent that one with --{what}",
    )
