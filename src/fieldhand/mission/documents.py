"""Read Task documents and signed missions."""

from __future__ import annotations

from collections.abc import Mapping
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
    from fieldhand.site.formats.files import SiteFiles


@dataclass(frozen=True, kw_only=True)
class SiteAndRobot:
    """A site and a robot."""

    site: Site
    robot: RobotProfile


@dataclass(frozen=True, kw_only=True)
class InputFiles:
    """Files of a site and a robot, to be copied to a mission's folder or a signed mission.

    Attributes:
        site: Files of the site.
        profile: Bytes of the robot profile.
        lenient: True if the site was read leniently.
    """

    site: SiteFiles
    profile: bytes
    lenient: bool


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


def import_tree(
    document: bytes, robot: RobotProfile, *, site: Site | None = None, request: str = "", source: str = ""
) -> tuple[Task, bytes]:
    """Convert a tree of BehaviorTree.CPP to a Task that is valid for a robot, and return it with its document.

    Args:
        document: The tree (XML), made of this robot's actions.
        robot: Robot of the Task.
        site: Site of the Task, if it is known.
        request: The request, if the tree does not contain it.
        source: Name of the file, for messages.

    Raises:
        TaskError: The tree is no Task for this robot; the error names the element.
    """
    from fieldhand.errors import TaskError
    from fieldhand.exchange.btcpp import read_tree
    from fieldhand.robot.capabilities import capabilities_of
    from fieldhand.task.codec import encode
    from fieldhand.task.frames import Resource
    from fieldhand.task.references import references
    from fieldhand.task.schema import require_valid

    capabilities = capabilities_of(robot)
    resources = [Resource(kind="robot", name=robot.name, sha256=robot.sha256)]
    if site is not None:
        resources.append(Resource(kind="site", name=site.name, sha256=site.sha256))
    task = read_tree(document, capabilities, request=request, resources=tuple(resources), source=source)
    encoded = encode(task)
    require_valid(encoded, capabilities, source=source)
    problems = references(task, capabilities)
    if problems:
        raise TaskError("; ".join(problems), where=source, advice="correct the tree")
    return task, encoded


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


def admit_bundle(bundle: Bundle, *, source: str, environ: Mapping[str, str], now: datetime) -> None:
    """Require that the approval of a signed mission is still valid on this machine, and remember it.

    Args:
        bundle: The verified mission.
        source: Name of its file, for messages.
        environ: Environment variables, which name the folder where approvals are remembered.
        now: Current time, with time zone.

    Raises:
        NotApprovedError: The approval has expired, or a later one of the mission was used here.
    """
    from fieldhand.approval.memory import approval_memory

    approval_memory(environ).admit(bundle.manifest, bundle.signer.fingerprint, clock=now, source=source)
