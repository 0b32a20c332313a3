"""Event logs as MCAP: they come back whole, panels find what they need, and a file of anyone's costs little."""

from __future__ import annotations

import contextlib
import json
import random
import struct
from dataclasses import replace
from pathlib import Path

import pytest
import zstandard
from hypothesis import HealthCheck, given, settings
from mcap.reader import make_reader
from mcap.writer import CompressionType, Writer

from fieldhand.errors import FieldhandError, InputError, OutputError, TaskError
from fieldhand.exchange.mcap import McapLog, is_mcap, read_mcap
from fieldhand.exchange.mcap.reading import MAGIC, MAX_RECORD
from fieldhand.task.event_lines import to_json
from fieldhand.task.results import Acted, Arrived, Event
from fieldhand.testing.generated.events import events as random_events
from support.missions.exported import flight


def written(path: Path, events: tuple[Event, ...], **more: object) -> Path:
    with McapLog(path, **more) as log:  # type: ignore[arg-type]
        for event in events:
            log(event)
    return path


@given(random_events)
@settings(deadline=None, max_examples=30, suppress_health_check=[HealthCheck.function_scoped_fixture])
def test_events_come_back_as_they_were(tmp_path: Path, events: tuple[Event, ...]) -> None:
    assert read_mcap(written(tmp_path / "log.mcap", events)) == events


def test_panels_find_what_their_schemas_require(tmp_path: Path) -> None:
    told = "something happened"
    file = written(tmp_path / "log.mcap", flight().events, site=flight().site, began_s=1.7e9, tell=lambda _: told)
    topics: dict[str, list[dict[str, object]]] = {}
    with file.open("rb") as stream:
        for schema, channel, message in make_reader(stream, validate_crcs=True).iter_messages():
            assert schema is not None
            assert (schema.encoding, channel.message_encoding) == ("jsonschema", "json")
            described, content = json.loads(schema.data), json.loads(message.data)
            assert described["title"] == schema.name
            assert set(described.get("required", ())) <= content.keys() <= described["properties"].keys()
            if "timestamp" in content:
                stamp = content["timestamp"]
                assert stamp["sec"] * 1_000_000_000 + stamp["nsec"] == message.log_time
            assert message.log_time >= 1.7e18
            topics.setdefault(f"{channel.topic} {schema.name}", []).append(content)
    arrived = [e for e in flight().events if isinstance(e, Arrived)]
    assert len(topics["/location foxglove.LocationFix"]) > 10 * len(arrived)
    fixes = [(f["latitude"], f["longitude"]) for f in topics["/location foxglove.LocationFix"]]
    assert all((e.lat, e.lon) in fixes for e in arrived)
    assert {line["message"] for line in topics["/log foxglove.Log"]} == {told}
    captures = json.loads(str(topics["/captures foxglove.GeoJSON"][-1]["geojson"]))
    assert len(captures["features"]) == 8
    assert "co2" in captures["features"][-1]["properties"]
    trees = json.loads(str(topics["/site foxglove.GeoJSON"][0]["geojson"]))
    assert {f["geometry"]["type"] for f in trees["features"]} == {"Polygon", "MultiPoint", "Point"}
    assert {t.split()[0] for t in topics} >= {
        "/mission/started",
        "/mission/arrive",
        "/mission/action",
        "/state",
        "/way",
    }


def test_a_file_that_was_cut_off_gives_what_it_holds(tmp_path: Path) -> None:
    events = flight().events * 12
    data = written(tmp_path / "log.mcap", events).read_bytes()
    (tmp_path / "cut.mcap").write_bytes(data[: len(data) // 2])
    found = read_mcap(tmp_path / "cut.mcap")
    assert 0 < len(found) < len(events)
    assert found == events[: len(found)]


def test_a_damaged_file_is_read_or_refused_and_nothing_else(tmp_path: Path) -> None:
    data = written(tmp_path / "log.mcap", flight().events).read_bytes()
    refused: list[str] = []
    for seed in range(150):
        rng, damaged = random.Random(seed), bytearray(data)
        for _ in range(rng.randint(1, 4)):
            damaged[rng.randrange(len(damaged))] = rng.randrange(256)
        (tmp_path / "bad.mcap").write_bytes(damaged[: rng.randrange(len(damaged))] if seed % 3 else damaged)
        try:
            read_mcap(tmp_path / "bad.mcap")
        except FieldhandError as error:
            refused.append(str(error))
    assert len(refused) > 30
    assert all("bad.mcap" in said for said in refused)


@pytest.mark.parametrize("claimed", [10**12, 2**63, 2**64 - 1])
def test_a_chunk_that_claims_more_than_the_file_has_costs_nothing(claimed: int, tmp_path: Path) -> None:
    body = struct.pack("<QQQII", 0, 0, 8, 0, 0) + struct.pack("<Q", claimed) + b"\0" * 8
    path = tmp_path / "bad.mcap"
    path.write_bytes(MAGIC + struct.pack("<BQ", 6, len(body)) + body)
    with contextlib.suppress(FieldhandError):
        assert read_mcap(path) == ()


def test_what_unpacks_to_more_than_it_says_is_refused(tmp_path: Path) -> None:
    def chunk(size: int, compression: str, content: bytes) -> bytes:
        body = struct.pack("<QQQI", 0, 0, size, 0) + struct.pack("<I", len(compression)) + compression.encode()
        body += struct.pack("<Q", len(content)) + content
        return struct.pack("<BQ", 6, len(body)) + body

    def text(words: str) -> bytes:
        return struct.pack("<I", len(words)) + words.encode()

    start = b"\x89MCAP0\r\n" + struct.pack("<BQ", 1, 8) + text("") + text("")
    bomb = zstandard.ZstdCompressor(level=1).compress(bytes(200_000_000))
    for size in (100, MAX_RECORD + 1, 2**62):
        (tmp_path / "bomb.mcap").write_bytes(start + chunk(size, "zstd", bomb))
        with pytest.raises(InputError, match="unpacks to"):
            read_mcap(tmp_path / "bomb.mcap")
    (tmp_path / "odd.mcap").write_bytes(start + chunk(3, "brotli", b"abc"))
    with pytest.raises(InputError, match="damaged"):
        read_mcap(tmp_path / "odd.mcap")


def test_a_file_of_another_program_is_read(tmp_path: Path) -> None:
    path = tmp_path / "other.mcap"
    with path.open("wb") as file:
        writer = Writer(file, compression=CompressionType.LZ4)
        writer.start()
        ours, other = (writer.register_channel(topic, "json", 0) for topic in ("/mission/started", "/camera"))
        writer.add_message(other, 5, b"\xff\xfe", 5)
        writer.add_message(ours, 9, to_json(flight().events[0]).encode(), 9)
        writer.finish()
    assert read_mcap(path) == flight().events[:1]


def test_a_mission_of_many_captures_stays_small(tmp_path: Path) -> None:
    capture = next(e for e in flight().events if isinstance(e, Acted))
    path = written(tmp_path / "many.mcap", tuple(replace(capture, t=float(t)) for t in range(2_000)))
    with path.open("rb") as stream:
        shown = [m for _, c, m in make_reader(stream).iter_messages(["/captures"]) if c.topic]
    assert len(shown) < 100
    assert path.stat().st_size < 2_000_000


def test_a_message_that_is_no_event_is_named(tmp_path: Path) -> None:
    path = tmp_path / "bad.mcap"
    for data in (b"\xff", b"{}", b'{"event": "arrive"}'):
        with path.open("wb") as file:
            writer = Writer(file)
            writer.start()
            writer.add_message(writer.register_channel("/mission/arrive", "json", 0), 1, data, 1, 7)
            writer.finish()
        with pytest.raises(TaskError, match="message 7 of /mission/arrive: not an event"):
            read_mcap(path)


def test_what_is_no_file_of_ours_is_said(tmp_path: Path) -> None:
    (tmp_path / "text.mcap").write_text("hello, I am text")
    assert not is_mcap(tmp_path / "text.mcap")
    assert not is_mcap(tmp_path)
    for name in ("text.mcap", "", "none.mcap"):
        with pytest.raises(InputError):
            read_mcap(tmp_path / name)
    with pytest.raises(OutputError, match="cannot be written"):
        McapLog(tmp_path)
