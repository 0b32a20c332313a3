"""Inspect a signed mission: who signed it, what it contains, and whether it may run on this machine."""

from __future__ import annotations

from collections.abc import Mapping
from dataclasses import dataclass, replace
from datetime import datetime
from typing import TYPE_CHECKING, Literal

from fieldhand.mission.review_task import Review, review

if TYPE_CHECKING:
    from fieldhand.approval.bundle.manifest import Manifest
    from fieldhand.approval.bundle.opening import Content, Sealed
    from fieldhand.language import Language
    from fieldhand.task.authorization import Authorization


@dataclass(frozen=True, kw_only=True)
class BundleInspection:
    """The result of inspecting a signed mission; the parts after the first one that is not valid are None.

    Attributes:
        state: State of its key on this machine; ``broken`` if the file is damaged.
        problems: Reasons why it may not run here, in words; empty if it may.
        signer: Name under which this machine knows the key; empty if it is unknown.
        sealed: Verified members and their hashes.
        manifest: Manifest.
        content: Task, site and robot.
        review: Review of the Task.
    """

    state: Literal["trusted", "unknown", "revoked", "broken"]
    problems: tuple[str, ...]
    signer: str = ""
    sealed: Sealed | None = None
    manifest: Manifest | None = None
    content: Content | None = None
    review: Review | None = None

    @property
    def may_run(self) -> bool:
        """True if the mission may run on this machine."""
        return not self.problems


@dataclass(frozen=True, kw_only=True)
class UnverifiedBundle:
    """A signed mission whose key may be untrusted: to be inspected, never to be carried out.

    Attributes:
        content: Task, site and robot.
        document: Bytes of its Task document.
        authorization: The approval that its manifest states.
        sha256: SHA-256 of the file.
        signed: Name of the signer in words.
    """

    content: Content
    document: bytes
    authorization: Authorization
    sha256: str
    signed: str


def read_unverified(data: bytes, *, source: str, environ: Mapping[str, str], now: datetime) -> UnverifiedBundle:
    """Read a signed mission without requiring that its key is trusted.

    Args:
        data: Bytes of the file.
        source: Name of the file, for messages.
        environ: Environment variables, which name the folder of the trusted keys.
        now: Current time, with time zone.

    Raises:
        BundleError: The file is damaged.
    """
    from fieldhand.approval.bundle.container import TASK
    from fieldhand.approval.bundle.opening import authorization_of, content_of, unseal
    from fieldhand.approval.memory import trust_store
    from fieldhand.language import message

    sealed = unseal(data, source=source)
    fingerprint = sealed.signature.public.fingerprint
    key = trust_store(environ).known().get(fingerprint)
    if key is None:
        signed: str = message("a key that is not trusted here ({fingerprint})", fingerprint=fingerprint)
    elif key.revoked is None:
        signed = key.in_words
    else:
        signed = message("{key}, revoked on {date}", key=key.in_words, date=str(key.revoked))
    content = content_of(sealed, now=now, stranger=key is None or key.state != "trusted")
    return UnverifiedBundle(
        content=content,
        document=sealed.members[TASK],
        authorization=authorization_of(content.manifest),
        sha256=sealed.hashes["bundle"],
        signed=signed,
    )


def inspect_bundle(
    data: bytes, *, source: str, environ: Mapping[str, str], now: datetime, language: Language
) -> BundleInspection:
    """Inspect a signed mission with the trusted keys of this machine. A mission that may not run is not an error.

    Args:
        data: Bytes of the file.
        source: Name of the file, for messages.
        environ: Environment variables, which name the folder of the trusted keys.
        now: Current time, with time zone.
        language: Language of the problems.

    Raises:
        KeyFileError: The trusted keys cannot be read.
    """
    from fieldhand.approval.bundle.opening import content_of, manifest_of, require_trusted, unseal
    from fieldhand.approval.memory import approval_memory, require_unexpired, trust_store
    from fieldhand.errors import BundleError, FieldhandError, NotApprovedError, NotTrustedError

    known = trust_store(environ).known()
    try:
        sealed = unseal(data, source=source)
    except BundleError as error:
        return BundleInspection(state="broken", problems=(str(error),))
    signer = known.get(sealed.signature.public.fingerprint)
    inspection = BundleInspection(
        state="unknown" if signer is None else signer.state,
        problems=(),
        signer="" if signer is None else signer.name,
        sealed=sealed,
    )
    problems: list[str] = []
    try:
        require_trusted(sealed, known)
    except NotTrustedError as error:
        problems.append(str(error))
    try:
        manifest = manifest_of(sealed, now=now)
        inspection = replace(inspection, manifest=manifest)
        try:
            require_unexpired(manifest, approval_memory(environ).time(now), now, source)
        except NotApprovedError as error:
            problems.append(str(error))
        content = content_of(sealed, now=now, stranger=inspection.state != "trusted")
    except FieldhandError as error:
        return replace(inspection, problems=(*problems, str(error)))
    reviewed = review(content.task, content.site, content.robot)
    problems.extend(language.say(problem.line()) for problem in reviewed.errors)
    return replace(inspection, problems=tuple(problems), content=content, review=reviewed)
