"""Write events into an MCAP file as they happen, with what the panels of Foxglove and Lichtblick show.

| topic | schema | |
|---|---|---|
| /mission/EVENT | fieldhand.* | every event, as the event log has it |
| /location | foxglove.LocationFix | where the robot is: at each place, and along each drive between |
| /way | foxglove.GeoJSON | the way of the drive that has begun |
| /captures | foxglove.GeoJSON | all captures so far, with their readings; those in doubt, too |
| /blocked | foxglove.GeoJSON | what the robot keeps off because something stood there |
| /site | foxglove.GeoJSON | trees, markers and zones, if the site is given |
| /log | foxglove.Log | what happened, in words |
| /images/NAME | foxglove.CompressedImage | the images of captures, JPEG and PNG; others are attachments |
| /state | fieldhand.State | charge, metres and the last reading of each quantity, for plots |
"""

from __future__ import annotations

import base64
import math
from collections.abc import Callable, Iterator
from dataclasses import dataclass
from pathlib import Path
from types import TracebackType
from typing import IO, TYPE_CHECKING, Any

import numpy as np

from fieldhand.compatibility import datetime_from_iso
from fieldhand.errors import OutputError
from fieldhand.exchange.broken_off import driven_part
from fieldhand.exchange.incidents import known, position_of
from fieldhand.exchange.mcap.images import image_data
from fieldhand.exchange.mcap.schemas import EVENTS, GEOJSON, IMAGE, LOCATION, LOG, STATE, schema_of
from fieldhand.files import open_output
from fieldhand.hidden_characters import visible_json
from fieldhand.task.event_lines import to_json
from fieldhand.task.results import (
    Acted,
    Arrived,
    ClockSet,
    Driving,
    Ended,
    Event,
    Exited,
    Faulted,
    ImageLost,
    InDoubt,
    LimitCrossed,
    Obstructed,
    Resumed,
    Shed,
    Started,
    Strayed,
    Waited,
    Worked,
    Working,
)

if TYPE_CHECKING:
    from mcap.writer import Writer

    from fieldhand.site.model import Site

#: Levels of foxglove.Log.
_INFO, _WARNING, _ERROR = 2, 3, 4
#: Events that are logged as warnings.
_DOUBTFUL = InDoubt | ImageLost | Resumed | Obstructed | Strayed | Waited | LimitCrossed | ClockSet
#: Interval between positions along a drive, in seconds.
_EVERY_S = 1.0
#: Maximum number of positions along one drive.
_MOST = 2_000
#: Chunk size in bytes, small to limit the loss if a mission is interrupted.
_CHUNK = 65_536


@dataclass(frozen=True, kw_only=True)
class _Message:
    """A message of one topic."""

    topic: str
    schema: dict[str, Any]
    t: float
    data: bytes
    sequence: int = 0


class McapLog:
    """Writer of events as they occur.

    Args:
        path: Output file, replaced if it exists; its folder is created.
        began_s: Start of the mission in seconds since 1970, to which event times are relative; None for the time in the
            first event.
        tell: Returns the description of an event, or None if it needs no log line.
        site: Site to draw on the map, or None.
        images: Folder of the mission with its images, also set later as :attr:`images`; None to write none.

    Raises:
        OutputError: The file cannot be written, now or later (such as on a full disk).
    """

    def __init__(
        self,
        path: Path,
        *,
        began_s: float | None = None,
        tell: Callable[[Event], str | None] = lambda _: None,
        site: Site | None = None,
        images: Path | None = None,
    ) -> None:
        from mcap.writer import Writer

        self.images = images

        self._path, self._began, self._tell, self._site = path, began_s, tell, site
        self._channels: dict[str, int] = {}
        self._count = 0
        self._captures: list[Acted | InDoubt] = []
        self._next_shown = 1
        self._drive: Driving | Working | None = None
        self._state: dict[str, Any] = {"charge_percent": 100.0, "travelled_m": 0.0, "readings": {}}
        try:
            self._file: IO[bytes] = open_output(path, "wb")
            self._writer: Writer = Writer(self._file, chunk_size=_CHUNK)
            self._writer.start(profile="", library="fieldhand")
        except (OSError, ValueError) as error:
            raise self._unwritable(error) from None

    def __call__(self, event: Event) -> None:
        """Write one event."""
        try:
            for message in self._messages(event):
                self._write(message)
            self._file.flush()
        except (OSError, ValueError) as error:
            raise self._unwritable(error) from None

    def close(self) -> None:
        """Write the index and close the file.

        Raises:
            OutputError: It cannot be written.
        """
        try:
            with self._file:
                self._writer.finish()  # type: ignore[no-untyped-call]  # the library forgot
        except (OSError, ValueError) as error:
            raise self._unwritable(error) from None

    def __enter__(self) -> McapLog:
        return self

    def __exit__(
        self, kind: type[BaseException] | None, error: BaseException | None, trace: TracebackType | None
    ) -> None:
        self.close()

    # --- what is written ---------------------------------------------------------------------------------------

    def _messages(self, event: Event) -> Iterator[_Message]:
        """Return the messages of an event in order of time."""
        if isinstance(event, Started) and self._began is None:
            self._began = _seconds_of(event.at)
        if isinstance(event, Started) and self._site is not None:
            yield self._geojson("/site", event.t, _site_features(self._site))
        if isinstance(event, Arrived | Worked | Obstructed | Strayed | Resumed | Ended):
            yield from self._along(event, (event.lat, event.lon))
        self._count += 1
        topic, schema = EVENTS + event.event, schema_of(type(event))
        yield _Message(topic=topic, schema=schema, t=event.t, data=to_json(event).encode(), sequence=self._count)
        words = self._tell(event)
        if words is not None:
            yield self._log(event, words)
        match event:
            case Driving() | Working():
                self._drive = event
                line = {"type": "LineString", "coordinates": [[lon, lat] for lat, lon in event.path]}
                if len(event.path) > 1:
                    yield self._geojson("/way", event.t, [_feature(line, {"node": event.node, "to": _goal(event)})])
            case Obstructed():
                yield self._geojson("/blocked", event.t, _blocked_features(event))
            case Acted() | InDoubt():
                if isinstance(event, Acted):
                    yield from self._image_messages(event)
                self._captures.append(event)
                yield from self._shown(event.t)
            case Ended():
                yield from self._shown(event.t, last=True)
        at = position_of(event)
        if at is not None:
            yield self._location(event.t, *at)
        if self._note(event):
            yield _Message(topic="/state", schema=STATE, t=event.t, data=_json(self._state))

    def _image_messages(self, event: Acted) -> Iterator[_Message]:
        """Yield the images of a capture that panels show; add others, such as measured values, as attachments."""
        for image in event.images if self.images is not None else ():
            data = image_data(self.images, image)
            if data is None:
                continue
            if image.file.endswith(".tif"):
                at = self._nanoseconds(event.t)
                self._writer.add_attachment(at, at, image.file, "image/tiff", data)
                continue
            shown = {
                "timestamp": self._time(event.t),
                "frame_id": image.name,
                "format": "png" if image.file.endswith(".png") else "jpeg",
                "data": base64.b64encode(data).decode("ascii"),
            }
            yield _Message(topic=f"/images/{image.name}", schema=IMAGE, t=event.t, data=_json(shown))

    def _shown(self, t: float, *, last: bool = False) -> Iterator[_Message]:
        """Yield all captures so far: after each of the first ones, then per 10 % increase, and at the end."""
        if len(self._captures) >= self._next_shown or last:
            self._next_shown = len(self._captures) + max(1, len(self._captures) // 10)
            yield self._geojson("/captures", t, [_capture(e) for e in self._captures if known((e.lat, e.lon))])

    def _note(self, event: Event) -> bool:
        """Store the robot state in an event; return True if it contains any."""
        if isinstance(event, Started | Arrived | Acted | Worked | InDoubt | Resumed | Ended):
            self._state["charge_percent"] = event.charge_percent
        if isinstance(event, Arrived | Worked | Obstructed | Ended):
            self._state["travelled_m"] = event.travelled_m
        if isinstance(event, Acted):
            self._state["readings"] |= {q: v for q, v in event.readings.items() if math.isfinite(v)}
        return isinstance(event, Started | Arrived | Acted | Worked | InDoubt | Obstructed | Resumed | Ended)

    def _along(self, event: Event, at: tuple[float, float]) -> Iterator[_Message]:
        """Return positions along a drive to its end or interruption, at constant speed."""
        drive, self._drive = self._drive, None
        until = event.t
        if (
            drive is None
            or len(drive.path) < 2
            or until - drive.t <= _EVERY_S
            or not all(map(known, (at, *drive.path)))
        ):
            return
        path = (
            drive.path
            if isinstance(event, Arrived) or getattr(event, "status", "") == "success"
            else driven_part(drive.path, at)
        )
        corners = np.asarray(path, dtype=np.float64)
        # A degree of longitude is shorter than one of latitude.
        alike = np.array([1.0, math.cos(math.radians(corners[0, 0]))])
        along = np.concatenate([[0.0], np.cumsum(np.hypot(*(np.diff(corners, axis=0) * alike).T))])
        count = min(_MOST, int((until - drive.t) / _EVERY_S))
        for part in np.linspace(0.0, 1.0, count + 1)[1:-1]:
            lat, lon = (float(np.interp(part * along[-1], along, corners[:, k])) for k in (0, 1))
            yield self._location(drive.t + float(part) * (until - drive.t), lat, lon)

    def _location(self, t: float, lat: float, lon: float) -> _Message:
        fix = {
            "timestamp": self._time(t),
            "frame_id": "robot",
            "latitude": lat,
            "longitude": lon,
            "altitude": 0.0,
            "position_covariance": [0.0] * 9,
            "position_covariance_type": 0,
        }
        return _Message(topic="/location", schema=LOCATION, t=t, data=_json(fix))

    def _log(self, event: Event, words: str) -> _Message:
        failed = (isinstance(event, Acted) and event.status == "failed") or isinstance(event, Shed | _DOUBTFUL)
        bad = isinstance(event, Faulted) and not event.handled
        bad = bad or (isinstance(event, Exited) and event.exit == "faulted")
        level = _ERROR if bad else _WARNING if failed or isinstance(event, Faulted) else _INFO
        line = {
            "timestamp": self._time(event.t),
            "level": level,
            "message": words.strip(),
            "name": event.node or "mission",
            "file": "",
            "line": 0,
        }
        return _Message(topic="/log", schema=LOG, t=event.t, data=_json(line))

    def _geojson(self, topic: str, t: float, features: list[dict[str, Any]]) -> _Message:
        text = visible_json({"type": "FeatureCollection", "features": features})
        return _Message(topic=topic, schema=GEOJSON, t=t, data=_json({"geojson": text}))

    def _write(self, message: _Message) -> None:
        channel = self._channels.get(message.topic)
        if channel is None:
            schema = self._writer.register_schema(message.schema["title"], "jsonschema", _json(message.schema))
            channel = self._writer.register_channel(message.topic, "json", schema)
            self._channels[message.topic] = channel
        at = self._nanoseconds(message.t)
        self._writer.add_message(channel, at, message.data, at, message.sequence)

    def _nanoseconds(self, t: float) -> int:
        """Return the time since 1970; times before the start, from a clock that was set back, become the start."""
        return max(0, round(((self._began or 0.0) + (t if math.isfinite(t) else 0.0)) * 1e9))

    def _time(self, t: float) -> dict[str, int]:
        sec, nsec = divmod(self._nanoseconds(t), 1_000_000_000)
        return {"sec": sec, "nsec": nsec}

    def _unwritable(self, error: Exception) -> OutputError:
        why = error.strerror if isinstance(error, OSError) and error.strerror else str(error)
        return OutputError(
            f"the MCAP file cannot be written: {why}",
            where=str(self._path),
            advice="give a file in a folder that you may write to",
        )


def _seconds_of(moment: str) -> float | None:
    """Return an ISO 8601 time in seconds since 1970, or None if it is invalid, as logs may be untrusted."""
    try:
        return datetime_from_iso(moment).timestamp()
    except (ValueError, OverflowError, OSError):
        return None


def _site_features(site: Site) -> list[dict[str, Any]]:
    """Return trees, markers and zones, with the colours that map panels read."""
    features = []
    for zone in site.zones:
        corners = site.projection.lat_lon(np.asarray(zone.polygon.exterior.coords)[:, :2])
        ring = [[round(lon, 8), round(lat, 8)] for lat, lon in corners]
        colour = {"boundary": "#8a7f66", "keep_out": "#4d7c99", "zone": "#c19a3f"}[zone.kind]
        style = {"stroke": colour, "fill": colour, "fill-opacity": 0.0 if zone.kind == "boundary" else 0.3}
        features.append(_feature({"type": "Polygon", "coordinates": [ring]}, {"name": zone.name, "style": style}))
    trees = [[t.place.lon, t.place.lat] for t in site.trees]
    features.append(_feature({"type": "MultiPoint", "coordinates": trees}, {"style": {"color": "#5b8c5a"}}))
    for name, place in site.markers.items():
        features.append(_feature({"type": "Point", "coordinates": [place.lon, place.lat]}, {"name": name}))
    return features


def _blocked_features(event: Obstructed) -> list[dict[str, Any]]:
    """Return all areas blocked from now on, with the robot's position."""
    style = {"stroke": "#b3261e", "fill": "#b3261e", "fill-opacity": 0.35}
    rings = [[[lon, lat] for lat, lon in area] for area in event.blocked if len(area) > 2]
    closed = [ring if ring[0] == ring[-1] else [*ring, ring[0]] for ring in rings]
    features = [_feature({"type": "Polygon", "coordinates": [ring]}, {"style": style}) for ring in closed]
    if known((event.lat, event.lon)):
        fields = {"place": event.place, "what": event.what, "unreachable": list(event.unreachable), "free": event.free}
        features.append(_feature({"type": "Point", "coordinates": [event.lon, event.lat]}, fields))
    return features


def _goal(event: Driving | Working) -> str:
    return event.place if isinstance(event, Driving) else event.stretch


def _capture(event: Acted | InDoubt) -> dict[str, Any]:
    readings = {q: v for q, v in event.readings.items() if math.isfinite(v)}
    colour = {"success": "#0072b2", "in_doubt": "#8a3b00"}.get(event.status, "#b3261e")
    properties = {"place": event.place, "action": event.action, "status": event.status, "style": {"color": colour}}
    return _feature({"type": "Point", "coordinates": [event.lon, event.lat]}, properties | readings)


def _feature(geometry: dict[str, Any], properties: dict[str, Any]) -> dict[str, Any]:
    return {"type": "Feature", "geometry": geometry, "properties": properties}


def _json(value: Any) -> bytes:
    # Panels show this text unchanged; programs that need the exact data read the events.
    return visible_json(value).encode()
