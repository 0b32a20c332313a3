"""A mission with a camera over DDS: its images are saved, referenced and shown, whatever is killed."""

from __future__ import annotations

import csv
import hashlib
import json
import math
from datetime import datetime
from pathlib import Path
from typing import Any

import pytest
import yaml
from PIL import ExifTags, Image

from fieldhand import mission, missions
from fieldhand.approval.authorize import EveryWarning
from fieldhand.compatibility import UTC
from fieldhand.execution.guard import NoGuard
from fieldhand.execution.images.folder import ImageFolder
from fieldhand.execution.journal import store
from fieldhand.execution.mission_runner import run
from fieldhand.planning.english.planner import EnglishPlanner
from fieldhand.planning.planner import Planned
from fieldhand.robot.loader import load_robot, profile_bytes
from fieldhand.site.bearings import apart_deg
from fieldhand.site.loader import open_site
from fieldhand.site.model import Site
from fieldhand.task.results import Acted, Event, ImageLost
from ros2.robot_in_process import connected_simulated_robot
from ros2.sim_robots import patient, sim_robot
from support.processes.command import fieldhand, in_background
from support.processes.patience import until

pytest.importorskip("cyclonedds")

FAST = "50"
TREES = ("5", "6", "9")
REQUEST = f"Take a thermal picture at trees {', '.join(TREES[:-1])} and {TREES[-1]}."


@pytest.fixture(autouse=True)
def _no_disk(monkeypatch: pytest.MonkeyPatch) -> None:
    monkeypatch.setattr(store, "SYNCHRONOUS", "OFF")


def with_cameras(folder: Path) -> str:
    """Write the profile of a husky with two cameras on its left: one on a topic, one that publishes JPEGs."""
    path = patient(folder)
    robot: dict[str, Any] = yaml.safe_load(path.read_text())
    robot["turn_deg_s"] = 45
    robot["actions"]["take_thermal_picture"]["camera"] = {"side": "left"}
    robot["ros2"]["actions"]["take_thermal_picture"]["images"] = {
        "rgb": {"topic": "camera/image_raw", "within_s": 600},
        "thermal": {
            "topic": "thermal_camera/image/compressed",
            "type": "sensor_msgs/msg/CompressedImage",
            "within_s": 600,
        },
    }
    path.write_text(yaml.safe_dump(robot, sort_keys=False))
    return str(path)


def captures(under: Path) -> list[Acted]:
    folders = [folder for folder in under.glob("*") if missions.exists(folder)]
    events: list[Event] = [event for folder in folders for event in missions.events_of(folder)]
    return [event for event in events if isinstance(event, Acted) and event.status == "success"]


def degrees(parts: Any) -> float:
    return float(parts[0]) + float(parts[1]) / 60 + float(parts[2]) / 3600


def test_images_are_saved_and_referenced(tmp_path: Path) -> None:
    """Killed after the first capture, and resumed."""
    under, husky, out = tmp_path / "m", with_cameras(tmp_path), tmp_path / "out"
    with sim_robot(tmp_path, "--site", "demo", "--robot", husky, "--speed", FAST) as robot:
        words = ("run", REQUEST, "--site", "demo", "--robot", husky, "--yes", "--confirm", "--missions", str(under))
        with in_background(*words, *robot.reached, out=tmp_path / "run.txt"):
            until(lambda: len(captures(under)) >= 1)
        (folder,) = under.iterdir()
        until(lambda: not missions.is_running(folder))
        done = fieldhand(
            "resume", "--missions", str(under), "-o", str(out), "--mcap", str(tmp_path / "log.mcap"), "--json"
        )
        assert done.status == 0, done.err
    made = captures(under)
    assert {event.place for event in made} == set(TREES)
    site = open_site("demo")
    for event in made:
        assert [image.name for image in event.images] == ["rgb", "thermal"]
        for image in event.images:
            data = (folder / image.file).read_bytes()
            assert hashlib.sha256(data).hexdigest() == image.sha256
            with Image.open(folder / image.file) as opened:
                opened.load()
                assert (opened.format, opened.size) == ("PNG" if image.name == "rgb" else "JPEG", (160, 120))
                exif = opened.getexif()
            gps = exif.get_ifd(0x8825)
            tree = site.by_id[event.place].place
            assert degrees(gps[ExifTags.GPS.GPSLatitude]) == pytest.approx(tree.lat, abs=3e-5)
            assert event.heading_deg is not None
            looks = float(gps[ExifTags.GPS.GPSImgDirection])
            assert apart_deg(looks, event.heading_deg - 90.0) < 2.0
            assert apart_deg(looks, _bearing(site, event)) <= 30.0  # the tree is in view
            about = json.loads(exif[ExifTags.Base.ImageDescription])
            assert (about["node"], about["place"]["id"], about["image"]) == (event.node, event.place, image.name)
    files = [image.file for event in made for image in event.images]
    assert len(set(files)) == len(files) == 2 * len(TREES)
    _is_shown(out, files)
    _is_exported(tmp_path / "log.mcap", files)
    _is_missed(under, folder, tmp_path / "again", files)


def _bearing(site: Site, event: Acted) -> float:
    """Return the bearing of the tree from the robot at a capture."""
    x, y = site.projection.metres(event.robot_lat, event.robot_lon)[0]
    tree = site.by_id[event.place].place
    return math.degrees(math.atan2(tree.x - x, tree.y - y)) % 360.0


def _is_shown(out: Path, files: list[str]) -> None:
    """The report has thumbnails and its own copies, and the tables name them."""
    page = (out / "report.html").read_text()
    assert page.count('src="data:image/jpeg;base64,') == len(files)
    assert all(name in page and (out / name).exists() for name in files)
    rows = list(csv.DictReader((out / "observations.csv").read_text().splitlines()))
    assert [row["images"] for row in rows if row["status"] == "success"] == [
        " ".join(files[k : k + 2]) for k in range(0, len(files), 2)
    ]
    features = json.loads((out / "observations.geojson").read_text())["features"]
    assert [name for feature in features for name in feature["properties"].get("images", [])] == files


def _is_exported(log: Path, files: list[str]) -> None:
    from mcap.reader import make_reader

    with log.open("rb") as file:
        found = [
            (channel.topic, schema.name if schema else "", json.loads(message.data)["format"])
            for schema, channel, message in make_reader(file).iter_messages()
            if channel.topic.startswith("/images/")
        ]
    assert len(found) == len(files)
    assert set(found) == {
        ("/images/rgb", "foxglove.CompressedImage", "png"),
        ("/images/thermal", "foxglove.CompressedImage", "jpeg"),
    }


def _is_missed(under: Path, folder: Path, out: Path, files: list[str]) -> None:
    """A file that was changed or removed is said to be."""
    (folder / files[0]).unlink()
    (folder / files[1]).write_bytes(b"another")
    fieldhand("report", "--missions", str(under), "-o", str(out))
    page = (out / "report.html").read_text()
    assert "the file is missing" in page
    assert "the file was changed since it was saved" in page
    assert not (out / files[1]).exists()


def test_each_camera_is_checked(tmp_path: Path) -> None:
    husky = with_cameras(tmp_path)
    with sim_robot(tmp_path, "--site", "demo", "--robot", husky, "--speed", FAST) as robot:
        there = fieldhand("robot", "check", husky, "--live", *robot.reached[:-1])
        assert there.status == 0, there.out + there.err
    assert there.out.count("160 x 120 pixels") == 2
    assert "rgb8" in there.out


def test_images_of_a_call_and_of_an_action_without_readings(tmp_path: Path) -> None:
    """The image is in the response of a service."""
    robot: dict[str, Any] = yaml.safe_load(profile_bytes("husky")[0])
    robot["energy"]["idle_w"] = 0
    robot["actions"]["look"] = {
        "description": "Look at the tree",
        "words": ["portrait"],
        "duration_s": 1,
        "energy_j": 1,
    }
    ros2 = robot["ros2"]
    ros2["navigation"] |= {"accept_s": 600, "quiet_s": 600, "slower": 100, "extra_s": 3600}
    for topic in ("position", "battery", "odometry", "stop"):
        ros2[topic]["stale_s"] = 600
    ros2["actions"]["look"] = {
        "service": {
            "name": "camera/look",
            "type": "scout/srv/Look",
            "success": "success",
            "images": {"front": "image"},
            "within_s": 600,
        }
    }
    ros2["interfaces"]["scout/srv/Look"] = "---\nbool success\nsensor_msgs/CompressedImage image\n"
    husky = tmp_path / "husky.yaml"
    husky.write_text(yaml.safe_dump(robot, sort_keys=False))
    under = tmp_path / "m"
    words = ("run", "Take a portrait of tree 5.", "--site", "demo", "--robot", str(husky), "--yes", "--confirm")
    with sim_robot(tmp_path, "--site", "demo", "--robot", str(husky), "--speed", FAST) as there:
        done = fieldhand(*words, "--missions", str(under), *there.reached, "--json")
        assert done.status == 0, done.err
    (event,) = captures(under)
    (image,) = event.images
    assert image.file.endswith("-front.jpg")
    (folder,) = under.iterdir()
    assert (folder / image.file).exists()


@pytest.mark.parametrize("measures", [True, False])
def test_a_full_disk_loses_images_and_keeps_readings(tmp_path: Path, measures: bool) -> None:
    """A capture of nothing but images fails without them, and says why."""
    path = Path(with_cameras(tmp_path))
    robot: dict[str, Any] = yaml.safe_load(path.read_text())
    request = "Take a thermal picture of tree 5."
    if not measures:
        robot["actions"]["look"] = {"description": "Look", "words": ["portrait"], "duration_s": 1, "energy_j": 1}
        robot["ros2"]["actions"]["look"] = {"images": {"rgb": {"topic": "camera/image_raw", "within_s": 600}}}
        request = "Take a portrait of tree 5."
    path.write_text(yaml.safe_dump(robot, sort_keys=False))
    site, husky = open_site("demo"), load_robot(str(path))
    planned = mission.plan(request, site, husky, EnglishPlanner())
    assert isinstance(planned, Planned), planned
    review = mission.review(planned.task, site, husky)
    approved = mission.authorize(review, by="x", at=datetime(2026, 1, 1, tzinfo=UTC), confirmed=EveryWarning())
    with connected_simulated_robot("demo", str(path), planned.task, seed=0, tick_s=0.5) as (vehicle, _):
        result = run(
            approved.authorized,
            site=site,
            robot=husky,
            driver=vehicle.driver,
            guard=NoGuard(),
            clock=vehicle.clock,
            emit=lambda _: None,
            images=ImageFolder(mission_folder=tmp_path, least_free=10**18),
        )
    tried = [event for event in result.events if isinstance(event, Acted)]
    (lost,) = (event for event in result.events if isinstance(event, ImageLost))
    assert "MB are free on the disk" in lost.what
    assert all(image.file == "" and image.what == lost.what for event in tried for image in event.images)
    if measures:
        assert [event.status for event in tried] == ["success"]
        assert tried[0].readings
    else:
        assert [event.status for event in tried] == ["failed", "failed"]
        assert tried[0].what == lost.what
    assert not list((tmp_path / "images").iterdir())
