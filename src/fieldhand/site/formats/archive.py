"""Unpack zip files safely: only inside the target folder, bounded in size, and only the file types of a site."""

from __future__ import annotations

import io
import zipfile
from collections.abc import Collection
from pathlib import Path, PurePosixPath

from fieldhand.errors import SiteError

MAX_UNPACKED = 200_000_000
MAX_MEMBERS = 2_000
#: Coordinates compress to a tenth, sparse tables to a hundredth; a higher ratio indicates a zip bomb.
MAX_RATIO = 250
_SMALL = 1_000_000
_CHUNK = 1 << 18


def unpack(data: bytes, endings: Collection[str], folder: Path, at: str) -> list[Path]:
    """Unpack the members with these extensions into an empty folder and return their paths, in archive order.

    Members of one folder of the archive stay together in one folder. Nested archives are not opened.

    Raises:
        SiteError: The data is not a zip file, is damaged or encrypted, names a path outside itself, or unpacks to too
            much.
    """
    try:
        with zipfile.ZipFile(io.BytesIO(data)) as archive:
            members = archive.infolist()
            if len(members) > MAX_MEMBERS:
                raise SiteError(
                    f"the archive contains {len(members):,} files, more than {MAX_MEMBERS:,}",
                    where=at,
                    advice="pack only the files of one site",
                )
            wanted = [m for m in members if _checked(m, at) and PurePosixPath(m.filename).suffix.lower() in endings]
            return _write(archive, wanted, len(data), folder, at)
    except (zipfile.BadZipFile, zipfile.LargeZipFile, NotImplementedError, EOFError, ValueError) as fault:
        raise SiteError(f"the archive is damaged ({fault})", where=at, advice="pack it again as a plain zip") from None
    except zipfile.zlib.error as fault:  # type: ignore[attr-defined]
        raise SiteError(f"the archive is damaged ({fault})", where=at, advice="pack it again as a plain zip") from None


def _checked(member: zipfile.ZipInfo, at: str) -> bool:
    """Return True for a regular, visible member; raise an error for an encrypted one or a path outside the archive."""
    if not member.filename:
        raise zipfile.BadZipFile("a file without a name")
    path = PurePosixPath(member.filename)
    if path.is_absolute() or ".." in path.parts or "\\" in member.filename or ":" in member.filename:
        raise SiteError(
            f"the archive contains a path that leads out of it ({member.filename[:60]!r})",
            where=at,
            advice="do not trust this file; request it again from its source",
        )
    if member.flag_bits & 0x1:
        raise SiteError("the archive is encrypted", where=at, advice="pack it again without a password")
    hidden = any(part.startswith((".", "__MACOSX")) for part in path.parts)
    return not member.is_dir() and not hidden


def _write(archive: zipfile.ZipFile, members: list[zipfile.ZipInfo], packed: int, folder: Path, at: str) -> list[Path]:
    """Unpack the members, counting the bytes actually written: the sizes stated in the archive may be forged."""
    most = min(MAX_UNPACKED, max(_SMALL, packed * MAX_RATIO))
    folders: dict[PurePosixPath, Path] = {}
    written: list[Path] = []
    total = 0
    for member in members:
        inside = PurePosixPath(member.filename)
        into = folders.setdefault(inside.parent, folder / str(len(folders)))
        into.mkdir(exist_ok=True)
        path = into / inside.name
        with archive.open(member) as source, path.open("wb") as target:
            while chunk := source.read(_CHUNK):
                total += len(chunk)
                if total > most:
                    raise SiteError(
                        f"the archive unpacks to more than {most / 1e6:,.0f} MB",
                        where=at,
                        advice="do not trust this file; a site of this size needs less",
                    )
                target.write(chunk)
        written.append(path)
    return written
