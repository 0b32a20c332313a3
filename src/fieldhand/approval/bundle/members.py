"""The site in a bundle: its original files, byte for byte, under neutral member names.

The site is not rewritten, because approvals and Tasks cite the SHA-256 of the original bytes, and because projecting
zone corners again would move them by rounding.
"""

from __future__ import annotations

from collections.abc import Mapping
from pathlib import Path

from fieldhand.approval.bundle.container import SITE_MEMBER
from fieldhand.errors import BundleError
from fieldhand.site.formats.files import SiteFiles
from fieldhand.site.formats.records import SHAPEFILE_PARTS


def site_members(files: SiteFiles) -> dict[str, bytes]:
    """Return the files of a site by member name."""
    return {member_name(name): data for name, data in files.parts.items()}


def member_name(file: str) -> str:
    """Return the member name: ``site`` plus the file's extension, if it has a plain one."""
    name = f"site{Path(file).suffix.lower()}"
    return name if SITE_MEMBER.fullmatch(name) else "site"


def site_files_of(members: Mapping[str, bytes], file: str, *, source: str) -> SiteFiles:
    """Return the files of the site as they were read before packing.

    Args:
        members: Members of the bundle.
        file: Original name of the main file.
        source: Name of the bundle in error messages.

    Raises:
        BundleError: The main file is missing, or a part belongs to no Shapefile.
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
        raise BundleError(
            f"contains {min(held)}, which does not belong to the site", where=source, advice="do not trust it"
        )
    return SiteFiles(parts=parts, source=f"{source}, {main}")
