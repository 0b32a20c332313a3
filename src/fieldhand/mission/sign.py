"""Sign an approved mission for a robot."""

from __future__ import annotations

from datetime import timedelta
from typing import TYPE_CHECKING

from fieldhand.mission.approve import ApprovedMission
from fieldhand.mission.documents import InputFiles

if TYPE_CHECKING:
    from fieldhand.approval.keys.signing import SigningKey


def sign(
    mission: ApprovedMission,
    files: InputFiles,
    *,
    key: SigningKey,
    planner: str,
    valid_for: timedelta | None = None,
    number: int | None = None,
) -> bytes:
    """Return an approved mission as a signed file, with everything that the robot needs.

    Args:
        mission: The approved mission.
        files: The files that its site and its robot were read from.
        key: Key of the operator.
        planner: Name of the planner that made the Task.
        valid_for: Time after the approval within which the mission may begin; 90 days by default.
        number: Sequence number among the approvals with this key; by default the time of the approval.

    Raises:
        BundleError: The files differ from the approved ones, or are too large.
    """
    from fieldhand.approval.bundle.manifest import USUALLY_VALID
    from fieldhand.approval.bundle.packing import pack

    return pack(
        mission.authorized,
        mission.site,
        mission.robot,
        files=files.site,
        lenient=files.lenient,
        profile=files.profile,
        key=key,
        planner=planner,
        valid_for=valid_for or USUALLY_VALID,
        number=number,
    )
