"""The zip container of a mission, written in one canonical byte layout; any other layout is refused.

The same mission therefore always has the same SHA-256, whoever packs it; every changed bit is detected, even in dates
and unused fields; and two programs cannot read different files from it. Files are stored without compression, so
that unpacked data cannot exceed the size of the file and no decompressor processes unverified bytes.
"""

from __future__ import annotations

import io
import re
import stat
import struct
import zipfile
from collections.abc import Mapping
from pathlib import Path, PurePosixPath

from fieldhand.errors import BundleError
from fieldhand.files import FileFault, read_file
from fieldhand.language import message, recalled

#: Maximum size of the file: a site of 100 MB, the largest that is read, plus the other members.
MAX_BYTES = 128_000_000
MAX_MEMBERS = 12
MANIFEST, SIGNATURE, TASK, ROBOT = "manifest.json", "signature.txt", "task.xml", "robot.yaml"
#: Member names of the site, independent of its original file name; a Shapefile has several parts.
SITE_MEMBER = re.compile(r"site(\.[a-z0-9]{1,10})?")
#: Maximum size of each member in bytes, checked before reading it.
_MOST = {MANIFEST: 1_000_000, SIGNATURE: 1_000, TASK: 4_000_000, ROBOT: 1_000_000}
_FIRST = (MANIFEST, SIGNATURE, TASK, ROBOT)
_MIDNIGHT = (1980, 1, 1, 0, 0, 0)
_END = struct.Struct("<4s4H2LH")
_MAX_DIRECTORY = MAX_MEMBERS * 100
_AGAIN = "ask for the file again from whoever approved it"


def wrap(members: Mapping[str, bytes]) -> bytes:
    """Pack the members into a zip file; equal members give equal bytes.

    Raises:
        BundleError: The zip file would exceed the maximum size.
    """
    for name, data in members.items():
        most = _MOST.get(name, MAX_BYTES)
        if len(data) > most:
            raise BundleError(f"{name} has {len(data):,} bytes, more than {most:,}", advice="make the mission smaller")
    packed = io.BytesIO()
    with zipfile.ZipFile(packed, "w", zipfile.ZIP_STORED) as archive:
        for name in _in_order(members):
            info = zipfile.ZipInfo(name, date_time=_MIDNIGHT)
            info.create_system, info.create_version, info.extract_version = 3, 20, 20
            info.external_attr = (stat.S_IFREG | 0o644) << 16
            archive.writestr(info, members[name], zipfile.ZIP_STORED)
    data = packed.getvalue()
    if len(data) > MAX_BYTES:
        raise BundleError(f"the bundle has {len(data):,} bytes, more than {MAX_BYTES:,}", advice="use a smaller site")
    return data


def unwrap(data: bytes, *, source: str) -> dict[str, bytes]:
    """Return the members of a bundle.

    Args:
        data: The file.
        source: Name of the bundle in error messages.

    Raises:
        BundleError: The data is not a zip file as written by :func:`wrap`: damaged, changed, or packed by another tool.
    """
    if len(data) > MAX_BYTES:
        raise too_big(len(data), source)
    _require_plain_end(data, source)
    try:
        with zipfile.ZipFile(io.BytesIO(data)) as archive:
            infos = archive.infolist()
            _require_names(infos, source)
            for info in infos:
                _require_plain(info, source)
            members = {info.filename: archive.read(info) for info in infos}
    except (zipfile.BadZipFile, zipfile.LargeZipFile, NotImplementedError, EOFError, ValueError, RuntimeError) as fault:
        raise BundleError(f"is damaged ({fault})", where=source, advice=_AGAIN) from None
    if wrap(members) != data:
        raise BundleError("was changed after it was approved", where=source, advice=_AGAIN)
    return members


def read_bundle_file(path: Path) -> bytes:
    """Read a bundle from a file, refusing oversized files before reading them.

    Raises:
        BundleError: The file is missing, not a regular file, empty, too large, or unreadable.
    """
    at = str(path)
    try:
        return read_file(path, MAX_BYTES, plain=True)
    except FileFault as fault:
        if fault.kind == "too large":
            raise too_big(fault.size, at) from None
        found = fault.kind == "unreadable"
        advice = (
            message("check the path and its permissions")
            if found
            else message("give a file that fieldhand approve wrote")
        )
        raise BundleError(recalled(fault.what, "file"), where=at, advice=advice) from None


def too_big(size: int, source: str) -> BundleError:
    """Return the error for a file that is too large to be a bundle."""
    return BundleError(
        f"has {size / 1e6:,.0f} MB, more than the {MAX_BYTES / 1e6:,.0f} MB of the largest mission",
        where=source,
        advice="give a file that fieldhand approve wrote",
    )


def _in_order(members: Mapping[str, bytes]) -> list[str]:
    return [*(name for name in _FIRST if name in members), *sorted(set(members) - set(_FIRST))]


def _require_plain_end(data: bytes, source: str) -> None:
    """Check the end-of-archive record before the zip reader does, which would trust any member count in it."""
    if not data.startswith(b"PK\x03\x04"):
        what = "is empty" if not data else "is not a mission bundle: it is not a zip file"
        raise BundleError(what, where=source, advice="give a file that fieldhand approve wrote")
    end = data[-_END.size :]
    if len(end) < _END.size or not end.startswith(b"PK\x05\x06"):
        raise BundleError("is truncated, or something was added to it", where=source, advice=_AGAIN)
    _, disk, first_disk, here, members, directory, _, comment = _END.unpack(end)
    if disk or first_disk or comment or here != members or data[-_END.size - 20 :].startswith(b"PK\x06\x07"):
        raise BundleError("is a zip file of another kind", where=source, advice=_AGAIN)
    if members > MAX_MEMBERS or directory > _MAX_DIRECTORY:
        raise BundleError(f"contains {members} files; a mission has at most {MAX_MEMBERS}", where=source, advice=_AGAIN)


def _require_names(infos: list[zipfile.ZipInfo], source: str) -> None:
    """Require exactly the members of a mission, each once."""
    names = [info.filename for info in infos]
    for name in names:
        path = PurePosixPath(name)
        if path.is_absolute() or ".." in path.parts or "\\" in name or ":" in name:
            raise BundleError(
                f"contains a path that leads out of it ({name[:60]!r})", where=source, advice="do not trust this file"
            )
        if name not in _FIRST and not SITE_MEMBER.fullmatch(name):
            raise BundleError(
                f"contains a file that does not belong to a mission ({name[:60]!r})", where=source, advice=_AGAIN
            )
        if names.count(name) > 1:
            raise BundleError(f"contains {name} twice", where=source, advice="do not trust this file")
    missing = [name for name in _FIRST if name not in names]
    if not any(SITE_MEMBER.fullmatch(name) for name in names):
        missing.append("the site")
    if missing:
        raise BundleError(f"lacks {', '.join(missing)}", where=source, advice=_AGAIN)


def _require_plain(info: zipfile.ZipInfo, source: str) -> None:
    """Require a member that is stored uncompressed, is not a link, and does not exceed its maximum size."""
    if info.flag_bits & 0x1:
        raise BundleError(f"{info.filename} is encrypted", where=source, advice=_AGAIN)
    if stat.S_IFMT(info.external_attr >> 16) not in (0, stat.S_IFREG):
        raise BundleError(f"{info.filename} is a link, not a file", where=source, advice="do not trust this file")
    if info.compress_type != zipfile.ZIP_STORED or info.compress_size != info.file_size:
        raise BundleError(f"{info.filename} is compressed, so the bundle was repacked", where=source, advice=_AGAIN)
    most = _MOST.get(info.filename, MAX_BYTES)
    if info.file_size > most:
        raise BundleError(f"{info.filename} has more than {most:,} bytes", where=source, advice=_AGAIN)
