"""Reading of sites and robots, and writing of files."""

from __future__ import annotations

import sys
from collections.abc import Callable
from pathlib import Path

from fieldhand import files
from fieldhand.cli.outputs import unwritable
from fieldhand.cli.show import note
from fieldhand.language import ENGLISH, Language
from fieldhand.mission.documents import InputFiles, SiteAndRobot
from fieldhand.site.model import Site


def open_site_and_robot(site: str, robot: str, *, lenient: bool = False, language: Language = ENGLISH) -> SiteAndRobot:
    """Open a site and a robot, and print what a lenient reading of the site left out.

    Raises:
        SiteError, ProfileError: Site or robot cannot be used.
    """
    return read_site_and_robot(site, robot, lenient=lenient, language=language)[0]


def read_site_and_robot(
    site: str, robot: str, *, lenient: bool = False, language: Language = ENGLISH
) -> tuple[SiteAndRobot, InputFiles]:
    """Open a site and a robot as :func:`open_site_and_robot` does, and return their files, too; each file is read once.

    Raises:
        SiteError, ProfileError: Site or robot cannot be used.
    """
    from fieldhand.robot.loader import parse_profile, profile_bytes
    from fieldhand.site.loader import site_files, site_of

    files = site_files(site)
    opened = site_of(files, lenient=lenient)
    note_left_out(opened, lenient=lenient, language=language)
    profile, source = profile_bytes(robot)
    site_and_robot = SiteAndRobot(site=opened, robot=parse_profile(profile, source=source))
    return site_and_robot, InputFiles(site=files, profile=profile, lenient=lenient)


def note_left_out(site: Site, *, lenient: bool, language: Language = ENGLISH) -> None:
    """Print the notes about the parts of a site that a lenient reading left out."""
    for text in site.notes if lenient else ():
        note(text, language)


def write_file(path: Path, data: bytes) -> None:
    """Write a file, and make its folder; ``-`` is standard output.

    Raises:
        OutputError: The file cannot be written.
    """
    _write(path, data, Path.write_bytes)


def write_whole(path: Path, data: bytes) -> None:
    """Write or replace a file atomically, so that it is complete even after a power cut.

    Raises:
        OutputError: The file cannot be written.
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
    """Return True if standard input is a terminal."""
    return sys.stdin is not None and sys.stdin.isatty()
