"""What lies beside a signed bundle in a mission's folder, held against what was signed."""

from __future__ import annotations

from collections.abc import Mapping
from pathlib import Path
from typing import TYPE_CHECKING

from fieldhand.errors import NotApprovedError
from fieldhand.task.authorization import Authorization

if TYPE_CHECKING:
    from fieldhand.approval.bundle.opening import Bundle


def require_signed(
    bundle: Bundle,
    files: Mapping[str, bytes],
    authorization: Authorization,
    *,
    lenient: bool,
    planner: str,
    folder: Path,
) -> None:
    """What lies beside the bundle must be what it holds: somebody reads it, and takes it for what was signed.

    Raises:
        NotApprovedError: It is not.
    """
    from fieldhand.task.codec import encode

    signed, manifest = bundle.authorized, bundle.manifest
    site = {file: data for file, data in files.items() if file.startswith("site/")}
    for what, here, wanted in (
        ("Task", files["task.xml"], encode(signed.task)),
        ("robot profile", files["robot.yaml"], bundle.profile),
        ("site", site, {f"site/{Path(name).name}": data for name, data in bundle.files.parts.items()}),
        ("approval", authorization, signed.authorization),
        ("rest", (lenient, planner), (manifest.site.lenient, manifest.task.planner)),
    ):
        if here != wanted:
            raise NotApprovedError(
                f"the {what} in the mission's folder is not what was signed",
                where=str(folder),
                advice="carry the signed mission out as a new one",
            )
