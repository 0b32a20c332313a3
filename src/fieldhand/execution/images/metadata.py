"""Position, time and names of an image as EXIF, added to its file without encoding it again.

A JPEG gets a segment APP1 in place of one that it has, a PNG a chunk ``eXIf``. What a camera has written is kept, if it
can be read. EXIF 2.32 defines the tags; PNG 3 (W3C) the chunk.
"""

from __future__ import annotations

import io
import json
import struct
import zlib
from dataclasses import dataclass
from datetime import datetime
from typing import TYPE_CHECKING

from fieldhand.compatibility import UTC
from fieldhand.execution.drivers.protocol import CapturedImage, Position
from fieldhand.hidden_characters import visible
from fieldhand.robot.camera import Camera
from fieldhand.site.model import Place

if TYPE_CHECKING:
    from PIL import Image

#: Longest contents of a JPEG segment, and the words that begin one with EXIF.
_MOST_SEGMENT, _EXIF = 65_533, b"Exif\x00\x00"
_JPEG, _PNG = b"\xff\xd8", b"\x89PNG\r\n\x1a\n"
_APP1, _SCAN = 0xE1, 0xDA
#: Denominator of rationals.
_PARTS = 1_000_000
_ORIENTATION_IFD, _GPS_IFD = 0x8769, 0x8825


@dataclass(frozen=True, kw_only=True)
class ImageFacts:
    """Facts about a capture.

    Attributes:
        number: Number of the goal in the mission, which makes the name of the file unique.
        node: Id of the plan node.
        attempt: Attempt at the capture, from 1.
        action: Name of the action.
        place: Place at which it was taken.
        position: Position of the robot.
        heading_deg: Heading of the robot in degrees clockwise from true north; None if unknown.
        taken_s: Time of day in seconds since 1970; None if there is none.
        camera: Camera that took it, if the profile says where it looks.
    """

    number: int
    node: str
    attempt: int
    action: str
    place: Place
    position: Position
    heading_deg: float | None
    taken_s: float | None
    camera: Camera | None = None

    @property
    def direction_deg(self) -> float | None:
        """Direction of the picture, in degrees clockwise from true north; that of the robot without a camera's side."""
        if self.heading_deg is None or self.camera is None:
            return self.heading_deg
        return self.camera.bearing_at(self.heading_deg)


def with_metadata(image: CapturedImage, facts: ImageFacts, mission: str, robot: str) -> bytes:
    """Return the file of an image with its EXIF.

    Args:
        mission, robot: Id of the mission's Task and name of the robot.
    """
    from PIL import Image

    with Image.open(io.BytesIO(image.data)) as opened:
        exif = _exif(opened, image, facts, mission, robot)
        match image.format:
            case "tiff":
                out = io.BytesIO()
                opened.save(out, format="TIFF", exif=exif)
                return out.getvalue()
            case "png":
                return _into_png(image.data, exif.tobytes().removeprefix(_EXIF))
            case _:
                data = exif.tobytes()
                if len(data) > _MOST_SEGMENT:
                    data = _exif(None, image, facts, mission, robot).tobytes()
                return _into_jpeg(image.data, data)


def description(image: CapturedImage, facts: ImageFacts, mission: str) -> str:
    """Return the description of an image: JSON of text without hidden characters, in ASCII as EXIF requires."""
    about: dict[str, object] = {
        "mission": visible(mission),
        "node": visible(facts.node),
        "capture": facts.number,
        "attempt": facts.attempt,
        "action": facts.action,
        "image": image.name,
        "place": {"kind": facts.place.kind, "id": visible(facts.place.id)},
        "encoding": image.encoding,
    }
    if image.note:
        about["values"] = image.note
    return json.dumps(about, ensure_ascii=True)


def _exif(opened: Image.Image | None, image: CapturedImage, facts: ImageFacts, mission: str, robot: str) -> Image.Exif:
    """Return the EXIF of an image: that of the camera with ours in its place."""
    from PIL import ExifTags, Image

    exif = Image.Exif()
    if opened is not None and image.format == "jpeg":
        try:
            exif = opened.getexif()
            exif.tobytes()
        except Exception:  # noqa: BLE001  a camera may write anything, and the library raises whatever it meets
            exif = Image.Exif()
    base, gps_tag = ExifTags.Base, ExifTags.GPS
    exif[base.ImageDescription] = description(image, facts, mission)
    exif[base.Software] = "fieldhand"
    exif[base.Model] = visible(robot).encode("ascii", "backslashreplace").decode()
    inner = exif.get_ifd(_ORIENTATION_IFD)
    if facts.taken_s is not None:
        taken = datetime.fromtimestamp(facts.taken_s, UTC)
        inner[base.DateTimeOriginal] = exif[base.DateTime] = taken.strftime("%Y:%m:%d %H:%M:%S")
        inner[base.OffsetTimeOriginal] = "+00:00"
        inner[base.SubsecTimeOriginal] = f"{taken.microsecond // 1000:03d}"
    at, place = facts.position, facts.place
    gps: dict[int, object] = {
        gps_tag.GPSVersionID: b"\x02\x03\x00\x00",
        gps_tag.GPSMapDatum: "WGS-84",
        **_angles(
            at.lat,
            at.lon,
            (gps_tag.GPSLatitudeRef, gps_tag.GPSLatitude),
            (gps_tag.GPSLongitudeRef, gps_tag.GPSLongitude),
        ),
        **_angles(
            place.lat,
            place.lon,
            (gps_tag.GPSDestLatitudeRef, gps_tag.GPSDestLatitude),
            (gps_tag.GPSDestLongitudeRef, gps_tag.GPSDestLongitude),
        ),
    }
    if facts.taken_s is not None:
        taken = datetime.fromtimestamp(facts.taken_s, UTC)
        gps[gps_tag.GPSDateStamp] = taken.strftime("%Y:%m:%d")
        gps[gps_tag.GPSTimeStamp] = tuple(_rational(float(part)) for part in (taken.hour, taken.minute, taken.second))
    if facts.direction_deg is not None:
        gps[gps_tag.GPSImgDirectionRef], gps[gps_tag.GPSImgDirection] = "T", _rational(facts.direction_deg)
    own = exif.get_ifd(_GPS_IFD)
    own.clear()
    own.update(gps)
    # Read again by the library where it writes them.
    exif[_GPS_IFD], exif[_ORIENTATION_IFD] = own, inner
    return exif


def _angles(lat: float, lon: float, north: tuple[int, int], east: tuple[int, int]) -> dict[int, object]:
    """Return latitude and longitude as degrees, minutes and seconds, each with its reference."""
    found: dict[int, object] = {}
    for value, (ref, tag), words in ((lat, north, "NS"), (lon, east, "EW")):
        minutes, seconds = divmod(abs(value) * 3600.0, 60.0)
        degrees, minutes = divmod(minutes, 60.0)
        found[ref] = words[0] if value >= 0 else words[1]
        found[tag] = (_rational(degrees), _rational(minutes), _rational(seconds))
    return found


def _rational(value: float) -> object:
    from PIL.TiffImagePlugin import IFDRational

    return IFDRational(round(value * _PARTS), _PARTS)


def _into_png(data: bytes, exif: bytes) -> bytes:
    """Return a PNG with its EXIF behind the header, in place of one that it has."""
    pieces, at = [data[: len(_PNG)]], len(_PNG)
    while at + 8 <= len(data):
        (length,), kind = struct.unpack(">I", data[at : at + 4]), data[at + 4 : at + 8]
        end = at + 12 + length
        if kind != b"eXIf":
            pieces.append(data[at:end])
        if kind == b"IHDR":
            pieces.append(_chunk(b"eXIf", exif))
        if kind == b"IEND":
            break
        at = end
    return b"".join(pieces)


def _chunk(kind: bytes, data: bytes) -> bytes:
    return struct.pack(">I", len(data)) + kind + data + struct.pack(">I", zlib.crc32(kind + data))


def _into_jpeg(data: bytes, exif: bytes) -> bytes:
    """Return a JPEG with its EXIF as first segment, in place of one that it has."""
    pieces = [_JPEG, struct.pack(">BBH", 0xFF, _APP1, len(exif) + 2), exif]
    at = len(_JPEG)
    while at + 4 <= len(data) and data[at] == 0xFF:
        marker, (length,) = data[at + 1], struct.unpack(">H", data[at + 2 : at + 4])
        if marker == _SCAN:
            break
        end = at + 2 + length
        if marker != _APP1 or not data[at + 4 : end].startswith(_EXIF):
            pieces.append(data[at:end])
        at = end
    return b"".join([*pieces, data[at:]])
