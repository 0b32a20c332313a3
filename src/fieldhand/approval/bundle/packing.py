"""Pack an approved mission: the manifest, its signature, and the approved files."""

from __future__ import annotations

import hashlib
from datetime import timedelta

from pydantic import ValidationError

from fieldhand import __version__
from fieldhand.approval.bundle.container import MANIFEST, ROBOT, SIGNATURE, TASK, wrap
from fieldhand.approval.bundle.manifest import (
    FORMAT,
    USUALLY_VALID,
    Approved,
    Manifest,
    RobotPart,
    SitePart,
    TaskPart,
)
from fieldhand.approval.bundle.members import site_members
from fieldhand.approval.bundle.opening import content_of, unseal
from fieldhand.approval.bundle.signature import sign_manifest
from fieldhand.approval.keys.signing import SigningKey
from fieldhand.compatibility import datetime_from_iso
from fieldhand.errors import BundleError
from fieldhand.robot.model import RobotProfile
from fieldhand.site.formats.files import SiteFiles
from fieldhand.site.model import Site
from fieldhand.task.authorization import AuthorizedTask
from fieldhand.task.codec import encode


def pack(
    authorized: AuthorizedTask,
    site: Site,
    robot: RobotProfile,
    *,
    files: SiteFiles,
    lenient: bool,
    profile: bytes,
    key: SigningKey,
    planner: str,
    valid_for: timedelta = USUALLY_VALID,
    number: int | None = None,
) -> bytes:
    """Return the signed bundle; the same approval and key give the same bytes.

    Args:
        authorized: Approved Task with its authorization.
        site, robot: Approved site and robot profile.
        files: Source files of the site, read with ``lenient``.
        profile: Source YAML of the robot profile.
        key: Signing key of the approver.
        planner: Name of the planner that made the Task.
        valid_for: Period after the approval within which the mission may start.
        number: Sequence number among this signer's approvals
            (:meth:`fieldhand.approval.keys.signing.SigningKeys.next_number`); by default the approval time in seconds.

    Raises:
        BundleError: The files differ from the approved ones, cannot be read back identically, or are too large.
    """
    authorization = authorized.authorization
    at = datetime_from_iso(authorization.at)
    members = {TASK: encode(authorized.task), ROBOT: profile, **site_members(files)}
    try:
        manifest = Manifest(
            format=FORMAT,
            program=f"fieldhand {__version__}",
            approved=Approved(
                by=authorization.by,
                at=authorization.at,
                until=(at + valid_for).isoformat(timespec="seconds"),
                number=max(1, int(at.timestamp())) if number is None else number,
                confirmed=[str(line) for line in authorization.confirmed],
                language=authorization.language,
            ),
            task=TaskPart(
                id=authorized.task.id,
                sha256=authorization.task_sha256,
                request=authorized.task.command.request,
                planner=planner,
            ),
            site=SitePart(
                name=site.name,
                file=files.name,
                sha256=authorization.site_sha256,
                content_sha256=site.content_sha256,
                lenient=lenient,
            ),
            robot=RobotPart(name=robot.name, sha256=authorization.robot_sha256),
            files={name: hashlib.sha256(data).hexdigest() for name, data in sorted(members.items())},
        )
    except ValidationError as error:
        first = error.errors(include_url=False)[0]
        key_path = ".".join(str(part) for part in first["loc"])
        raise BundleError(
            f"{key_path} cannot be signed: {first['msg']}", advice="change it, and approve again"
        ) from None
    signed = manifest.document()
    members |= {MANIFEST: signed, SIGNATURE: sign_manifest(signed, key).text()}
    data = wrap(members)
    # Open every bundle once before handing it out, as the robot will.
    content_of(unseal(data, source="the bundle"), now=at)
    return data
