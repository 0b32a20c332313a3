"""A mission drawn again: where the robot was, a page that stands alone, an animation."""

from __future__ import annotations

import json
import re
from dataclasses import replace
from html.parser import HTMLParser
from pathlib import Path

import matplotlib.animation
import numpy as np
import pytest
from PIL import Image

from fieldhand.errors import InputError, OutputError
from fieldhand.exchange.replay import film_of, page_of, save_animation
from fieldhand.exchange.routes.route import driven
from fieldhand.site.loader import load_demo
from fieldhand.task.results import Acted, Arrived, Driving, Ended, Started
from support.missions.exported import flight


def test_the_robot_is_where_the_log_says_when_it_says_so() -> None:
    site, events = load_demo(), flight().events
    film = film_of(events, site)
    for event in events:
        if isinstance(event, Arrived):
            assert film.at(event.t) == pytest.approx(tuple(site.projection.metres(event.lat, event.lon)[0]), abs=1e-6)
            assert film.charge_at(event.t) == pytest.approx(event.charge_percent)
    assert (np.diff(film.track[:, 0]) >= 0).all()
    drive = next(e for e in events if isinstance(e, Driving) and len(e.path) > 2)
    arrived = next(e for e in events if isinstance(e, Arrived) and e.t > drive.t)
    way = site.projection.metres(*np.array(drive.path).T)
    half = film.until((drive.t + arrived.t) / 2)[-1]
    gaps = np.hypot(*(way - half).T)
    assert gaps.min() < np.hypot(*np.diff(way, axis=0).T).max()
    assert len(film.captures) == sum(isinstance(e, Acted) for e in events)


def test_a_log_that_was_cut_off_is_shown_as_far_as_it_goes() -> None:
    events = flight().events
    film = film_of(events[: len(events) // 2], load_demo())
    assert film.title.endswith("cut off")
    assert film.seconds <= events[len(events) // 2].t


def test_a_clock_that_was_set_back_stands_still() -> None:
    events = [replace(e, t=min(e.t, 50.0) if k % 2 else e.t) for k, e in enumerate(flight().events)]
    assert (np.diff(film_of(events, load_demo()).track[:, 0]) >= 0).all()


def test_a_log_without_places_or_of_another_site_is_refused() -> None:
    site = load_demo()
    with pytest.raises(InputError, match="where the robot was"):
        film_of([e for e in flight().events if not isinstance(e, Started | Arrived | Ended)], site)
    with pytest.raises(InputError, match="another site"):
        film_of([replace(e, lat=-33.0) if isinstance(e, Arrived) else e for e in flight().events], site)


class _Page(HTMLParser):
    """The elements and texts of a page."""

    def __init__(self, text: str) -> None:
        super().__init__()
        self.tags: list[tuple[str, dict[str, str | None]]] = []
        self.scripts: list[str] = []
        self._in_script = False
        self.feed(text)

    def handle_starttag(self, tag: str, attrs: list[tuple[str, str | None]]) -> None:
        self.tags.append((tag, dict(attrs)))
        self._in_script = tag == "script"

    def handle_endtag(self, tag: str) -> None:
        self._in_script = False

    def handle_data(self, data: str) -> None:
        if self._in_script:
            self.scripts.append(data)


def test_the_page_stands_alone_and_whatever_a_log_holds_stays_text() -> None:
    evil = "</script><script>alert(1)</script><img src=x onerror=alert(2)>@@script@@<!--"
    events = [
        replace(e, robot=evil) if isinstance(e, Started) else replace(e, place=evil) if isinstance(e, Acted) else e
        for e in flight().events
    ]
    plain = _Page(page_of(film_of(flight().events, load_demo()), load_demo()).decode())
    text = page_of(film_of(events, load_demo(), tell=lambda _: evil), load_demo()).decode()
    page = _Page(text)
    assert [tag for tag, _ in page.tags] == [tag for tag, _ in plain.tags]
    assert len(page.scripts) == 2
    data = json.loads(page.scripts[0])
    assert data["captures"][0]["place"] == evil
    assert data["lines"][0][1] == evil
    assert not [a for _, attrs in page.tags for a in attrs if a in ("src", "href") or a.startswith("on")]
    assert not re.search(r"https?://|innerHTML|document\.write|eval\(|fetch\(|import\(", text)
    policy = next(attrs["content"] for tag, attrs in page.tags if attrs.get("http-equiv") == "Content-Security-Policy")
    assert policy is not None
    assert policy.startswith("default-src 'none'")
    assert len(text) < 60_000


def test_the_animation_moves_and_ends_where_the_mission_did(tmp_path: Path) -> None:
    film = film_of(flight().events, load_demo())
    save_animation(film, load_demo(), tmp_path / "deep" / "m.gif", seconds=0.5)
    with Image.open(tmp_path / "deep" / "m.gif") as picture:
        assert picture.n_frames >= 4
        frames = []
        for k in (0, picture.n_frames - 1):
            picture.seek(k)
            frames.append(np.asarray(picture.convert("RGB"), dtype=float))
    assert np.abs(frames[0] - frames[1]).max() > 100


def test_what_cannot_be_written_is_said(tmp_path: Path, monkeypatch: pytest.MonkeyPatch) -> None:
    film = film_of(flight().events, load_demo())
    monkeypatch.setattr(matplotlib.animation.FFMpegWriter, "isAvailable", classmethod(lambda cls: False))
    with pytest.raises(OutputError, match="ffmpeg, which is not installed"):
        save_animation(film, load_demo(), tmp_path / "m.mp4")
    (tmp_path / "file").write_text("")
    with pytest.raises(OutputError, match="cannot be written"):
        save_animation(film, load_demo(), tmp_path / "file" / "m.gif", seconds=0.5)


def test_a_drive_that_was_broken_off_is_drawn_as_far_as_it_went() -> None:
    site, events = load_demo(), flight().events
    k = next(k for k, e in enumerate(events) if isinstance(e, Driving) and len(e.path) > 2)
    drive = events[k]
    assert isinstance(drive, Driving)
    (lat, lon), (lat1, lon1) = drive.path[:2]
    middle = ((lat + lat1) / 2, (lon + lon1) / 2)
    # The robot was to go the whole way, was stopped in the middle of its first part, and went on from there.
    on = replace(drive, t=(drive.t + events[k + 1].t) / 2, path=(middle, *drive.path[1:]))
    broken = (*events[: k + 1], on, *events[k + 1 :])
    whole, cut = film_of(events, site), film_of(broken, site)
    gaps = [np.hypot(*(cut.track[:, 1:] - at).T).min() for at in whole.track[:, 1:]]
    assert max(gaps) < 0.01
    length = [float(np.hypot(*np.diff(film.track[:, 1:], axis=0).T).sum()) for film in (whole, cut)]
    assert length[0] == pytest.approx(length[1], abs=0.01)
    # Routes take the same ways.
    ways = [[at for stop in driven(log).stops for at in stop.way] for log in (events, broken)]
    assert set(ways[0]) <= set(ways[1])
    assert len(ways[1]) <= len(ways[0]) + 3
    # A mission that ends on the way ends the drive there.
    ended = next(e for e in events if isinstance(e, Ended))
    stopped = film_of((*events[: k + 1], replace(ended, t=on.t, lat=middle[0], lon=middle[1])), site)
    assert stopped.track[-1, 1:] == pytest.approx(site.projection.metres(*middle)[0], abs=0.01)
    assert any(np.hypot(*(at - site.projection.metres(lat, lon)[0])) < 0.01 for at in stopped.track[:, 1:])
