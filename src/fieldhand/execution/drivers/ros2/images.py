"""Images of ROS messages as files: ``sensor_msgs/msg/Image`` as PNG or TIFF, ``CompressedImage`` as it is.

| encoding | file |
|---|---|
| rgb8, bgr8, 8UC3 (bgr), rgba8, bgra8, 8UC4 (bgra), mono8, 8UC1 | PNG |
| mono16, 16UC1 | PNG with 16 bits, the values unchanged |
| 32FC1 | TIFF with floating-point values, unchanged |
| jpeg, png of a CompressedImage | the bytes as they came |

Other encodings are refused with the reason: pictures of a Bayer sensor have to be converted by the camera's own nodes.
Sizes are checked before anything is decoded.
"""

from __future__ import annotations

import io
import math
import re
import warnings
from collections.abc import Mapping
from dataclasses import dataclass
from typing import TYPE_CHECKING, Literal

import numpy as np

from fieldhand.errors import Ros2Error
from fieldhand.execution.drivers.protocol import CapturedImage
from fieldhand.execution.drivers.ros2.transport import RosMessage

if TYPE_CHECKING:
    from PIL.Image import Image

#: Largest image in pixels, and on one side.
MOST_PIXELS, MOST_SIDE = 50_000_000, 30_000
#: Characters of an encoding that are quoted.
_QUOTED = 40
_WORD = re.compile(r"[A-Za-z0-9_]{1,40}")


@dataclass(frozen=True, kw_only=True)
class _Encoding:
    """Layout of a pixel: channels of a type, in the order of the file, and the mode of the image library."""

    mode: str
    type: str
    order: tuple[int, ...] = (0,)


_ENCODINGS: Mapping[str, _Encoding] = {
    "rgb8": _Encoding(mode="RGB", type="u1", order=(0, 1, 2)),
    "bgr8": _Encoding(mode="RGB", type="u1", order=(2, 1, 0)),
    "8UC3": _Encoding(mode="RGB", type="u1", order=(2, 1, 0)),
    "rgba8": _Encoding(mode="RGBA", type="u1", order=(0, 1, 2, 3)),
    "bgra8": _Encoding(mode="RGBA", type="u1", order=(2, 1, 0, 3)),
    "8UC4": _Encoding(mode="RGBA", type="u1", order=(2, 1, 0, 3)),
    "mono8": _Encoding(mode="L", type="u1"),
    "8UC1": _Encoding(mode="L", type="u1"),
    "mono16": _Encoding(mode="I;16", type="u2"),
    "16UC1": _Encoding(mode="I;16", type="u2"),
    "32FC1": _Encoding(mode="F", type="f4"),
}
#: Notes on values that are no shades of grey.
_NOTES = {
    "16UC1": "16-bit values as the robot sent them, without scale or offset",
    "32FC1": "floating-point values as the robot sent them, in its own unit",
}
_FORMATS: Mapping[str, Literal["jpeg", "png"]] = {"JPEG": "jpeg", "PNG": "png"}


def image_of(message: RosMessage, name: str, source: str) -> CapturedImage:
    """Return the image in a message.

    Args:
        message: A ``sensor_msgs/msg/Image`` or ``CompressedImage``.
        name: Name of the image in the profile.
        source: Topic or action that it came from, for errors.

    Raises:
        Ros2Error: The image cannot be read, or is of a kind that is not saved.
    """
    try:
        return _compressed(message, name) if "format" in message else _raw(message, name)
    except _Unusable as error:
        raise Ros2Error(f"the image {name} of {source} cannot be used: {error}", advice=error.advice) from None


class _Unusable(Exception):
    """The reason why an image cannot be used, with what to do."""

    def __init__(self, what: str, advice: str = "") -> None:
        self.advice = advice
        super().__init__(what)


def _raw(message: RosMessage, name: str) -> CapturedImage:
    width, height, step = (_whole(message, key) for key in ("width", "height", "step"))
    data, encoding = message.get("data"), str(message.get("encoding"))
    known = _ENCODINGS.get(encoding)
    if known is None:
        raise _Unusable(*_unknown(encoding))
    _require_size(width, height)
    if not isinstance(data, bytes):
        raise _Unusable("it has no data")
    channels, kind = len(known.order), np.dtype(known.type)
    least = width * channels * kind.itemsize
    if step < least:
        raise _Unusable(f"a line of {step} bytes is too short for {width} pixels of {encoding}, which have {least}")
    # The last line may lack its padding.
    if len(data) < step * (height - 1) + least:
        raise _Unusable(f"it has {len(data)} bytes, fewer than {height} lines of {step}")
    data = data[: step * height].ljust(step * height, b"\0")
    lines = np.frombuffer(data, dtype=np.uint8).reshape(height, step)[:, :least]
    sent = kind.newbyteorder(">") if message.get("is_bigendian") else kind.newbyteorder("<")
    values = np.ascontiguousarray(lines).view(sent).reshape(height, width, channels)
    pixels = np.ascontiguousarray(values[:, :, list(known.order)].astype(kind.newbyteorder("<")))
    picture = _picture(known.mode, (width, height), pixels.tobytes())
    out = io.BytesIO()
    if known.mode == "F":
        picture.save(out, format="TIFF")
    else:
        picture.save(out, format="PNG", compress_level=3)
    return CapturedImage(
        name=name,
        format="tiff" if known.mode == "F" else "png",
        data=out.getvalue(),
        width=width,
        height=height,
        encoding=encoding,
        note=_NOTES.get(encoding, ""),
    )


def _picture(mode: str, size: tuple[int, int], data: bytes) -> Image:
    from PIL import Image

    return Image.frombytes(mode, size, data)


def _compressed(message: RosMessage, name: str) -> CapturedImage:
    """Return a compressed image: its first bytes say what it is, and all of it must be readable."""
    from PIL import Image, UnidentifiedImageError

    data = message.get("data")
    given = " ".join(str(message.get("format")).split())[:_QUOTED]
    if not isinstance(data, bytes) or not data:
        raise _Unusable("it has no data")
    try:
        with warnings.catch_warnings():
            warnings.simplefilter("error")
            with Image.open(io.BytesIO(data), formats=list(_FORMATS)) as opened:
                _require_size(*opened.size)
                kind, (width, height) = _FORMATS[opened.format or ""], opened.size
                opened.load()
    except _Unusable:
        raise
    except (UnidentifiedImageError, KeyError):
        advice = "publish it as jpeg or png"
        raise _Unusable(f"it is neither a JPEG nor a PNG (its format says {given!r})", advice) from None
    except Exception as error:  # noqa: BLE001  the library raises whatever it meets in bytes that come from anyone
        raise _Unusable(f"it is damaged ({' '.join(str(error).split())[:80]})") from None
    return CapturedImage(
        name=name,
        format=kind,
        data=data,
        width=width,
        height=height,
        encoding=given if _WORD.fullmatch(given) else kind,
    )


def _unknown(encoding: str) -> tuple[str, str]:
    """Return why an encoding is not used, and what to do."""
    if encoding.startswith("bayer_"):
        return (
            f"{encoding[:_QUOTED]!r} is what a Bayer sensor measures, not a picture",
            "bind the topic of a debayered image, as image_proc publishes it",
        )
    advice = f"publish it as one of {', '.join(_ENCODINGS)}, or as a CompressedImage"
    return f"its encoding {encoding[:_QUOTED]!r} is not known", advice


def _require_size(width: int, height: int) -> None:
    if not (0 < width <= MOST_SIDE and 0 < height <= MOST_SIDE) or width * height > MOST_PIXELS:
        raise _Unusable(
            f"{width} x {height} pixels are not between 1 and {MOST_SIDE} on each side, {MOST_PIXELS:,} in all",
            "publish a smaller image",
        )


def _whole(message: RosMessage, key: str) -> int:
    value = message.get(key)
    if not isinstance(value, int) or value < 0 or not math.isfinite(value):
        raise _Unusable(f"its {key} is {value!r}")
    return value
