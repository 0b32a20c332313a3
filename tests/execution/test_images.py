"""Images of captures in files: pixels unchanged, position and names in the EXIF, space left for the journal."""

import hashlib
import io
import json
from dataclasses import replace

import numpy as np
import pytest
from hypothesis import given
from hypothesis import strategies as st
from PIL import ExifTags, Image

from fieldhand.execution.drivers.protocol import CapturedImage, Position
from fieldhand.execution.images.course import Course
from fieldhand.execution.images.folder import ImageFolder, save_image
from fieldhand.execution.images.metadata import ImageFacts, with_metadata
from fieldhand.robot.camera import Camera
from fieldhand.site.bearings import apart_deg
from fieldhand.site.model import Place
from fieldhand.task.event_lines import from_json, to_json
from fieldhand.task.results import Acted
from support.missions.rig import husky

FACTS = ImageFacts(
    number=12,
    node="n4",
    attempt=2,
    action="take_picture",
    place=Place(kind="tree", id="12", x=1.0, y=2.0, lat=37.0711, lon=-120.2583),
    position=Position(x=0.0, y=0.0, lat=37.07105, lon=-120.25835),
    heading_deg=83.25,
    taken_s=1_770_000_000.25,
)
GPS, EXIF = 0x8825, 0x8769


def coloured():
    return Image.fromarray(np.random.default_rng(0).integers(0, 256, (30, 40, 3), dtype=np.uint8))


def encoded(picture, format_, **more):
    out = io.BytesIO()
    picture.save(out, format=format_, **more)
    return out.getvalue()


def image(format_="png", data=None, **more):
    data = encoded(coloured(), format_.upper()) if data is None else data
    return CapturedImage(name="rgb", format=format_, data=data, width=40, height=30, encoding="rgb8", **more)


def degrees(parts):
    return float(parts[0]) + float(parts[1]) / 60 + float(parts[2]) / 3600


@pytest.mark.parametrize("format_", ["png", "jpeg", "tiff"])
def test_position_time_and_names_are_in_the_file(format_):
    given_ = image(format_) if format_ != "tiff" else image("tiff", encoded(Image.new("F", (40, 30), 301.5), "TIFF"))
    with Image.open(io.BytesIO(with_metadata(given_, FACTS, "corners", "husky"))) as opened:
        exif = opened.getexif()
        gps, inner = exif.get_ifd(GPS), exif.get_ifd(EXIF)
        assert np.array_equal(np.asarray(opened), np.asarray(Image.open(io.BytesIO(given_.data))))
    tag = ExifTags.GPS
    assert degrees(gps[tag.GPSLatitude]) == pytest.approx(FACTS.position.lat, abs=1e-7)
    assert degrees(gps[tag.GPSLongitude]) == pytest.approx(-FACTS.position.lon, abs=1e-7)
    assert (gps[tag.GPSLatitudeRef], gps[tag.GPSLongitudeRef], gps[tag.GPSImgDirectionRef]) == ("N", "W", "T")
    assert float(gps[tag.GPSImgDirection]) == 83.25
    assert degrees(gps[tag.GPSDestLatitude]) == pytest.approx(FACTS.place.lat, abs=1e-7)
    assert inner[ExifTags.Base.DateTimeOriginal] == "2026:02:02 02:40:00"
    assert inner[ExifTags.Base.OffsetTimeOriginal] == "+00:00"
    about = json.loads(exif[ExifTags.Base.ImageDescription])
    assert about == {
        "mission": "corners",
        "node": "n4",
        "capture": 12,
        "attempt": 2,
        "action": "take_picture",
        "image": "rgb",
        "place": {"kind": "tree", "id": "12"},
        "encoding": "rgb8",
    }


def test_a_jpeg_is_not_encoded_again_and_keeps_what_the_camera_wrote():
    camera = Image.Exif()
    camera[ExifTags.Base.Make] = "Thermo"
    camera.get_ifd(EXIF)[ExifTags.Base.ExposureTime] = 0.01
    data = encoded(coloured(), "JPEG", quality=90, exif=camera)
    saved = with_metadata(image("jpeg", data), FACTS, "m", "husky")
    scan = data[data.index(b"\xff\xda") :]
    assert saved.endswith(scan)
    assert saved.count(b"Exif\0\0") == 1
    with Image.open(io.BytesIO(saved)) as opened:
        exif = opened.getexif()
        assert exif[ExifTags.Base.Make] == "Thermo"
        assert float(exif.get_ifd(EXIF)[ExifTags.Base.ExposureTime]) == pytest.approx(0.01)
        assert GPS in exif


@given(st.binary(max_size=200))
def test_whatever_a_camera_wrote_as_exif_the_image_gets_ours(junk):
    data = encoded(coloured(), "JPEG")
    bad = b"Exif\0\0" + junk
    data = data[:2] + b"\xff\xe1" + (len(bad) + 2).to_bytes(2, "big") + bad + data[2:]
    saved = with_metadata(image("jpeg", data), FACTS, "m", "husky")
    with Image.open(io.BytesIO(saved)) as opened:
        opened.load()
        assert opened.getexif().get_ifd(GPS)[ExifTags.GPS.GPSLatitudeRef] == "N"


def test_a_png_that_has_exif_gets_ours_in_its_place():
    before = Image.Exif()
    before[ExifTags.Base.ImageDescription] = "another"
    saved = with_metadata(image("png", encoded(coloured(), "PNG", exif=before)), FACTS, "m", "husky")
    assert saved.count(b"eXIf") == 1
    with Image.open(io.BytesIO(saved)) as opened:
        opened.load()
        assert json.loads(opened.getexif()[ExifTags.Base.ImageDescription])["mission"] == "m"


def test_without_time_and_heading_they_are_left_out():
    saved = with_metadata(image(), replace(FACTS, taken_s=None, heading_deg=None), "m\u202e", "husky")
    with Image.open(io.BytesIO(saved)) as opened:
        exif = opened.getexif()
        gps = exif.get_ifd(GPS)
    assert ExifTags.GPS.GPSImgDirection not in gps
    assert ExifTags.GPS.GPSDateStamp not in gps
    assert ExifTags.Base.DateTime not in exif
    assert json.loads(exif[ExifTags.Base.ImageDescription])["mission"] == "m\\u{202e}"


def test_a_file_is_named_by_numbers_and_node_and_hashed(tmp_path):
    folder = ImageFolder(mission_folder=tmp_path, mission="m", robot="husky", least_free=0)
    saved = folder.save(image(), FACTS)
    assert saved.file == "images/00012-n4-rgb.png"
    data = (tmp_path / saved.file).read_bytes()
    assert (saved.sha256, saved.bytes) == (hashlib.sha256(data).hexdigest(), len(data))
    odd = folder.save(image(), replace(FACTS, node="../../etc", number=13))
    assert odd.file == "images/00013-rgb.png"
    assert sorted(path.name for path in (tmp_path / "images").iterdir()) == ["00012-n4-rgb.png", "00013-rgb.png"]


def test_no_image_takes_the_space_of_the_journal(tmp_path):
    folder = ImageFolder(mission_folder=tmp_path, free=lambda _: 400_000_000)
    saved = folder.save(image(), FACTS)
    assert (saved.file, saved.what) == ("", "images are not saved: less than 500 MB are free on the disk")
    assert not list((tmp_path / "images").iterdir())


def test_a_disk_that_fails_loses_the_image_and_says_so(tmp_path):
    (tmp_path / "images").write_text("in the way")
    saved = ImageFolder(mission_folder=tmp_path, least_free=0).save(image(), FACTS)
    assert saved.file == ""
    assert saved.what.startswith("images are not saved: ")
    assert save_image(None, image(), FACTS).what == "images are not saved: the mission has no folder"


def test_an_event_names_its_images(tmp_path):
    saved = ImageFolder(mission_folder=tmp_path, least_free=0).save(image(), FACTS)
    event = Acted(
        t=1.0, node="n4", action="take_picture", status="success", kind="tree", place="12", lat=1.0, lon=2.0,
        images=(saved,),
    )  # fmt: skip
    assert from_json(to_json(event)) == event
    assert '"images":' in to_json(event)


@pytest.mark.parametrize(
    ("side", "direction"), [("left", 353.25), ("right", 173.25), ("front", 83.25), ("back", 263.25)]
)
def test_the_direction_of_an_image_is_that_of_its_camera(tmp_path, side, direction):
    robot = husky()
    seen = replace(robot.action["take_thermal_picture"], camera=Camera(side=side))
    robot = replace(robot, actions=tuple(seen if a.name == seen.name else a for a in robot.actions))
    folder = replace(ImageFolder.of(tmp_path, "m", robot), least_free=0)
    for number, (action, expected) in enumerate([("take_thermal_picture", direction), ("read_co2", 83.25)]):
        saved = folder.save(image(), replace(FACTS, action=action, number=number))
        with Image.open(tmp_path / saved.file) as opened:
            assert float(opened.getexif().get_ifd(GPS)[ExifTags.GPS.GPSImgDirection]) == pytest.approx(expected)


@given(st.sampled_from(["left", "right", "front", "back"]), st.floats(0, 359.9), st.floats(0, 359.9))
def test_a_camera_that_is_turned_to_a_plant_has_it_in_the_middle(side, heading, bearing):
    camera = Camera(side=side)
    assert apart_deg(camera.bearing_at(camera.heading_towards(bearing)), bearing) == pytest.approx(0.0, abs=1e-9)
    assert apart_deg(camera.bearing_at(heading), bearing) == pytest.approx(camera.off_deg(heading, bearing), abs=1e-9)


def test_a_heading_that_is_reported_or_commanded_counts_before_the_last_metres():
    course, at = Course(), Position(x=0.0, y=0.0, lat=0.0, lon=0.0)
    course.add(at)
    course.add(replace(at, y=2.0))
    assert course.heading_deg == pytest.approx(0.0)
    course.add(replace(at, y=2.0, heading_deg=120.0))
    assert course.heading_deg == 120.0
    course.turned(240.0, replace(at, y=2.0))
    course.turned(None, replace(at, y=2.0))
    course.add(replace(at, y=2.1))
    assert course.heading_deg == 240.0
    course.add(replace(at, x=2.0, y=2.0))
    assert course.heading_deg == pytest.approx(90.0)


def test_the_heading_is_that_of_the_last_metres():
    course = Course()
    for x, y in ((0.0, 0.0), (0.1, 0.0), (3.0, 0.0), (3.0, 0.2), (3.0, -2.0)):
        course.add(Position(x=x, y=y, lat=0.0, lon=0.0))
    assert course.heading_deg == pytest.approx(180.0)
    course.add(Position(x=3.1, y=-2.0, lat=0.0, lon=0.0))
    assert course.heading_deg == pytest.approx(180.0)
