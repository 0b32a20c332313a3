"""Images of messages as files: pixels as they were sent, what cannot be read refused with the reason."""

from __future__ import annotations

import io
from typing import Any

import numpy as np
import pytest
from hypothesis import given
from hypothesis import strategies as st
from PIL import Image

from fieldhand.errors import Ros2Error
from fieldhand.execution.drivers.ros2.images import MOST_PIXELS, image_of

WIDTH, HEIGHT = 5, 3
CHANNELS = {"rgb8": 3, "bgr8": 3, "8UC3": 3, "rgba8": 4, "bgra8": 4, "8UC4": 4, "mono8": 1, "8UC1": 1}


def raw(encoding: str, values: np.ndarray[Any, Any], *, padding: int = 0, big: bool = False) -> dict[str, object]:
    """A message whose lines are padded with bytes that belong to no pixel."""
    sent = values.astype(values.dtype.newbyteorder(">" if big else "<"))
    lines = [line.tobytes() + b"\xaa" * padding for line in sent]
    return {
        "height": values.shape[0],
        "width": values.shape[1],
        "encoding": encoding,
        "is_bigendian": int(big),
        "step": len(lines[0]),
        "data": b"".join(lines),
    }


def opened(message: dict[str, object]) -> tuple[Image.Image, Any]:
    found = image_of(message, "rgb", "/camera")
    return Image.open(io.BytesIO(found.data)), found


@pytest.mark.parametrize("encoding", CHANNELS)
@pytest.mark.parametrize("padding", [0, 7])
def test_eight_bits(encoding: str, padding: int) -> None:
    channels = CHANNELS[encoding]
    values = np.random.default_rng(1).integers(0, 256, (HEIGHT, WIDTH, channels), dtype=np.uint8)
    picture, found = opened(raw(encoding, values, padding=padding))
    turned = encoding in ("bgr8", "bgra8", "8UC3", "8UC4")
    order = [2, 1, 0, 3][:channels] if turned else list(range(channels))
    pixels = np.asarray(picture).reshape(HEIGHT, WIDTH, channels)
    assert (pixels == values[:, :, order]).all()
    assert (found.format, found.width, found.height, found.encoding) == ("png", WIDTH, HEIGHT, encoding)


@pytest.mark.parametrize("encoding", ["mono16", "16UC1"])
@pytest.mark.parametrize("big", [False, True])
def test_sixteen_bits_keep_their_values(encoding: str, big: bool) -> None:
    values = np.random.default_rng(2).integers(0, 65_536, (HEIGHT, WIDTH), dtype=np.uint16)
    picture, found = opened(raw(encoding, values, padding=2, big=big))
    assert (np.asarray(picture).astype(np.uint16) == values).all()
    assert found.format == "png"


@pytest.mark.parametrize("big", [False, True])
def test_floating_point_values_are_kept(big: bool) -> None:
    values = np.random.default_rng(3).normal(300.0, 20.0, (HEIGHT, WIDTH)).astype(np.float32)
    values[0, 0] = np.nan
    picture, found = opened(raw("32FC1", values, big=big))
    assert np.array_equal(np.asarray(picture), values, equal_nan=True)
    assert found.format == "tiff"
    assert "own unit" in found.note


@pytest.mark.parametrize("kind", ["JPEG", "PNG"])
def test_compressed_images_stay_as_they_are(kind: str) -> None:
    out = io.BytesIO()
    Image.new("RGB", (8, 6), (10, 200, 30)).save(out, format=kind)
    found = image_of({"format": "rgb8; jpeg compressed bgr8", "data": out.getvalue()}, "rgb", "/camera")
    assert (found.data, found.format, found.width, found.height) == (out.getvalue(), kind.lower(), 8, 6)


@pytest.mark.parametrize(
    ("changed", "why"),
    [
        ({"encoding": "bayer_rggb8"}, "'bayer_rggb8' is what a Bayer sensor measures"),
        ({"encoding": "yuv422"}, "its encoding 'yuv422' is not known"),
        ({"encoding": "\x1b[2J\u202e" * 30}, r"its encoding '\\x1b\[2J\\u202e"),
        ({"step": 4}, "a line of 4 bytes is too short for 5 pixels of rgb8"),
        ({"data": b"\0" * 20}, "it has 20 bytes, fewer than 3 lines of 15"),
        ({"width": 0}, "0 x 3 pixels are not between"),
        ({"width": 40_000, "height": 40_000}, "40000 x 40000 pixels"),
        ({"height": 2**31, "step": 2**32 - 1}, "5 x 2147483648 pixels"),
        ({"data": None}, "it has no data"),
        ({"width": "5"}, "its width is '5'"),
    ],
)
def test_what_is_no_image_is_refused(changed: dict[str, object], why: str) -> None:
    whole = raw("rgb8", np.zeros((HEIGHT, WIDTH, 3), dtype=np.uint8))
    with pytest.raises(Ros2Error, match=why) as caught:
        image_of({**whole, **changed}, "rgb", "/camera")
    assert str(caught.value).isprintable()


def compressed(**changed: object) -> dict[str, object]:
    out = io.BytesIO()
    Image.new("RGB", (64, 48), (10, 200, 30)).save(out, format="JPEG")
    return {"format": "jpeg", "data": out.getvalue(), **changed}


@pytest.mark.parametrize(
    ("data", "why"),
    [
        (b"", "it has no data"),
        (b"GIF89a" + bytes(40), "it is neither a JPEG nor a PNG"),
        (compressed()["data"][:200], "it is damaged"),  # type: ignore[index]
    ],
)
def test_a_damaged_or_other_file_is_refused(data: bytes, why: str) -> None:
    with pytest.raises(Ros2Error, match=why):
        image_of(compressed(data=data), "rgb", "/camera")


def test_a_bomb_is_not_unpacked() -> None:
    out = io.BytesIO()
    side = int(MOST_PIXELS**0.5) + 10
    Image.new("1", (side, side)).save(out, format="PNG")
    assert len(out.getvalue()) < 100_000
    with pytest.raises(Ros2Error, match="pixels are not between"):
        image_of({"format": "png", "data": out.getvalue()}, "rgb", "/camera")


@given(st.binary(max_size=400), st.text(max_size=20), st.booleans())
def test_any_bytes_are_an_image_or_refused(data: bytes, words: str, starts: bool) -> None:
    whole = b"\x89PNG\r\n\x1a\n" + data if starts else data
    with pytest.raises(Ros2Error) as caught:  # none is a whole image
        image_of({"format": words, "data": whole}, "rgb", "/camera")
    assert str(caught.value).isprintable()
