"""The site in a bundle: its own files, as they were read, under names that mean nothing to any file system.

Not a rewritten one: approvals and Tasks name the SHA-256 of the site's bytes, a rewritten file has another, and corners
of zones would move by the rounding of their projection.
"""

from __future__ import annotations

from collections.abc import Mapping
from pathlib import Path

from fieldhand.approval.bundle.container import SITE_MEMBER
from fieldhand.errors import BundleError
from fieldhand.site.formats.files import SiteFiles
from fieldhand.site.formats.records import SHAPEFILE_PARTS


def site_members(files: SiteFiles) -> dict[str, bytes]:
    """The files of a site by their names in the bundle."""
    return {member_name(name): data for name, data in files.parts.items()}


def member_name(file: str) -> str:
    """``site`` with the ending of the file, if it has a plain one."""
    name = f"site{Path(file).suffix.lower()}"
    return name if SITE_MEMBER.fullmatch(name) else "site"


def site_files_of(members: Mapping[str, bytes], file: str, *, source: str) -> SiteFiles:
    """The files of the site as they were read before they were packed.

    Args:
        members: Of the bundle.
        file: What the main file was called.
        source: What to call the bundle in messages.

    Raises:
        BundleError: The main file is missing, or there are parts that belong to no Shapefile.
    """
    held = {name: data for name, data in members.items() if SITE_MEMBER.fullmatch(name)}
    main = member_name(file)
    if main not in held:
        raise BundleError(f"lacks {main}", where=source, advice="ask for the file again from whoever approved it")
    parts = {file: held.pop(main)}
    stem = Path(file).stem
    for ending in SHAPEFILE_PARTS:
        if f"site{ending}" in held:
            parts[f"{stem}{ending}"] = held.pop(f"site{ending}")
    if held:
        raise BundleError(f"holds {min(held)}, which is no part of the site", where=source, advice="do not trust it")
    return SiteFiles(parts=parts, source=f"{source}, {main}")
