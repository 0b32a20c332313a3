"""Signed missions at the command line: opened, and held against what else was given."""

from __future__ import annotations

import os
from dataclasses import asdict, dataclass
from datetime import UTC, datetime
from pathlib import Path
from typing import TYPE_CHECKING, Any

from fieldhand import mission
from fieldhand.errors import BundleError, InputError
from fieldhand.files import STANDARD
from fieldhand.language import message

if TYPE_CHECKING:
    from fieldhand.approval.bundle.opening import Bundle, Content
    from fieldhand.approval.keys.public import PublicKey
    from fieldhand.task.authorization import Authorization

ENDING = ".mission"


def is_bundle(words: str) -> bool:
    """Whether what was given is the name of a bundle, and no request."""
    return words.lower().endswith(ENDING) and "\n" not in words


def open_mission(file: str, site: str | None, robot: str | None, *, lenient: bool) -> Bundle:
    """The mission of a bundle that somebody trusted has signed.

    Args:
        file: The bundle.
        site, robot: What was given beside it, if anything: it must be what was approved.
        lenient: How a site that was given is read.

    Raises:
        BundleError: It cannot be used, or was approved for another site or robot.
        NotTrustedError: Nobody who is trusted here has signed it.
        NotApprovedError: Its approval has run out, or a later one of the same mission was seen here.
    """
    from fieldhand.approval.bundle.container import read_bundle_file
    from fieldhand.approval.memory import approval_memory
    from fieldhand.robot.loader import load_robot
    from fieldhand.site.loader import open_site

    bundle = verify(read_bundle_file(Path(file)), file)
    if robot is not None and load_robot(robot).sha256 != bundle.robot.sha256:
        raise _another("--robot", robot, bundle.robot.name)
    if site is not None:
        given = open_site(site, lenient=lenient)
        if (given.sha256, given.content_sha256) != (bundle.site.sha256, bundle.site.content_sha256):
            raise _another("--site", site, bundle.site.name)
    memory, clock = approval_memory(os.environ), datetime.now(UTC)
    memory.admit(bundle.manifest, bundle.signer.fingerprint, clock=clock, source=file)
    return bundle


def verify(data: bytes, source: str) -> Bundle:
    """The mission of a bundle, held against the keys that are trusted on this machine now.

    Raises:
        BundleError: It cannot be used.
        NotTrustedError: Nobody who is trusted here has signed it.
    """
    from fieldhand.approval.memory import trust_store

    trusted = trust_store(os.environ)
    return mission.open_bundle(data, source=source, trusted=trusted, now=datetime.now(UTC))


@dataclass(frozen=True, kw_only=True)
class Unverified:
    """A bundle that is whole, whoever signed it: to be looked at, never to be run.

    Attributes:
        document: Of its Task.
        sha256: Of the whole.
        signed: Whose signature it has, in words.
    """

    content: Content
    document: bytes
    sha256: str
    signed: str


def read_unverified(data: bytes, source: str) -> Unverified:
    """What a bundle says, and whose signature it has as far as this machine knows.

    Raises:
        BundleError: It is broken.
    """
    from fieldhand.approval.bundle.container import TASK
    from fieldhand.approval.bundle.opening import content_of, unseal
    from fieldhand.approval.memory import trust_store

    sealed = unseal(data, source=source)
    fingerprint = sealed.signature.public.fingerprint
    key = trust_store(os.environ).known().get(fingerprint)
    if key is None:
        signed: str = message("a key that is not trusted here ({fingerprint})", fingerprint=fingerprint)
    elif key.revoked is None:
        signed = key.in_words
    else:
        signed = message("{key}, revoked on {date}", key=key.in_words, date=str(key.revoked))
    content = content_of(sealed, now=datetime.now(UTC), stranger=key is None or key.state != "trusted")
    return Unverified(content=content, document=sealed.members[TASK], sha256=sealed.hashes["bundle"], signed=signed)


def require_ending(path: Path) -> None:
    """Refuse another ending than that by which a bundle is known.

    Raises:
        InputError: It has another one.
    """
    if path != STANDARD and path.suffix.lower() != ENDING:
        better = path.with_suffix(ENDING) if path.name else f"a file such as mission{ENDING}"
        raise InputError(
            message("a signed mission ends in .mission"),
            where=str(path),
            advice=message("write it to {better}", better=str(better)),
        )


def signed_record(path: Path, data: bytes, authorization: Authorization, public: PublicKey) -> dict[str, Any]:
    """What was signed, as JSON."""
    from hashlib import sha256

    return {
        "file": str(path),
        "sha256": sha256(data).hexdigest(),
        "bytes": len(data),
        "authorization": asdict(authorization),
        "key": {"name": public.name, "fingerprint": public.fingerprint},
    }


def signer_record(bundle: Bundle) -> dict[str, Any]:
    """Who approved and signed a mission, and what was verified of it, as JSON."""
    return {
        "authorization": asdict(bundle.authorized.authorization),
        "key": {"name": bundle.signer.name, "fingerprint": bundle.signer.fingerprint},
        "hashes": dict(bundle.hashes),
    }


def approval_line(bundle: Bundle) -> str:
    """Who approved a mission, and with which key, in a line."""
    approved = bundle.manifest.approved
    return message(
        "Approved by {who} at {moment}, signed with {key}",
        who=approved.by,
        moment=approved.at,
        key=bundle.signer.in_words,
    )


def require_site(site: str | None) -> str:
    """The site, which only a bundle does without.

    Raises:
        InputError: None was given.
    """
    if site is None:
        raise InputError(
            message("no site is given"),
            where="--site",
            advice=message("give its file, or demo for the built-in orchard"),
        )
    return site


def _another(where: str, given: str, approved: str) -> BundleError:
    return BundleError(
        message(
            "{given} is not what the mission was approved for ({approved}, byte by byte)",
            given=given,
            approved=approved,
        ),
        where=where,
        advice=message("leave it out, and what was approved is used; or approve the mission for this one"),
    )
