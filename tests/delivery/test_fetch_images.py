"""Images of a mission fetched from its robot: each is the one that the log names, or is said not to be."""

from __future__ import annotations

import hashlib
from pathlib import Path

import httpx
import pytest

from fieldhand.delivery.bundle_checks import sha256_of
from fieldhand.delivery.fetch_images import ImageFetcher, fetch_images, images_in
from fieldhand.errors import DeliveryError, OutputError, UnreachableError
from fieldhand.task.event_lines import to_json
from fieldhand.task.results import Acted, ImageFile
from support.missions.signed import good
from support.processes.robot_agents import RobotAgentInProcess

CONTENTS = {"00001-n1-rgb.png": b"one", "00002-n1-rgb.jpg": b"two", "00003-rgb.tif": b"three"}


def image(name: str, data: bytes) -> ImageFile:
    return ImageFile(name="rgb", file=f"images/{name}", sha256=hashlib.sha256(data).hexdigest(), bytes=len(data))


def line(*images: ImageFile) -> str:
    event = Acted(
        t=1.0, node="n1", action="take_picture", status="success", kind="tree", place="1", lat=1.0, lon=2.0,
        images=images,
    )  # fmt: skip
    return to_json(event)


@pytest.fixture
def robot_agent(tmp_path: Path) -> RobotAgentInProcess:
    """A robot that has received a mission, in whose folder there are images."""
    agent = RobotAgentInProcess(tmp_path)
    assert agent.upload(good()).status_code == 201
    received = agent.mission_store.find(sha256_of(good()))
    assert received is not None
    images = agent.mission_store.folder_of(received) / "images"
    images.mkdir(parents=True)
    for name, data in CONTENTS.items():
        (images / name).write_bytes(data)
    return agent


def test_images_are_fetched_once_and_held_against_the_log(robot_agent: RobotAgentInProcess, tmp_path: Path) -> None:
    bundle, out = sha256_of(good()), tmp_path / "out"
    named = images_in([line(*(image(name, data) for name, data in CONTENTS.items())), "no line", '{"event":"future"}'])
    assert len(named) == 3
    fetched = fetch_images(robot_agent.link(), bundle, named, out)
    assert (fetched.count, fetched.problems) == (3, ())
    assert {path.name: path.read_bytes() for path in (out / "images").iterdir()} == CONTENTS
    asked: list[str] = []
    again = robot_agent.link(lambda request: asked.append(str(request.url)) or "")  # type: ignore[func-returns-value]
    assert fetch_images(again, bundle, named, out).count == 3
    assert asked == []


def test_what_is_missing_or_changed_is_said(robot_agent: RobotAgentInProcess, tmp_path: Path) -> None:
    named = [image("00001-n1-rgb.png", b"other"), image("00009-n1-rgb.png", b"x"), image("00002-n1-rgb.jpg", b"two")]
    fetched = fetch_images(robot_agent.link(), sha256_of(good()), named, tmp_path / "out")
    assert fetched.count == 1
    assert fetched.problems == (
        "images/00001-n1-rgb.png: the file was changed since it was saved",
        "images/00009-n1-rgb.png: there is no such image",
    )
    assert [path.name for path in (tmp_path / "out" / "images").iterdir()] == ["00002-n1-rgb.jpg"]


def test_images_are_fetched_as_events_arrive_and_what_was_prevented_at_the_end(
    robot_agent: RobotAgentInProcess, tmp_path: Path
) -> None:
    bundle, out, lost = sha256_of(good()), tmp_path / "out", [False]

    def lose(request: httpx.Request) -> str:
        return "request" if lost[0] else ""

    fetcher = ImageFetcher(robot_agent.link(lose), bundle, out)
    there = []
    for number, (name, data) in enumerate(CONTENTS.items()):
        lost[0] = number == 1
        fetcher.take(line(image(name, data)))
        there.append((out / "images" / name).exists())
    assert there == [True, False, True]
    fetcher.take("no line")
    fetched = fetcher.finish()
    assert (fetched.count, fetched.problems) == (3, ())
    assert {path.name: path.read_bytes() for path in (out / "images").iterdir()} == CONTENTS
    lost[0] = True
    missing = ImageFetcher(robot_agent.link(lose), bundle, tmp_path / "another")
    missing.take(line(image("00001-n1-rgb.png", b"one")))
    with pytest.raises(UnreachableError):
        missing.finish()


@pytest.mark.parametrize("name", ["../../secret", "images/../../x.png", "/etc/passwd", "images/a/b.png", "images/.png"])
def test_no_log_names_a_file_elsewhere(name: str) -> None:
    assert images_in([line(ImageFile(name="rgb", file=name, sha256="0" * 64))]) == ()


@pytest.mark.parametrize("path", ["..%2F..%2Fmission.json", "journal.sqlite", "a.png%00", "%20.png"])
def test_a_robot_gives_nothing_but_images(path: str, robot_agent: RobotAgentInProcess) -> None:
    answer = robot_agent.call("GET", f"/agent/missions/{sha256_of(good())}/images/{path}")
    assert answer.status_code in (400, 404, 405, 422)


def test_what_cannot_be_read_or_written_is_an_error(robot_agent: RobotAgentInProcess, tmp_path: Path) -> None:
    with pytest.raises(DeliveryError):
        robot_agent.link().image(sha256_of(good()), "00009-rgb.png")
    blocked = tmp_path / "file"
    blocked.write_text("in the way")
    with pytest.raises(OutputError):
        fetch_images(robot_agent.link(), sha256_of(good()), [image("00003-rgb.tif", b"three")], blocked)
