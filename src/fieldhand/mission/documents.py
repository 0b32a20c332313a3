"""Read Task documents and signed missions."""

from __future__ import annotations

from dataclasses import dataclass
from datetime import datetime
from pathlib import Path
from typing import TYPE_CHECKING

from fieldhand.robot.model import RobotProfile
from fieldhand.site.model import Site
from fieldhand.task.frames import Task

if TYPE_CHECKING:
    from fieldhand.approval.bundle.opening import Bundle
    from fieldhand.approval.keys.trust import TrustStore


@dataclass(frozen=True, kw_only=True)
class SiteAndRobot:
    """A site and a robot."""

    site: Site
    robot: RobotProfile


def read_task(path: Path, robot: RobotProfile) -> tuple[Task, bytes]:
    """Read a Task document that is valid against the robot's schema, and return it with its bytes.

    Raises:
        TaskError: The file cannot be read, is not well-formed, or fails the schema (line and element are named).
    """
    from fieldhand.language import message
    from fieldhand.task.codec_xml import read_xml

    document = read_xml(path, advice=message("give a Task document that fieldhand plan wrote"))
    return decode_task(document, robot, source=str(path)), document


def decode_task(document: bytes, robot: RobotProfile, *, source: str = "") -> Task:
    """Decode a Task document that is valid against the robot's schema.

    Raises:
        TaskError: Not well-formed or not valid; every problem with its line and element.
    """
    from fieldhand.robot.capabilities import capabilities_of
    from fieldhand.task.codec import decode
    from fieldhand.task.schema import require_valid

    require_valid(document, capabilities_of(robot), source=source)
    return decode(document, source=source)


def open_bundle(data: bytes, *, source: str, trusted: TrustStore, now: datetime) -> Bundle:
    """Verify a signed mission and return its contents.

    Args:
        data: Bytes of the file.
        source: Name of the file, for messages.
        trusted: The keys that this machine trusts.
        now: Current time, with time zone.

    Raises:
        BundleError: The file is not a signed mission, is damaged, or has an unknown format.
        NotTrustedError: The key that signed it is not trusted here.
        KeyFileError: The trusted keys cannot be read.
    """
    from fieldhand.approval.bundle.opening import open_bundle

    return open_bundle(data, source=source, known=trusted.known(), now=now)
