"""What every command does first: open the site and the robot."""

from __future__ import annotations

import sys
from collections.abc import Callable
from dataclasses import dataclass
from pathlib import Path
from typing import TYPE_CHECKING

from fieldhand import files
from fieldhand.cli.outputs import unwritable
from fieldhand.cli.show import note
from fieldhand.language import ENGLISH, Language
from fieldhand.mission.documents import SiteAndRobot
from fieldhand.site.model import Site

if TYPE_CHECKING:
    from fieldhand.site.formats.files import SiteFiles


@dataclass(frozen=True, kw_only=True)
class InputFiles:
    """Site and robot as they were read, for what keeps them: a mission's folder, a bundle.

    Attributes:
        site, profile: The bytes.
        lenient: How the site was read.
    """

    site: SiteFiles
    profile: bytes
    lenient: bool


def open_ground(site: str, robot: str, *, lenient: bool = False, language: Language = ENGLISH) -> SiteAndRobot:
    """Open both; of a leniently read site say what was left out.

    Raises:
        SiteError, ProfileError: One of them cannot be used.
    """
    return read_ground(site, robot, lenient=lenient, language=language)[0]


def read_ground(
    site: str, robot: str, *, lenient: bool = False, language: Language = ENGLISH
) -> tuple[SiteAndRobot, InputFiles]:
    """Open both as :func:`open_ground`, and return the bytes from which they were read, too: each file is read once.

    Raises:
        SiteError, ProfileError: One of them cannot be used.
    """
    from fieldhand.robot.loader import parse_profile, profile_bytes
    from fieldhand.site.loader import site_files, site_of

    files = site_files(site)
    opened = site_of(files, lenient=lenient)
    tell_left_out(opened, lenient=lenient, language=language)
    profile, source = profile_bytes(robot)
    ground = SiteAndRobot(site=opened, robot=parse_profile(profile, source=source))
    return ground, InputFiles(site=files, profile=profile, lenient=lenient)


def tell_left_out(site: Site, *, lenient: bool, language: Language = ENGLISH) -> None:
    """Say of a leniently read site what was left out."""
    for said in site.notes if lenient else ():
        note(said, language)


def write_file(path: Path, data: bytes) -> None:
    """Write a file, making its folder; ``-`` is standard output.

    Raises:
        OutputError: It cannot be written.
    """
    _write(path, data, Path.write_bytes)


def write_whole(path: Path, data: bytes) -> None:
    """Write a file as a whole or not at all, also over another one and also where the power fails meanwhile.

    Raises:
        OutputError: It cannot be written.
    """
    _write(path, data, files.write_whole)


def _write(path: Path, data: bytes, how: Callable[[Path, bytes], object]) -> None:
    if path == files.STANDARD:
        sys.stdout.buffer.write(data)
        sys.stdout.buffer.flush()
        return
    try:
        path.parent.mkdir(parents=True, exist_ok=True)
        how(path, data)
    except OSError as error:
        raise unwritable(str(path), error) from None


def may_ask() -> bool:
    """Whether there is a person to ask."""
    return sys.stdin is not None and sys.stdin.isatty()
