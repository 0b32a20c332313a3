"""Comparison of the files in a mission's folder with the signed mission that they came from."""

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
    """Require that the files in a mission's folder equal those in its signed mission, as people may read the former.

    Args:
        bundle: The signed mission, verified.
        files: Contents of the folder's files by name.
        authorization: Approval in mission.json.
        lenient: Lenient reading of the site, from mission.json.
        planner: Name of the planner, from mission.json.
        folder: Folder of the mission, for messages.

    Raises:
        NotApprovedError: A file differs.
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
                advice="run the signed mission as a new one",
            )
