"""Files that somebody made to be taken for missions: each gets one plain refusal."""

from __future__ import annotations

import json
import os
import stat
import struct
import zipfile
from collections.abc import Callable
from datetime import timedelta
from pathlib import Path
from typing import Any

import pytest

from fieldhand.approval.bundle.container import MANIFEST, MAX_BYTES, ROBOT, SIGNATURE, TASK, read_bundle_file
from fieldhand.errors import BundleError, InputError, NotTrustedError, TaskError
from support.missions.signed import (
    NOW,
    archive_of,
    good,
    known,
    manifest_of,
    members_of,
    opened,
    orchard_files,
    signed_with,
)


def refused(data: bytes) -> str:
    """Return the message about it, on one line."""
    with pytest.raises(BundleError) as refusal:
        opened(data)
    assert "\n" not in str(refusal.value)
    return str(refusal.value)


def entries(**changes: bytes) -> list[tuple[zipfile.ZipInfo | str, bytes]]:
    return list((members_of(good()) | changes).items())


def info(name: str, mode: int = stat.S_IFREG | 0o644) -> zipfile.ZipInfo:
    made = zipfile.ZipInfo(name)
    made.external_attr = mode << 16
    return made


def twice(name: str) -> bytes:
    with pytest.warns(UserWarning, match="Duplicate"):
        return archive_of(*entries(), (name, members_of(good())[name]))


def encrypted() -> bytes:
    """The flags say so; the common library writes none."""
    data = bytearray(good())
    for magic, offset in ((b"PK\x03\x04", 6), (b"PK\x01\x02", 8)):
        at = -1
        while (at := data.find(magic, at + 1)) >= 0:
            data[at + offset] |= 1
    return bytes(data)


def lying(size: int) -> bytes:
    """Compressed zeros that say they are small, or large."""
    data = bytearray(archive_of(*entries(**{"site.geojson": bytes(20_000_000)}), method=zipfile.ZIP_DEFLATED))
    at = data.rfind(b"PK\x01\x02")
    struct.pack_into("<L", data, at + 24, size)
    return bytes(data)


def many(count: int) -> bytes:
    """So many members, and an end that says there are few of them."""
    packed = bytearray(archive_of(*((f"site.a{k}", b"") for k in range(count))))
    struct.pack_into("<HH", packed, len(packed) - 14, 5, 5)
    return bytes(packed)


def zip64() -> bytes:
    """An end that refers to another end, which may say anything."""
    data = good()
    return data[:-22] + b"PK\x06\x07" + bytes(16) + data[-22:]


ARCHIVES: dict[str, tuple[Callable[[], bytes], str]] = {
    "empty": (lambda: b"", "empty"),
    "not a zip": (lambda: b"<task/>" * 1000, "not a zip"),
    "truncated": (lambda: good()[:-100], "truncated"),
    "the middle is missing": (lambda: good()[:2000] + good()[-400:], "m.mission"),
    "something before it": (lambda: b"#!/bin/sh\n" + good(), "not a zip"),
    "something behind it": (lambda: good() + b"more", "is truncated, or something was added"),
    "a comment": (lambda: good()[:-2] + b"\x04\x00more", "m.mission"),
    "another member": (lambda: archive_of(*entries(), ("readme.txt", b"hello")), "readme.txt"),
    "another part of the site": (
        lambda: archive_of(*entries(), ("site.dbf", b"hello")),
        "was changed after it was approved",
    ),
    "a member twice": (lambda: twice(TASK), "task.xml twice"),
    "a path that leads out": (lambda: archive_of(*entries(), ("../../.profile", b"")), "leads out"),
    "an absolute path": (lambda: archive_of(*entries(), ("/etc/passwd", b"")), "leads out"),
    "a path of another system": (lambda: archive_of(*entries(), ("C:\\autoexec", b"")), "leads out"),
    "a folder": (lambda: archive_of(*entries(), ("site/", b"")), "does not belong to a mission"),
    "a link": (
        lambda: archive_of(*entries()[:-1], (info("site.geojson", stat.S_IFLNK | 0o777), b"/etc/passwd")),
        "link",
    ),
    "encrypted": (encrypted, "encrypted"),
    "compressed": (lambda: archive_of(*entries(), method=zipfile.ZIP_DEFLATED), "compressed"),
    "a bomb": (lambda: archive_of(*entries(**{TASK: bytes(50_000_000)}), method=zipfile.ZIP_DEFLATED), "compressed"),
    "a bomb that says it is small": (lambda: lying(1_000), "compressed"),
    "a bomb that says it is huge": (lambda: lying(0xFFFFFFF0), "compressed"),
    "100,000 members": (lambda: many(5_000), "a mission has at most"),
    "an end elsewhere": (zip64, "another kind"),
    "packed again by another tool": (lambda: archive_of(*entries()), "was changed after it was approved"),
    "a site beyond the limit": (lambda: good() + bytes(MAX_BYTES), "MB"),
    **{
        f"without {name}": (lambda name=name: archive_of(*(e for e in entries() if e[0] != name)), "lacks")
        for name in members_of(good())
    },
}


@pytest.mark.parametrize("kind", ARCHIVES)
def test_an_archive_that_is_no_bundle(kind: str) -> None:
    make, words = ARCHIVES[kind]
    assert words in refused(make())


def test_a_bomb_is_refused_before_it_goes_off(monkeypatch: pytest.MonkeyPatch) -> None:
    data = lying(1_000)
    monkeypatch.setattr(zipfile.ZipFile, "read", lambda *_: pytest.fail("something was unpacked"))
    monkeypatch.setattr(zipfile.ZipFile, "open", lambda *_: pytest.fail("something was unpacked"))
    refused(data)


def test_a_file_of_a_gigabyte_is_refused_by_its_size(tmp_path: Path, monkeypatch: pytest.MonkeyPatch) -> None:
    path = tmp_path / "big.mission"
    with path.open("wb") as file:
        file.truncate(1_000_000_000)
    opened = Path.open

    def unread(path: Path, mode: str) -> Any:
        file = opened(path, mode, buffering=0)
        monkeypatch.setattr(file, "read", lambda *_: pytest.fail("it was read"), raising=False)
        return file

    monkeypatch.setattr(Path, "open", unread)
    with pytest.raises(BundleError, match="1,000 MB"):
        read_bundle_file(path)


@pytest.mark.parametrize("what", ["nothing", "a folder", "a pipe", "a name with a zero"])
def test_what_is_no_file_is_not_read(what: str, tmp_path: Path) -> None:
    path = tmp_path / ("m\0.mission" if what == "a name with a zero" else "m.mission")
    if what == "a folder":
        path.mkdir()
    elif what == "a pipe":
        os.mkfifo(path)
    with pytest.raises(BundleError):
        read_bundle_file(path)


def changed(**parts: Any) -> bytes:
    """The manifest with other values, signed again: ``a__b`` is b within a."""
    manifest = manifest_of(good())
    for path, value in parts.items():
        *above, last = path.split("__")
        inside = manifest
        for name in above:
            inside = inside[name]
        inside[last] = value
    return signed_with({MANIFEST: json.dumps(manifest).encode()})


def text(manifest: str | bytes) -> bytes:
    return signed_with({MANIFEST: manifest if isinstance(manifest, bytes) else manifest.encode()})


MANIFESTS: dict[str, tuple[Callable[[], bytes], str]] = {
    "empty": (lambda: text(""), "not JSON"),
    "not UTF-8": (lambda: text(b"\xff\xfe{}"), "not JSON"),
    "a list": (lambda: text("[]"), "not an object"),
    "nested too deeply": (lambda: text("[" * 200_000), "nested too deeply"),
    "nested too deep, in an object": (lambda: text('{"a":' * 100_000), "nested too deeply"),
    "NaN": (lambda: text('{"format": NaN}'), "NaN"),
    "infinity": (lambda: text('{"format": -Infinity}'), "Infinity"),
    "a huge number": (lambda: text('{"format": 1e999}'), "format"),
    "thousands of digits": (lambda: text(f'{{"format": {"9" * 9_000}}}'), "not JSON"),
    "a key twice": (lambda: text('{"format": 1, "format": 1}'), "twice"),
    "an older format": (lambda: changed(format=0), "format 0"),
    "a newer format": (lambda: changed(format=3), "update this program"),
    "no date in the present format": (lambda: changed(format=1), "do not fit format 1"),
    "a date before the approval": (lambda: changed(approved__until="2026-05-01T07:00:00+02:00"), "not within 366 days"),
    "a date too far": (lambda: changed(approved__until="2028-05-01T07:00:00+02:00"), "not within 366 days"),
    "number 0": (lambda: changed(approved__number=0), "approved.number"),
    "a format that is no number": (lambda: changed(format=True), "format True"),
    "a key more": (lambda: changed(valid_until="2027-01-01"), "valid_until"),
    "nobody": (lambda: changed(approved__by="  "), "approved.by"),
    "a name that steers the terminal": (lambda: changed(approved__by="Ada\x1b[2J"), "approved.by"),
    "no moment": (lambda: changed(approved__at="today"), "approved.at"),
    "no time zone": (lambda: changed(approved__at="2026-05-01T08:00:00"), "approved.at"),
    "a site file elsewhere": (lambda: changed(site__file="../site.geojson"), "site.file"),
    "a site file of another format": (lambda: changed(site__file="orchard.csv"), "lacks site.csv"),
    "lenient where it was not": (lambda: changed(site__lenient="yes"), "site.lenient"),
    "another site": (lambda: changed(site__sha256="0" * 64), "reads the site file differently"),
    "a site of other content": (lambda: changed(site__content_sha256="0" * 64), "reads the site differently"),
    "another site's name": (lambda: changed(site__name="Home"), "reads the site file differently"),
    "another robot": (lambda: changed(robot__sha256="0" * 64), "reads the robot profile differently"),
    "another Task": (lambda: changed(task__sha256="0" * 64), "reads the Task document differently"),
    "another request": (lambda: changed(task__request="Go home."), "reads the request differently"),
    "a file that is not there": (lambda: changed(files__more="0" * 64), "more is not what was approved"),
    "a hash that is none": (lambda: changed(files={"task.xml": "abc"}), "files.task.xml"),
    "no files": (lambda: changed(files={}), "is not what was approved"),
    "replaced site": (
        lambda: signed_with({"site.geojson": orchard_files(7).parts["orchard.geojson"]}),
        "site.geojson is not what was approved",
    ),
    "replaced robot": (
        lambda: signed_with({ROBOT: members_of(good())[ROBOT].replace(b"husky", b"husqy")}),
        "robot.yaml is not what was approved",
    ),
    "replaced Task": (
        lambda: signed_with({TASK: members_of(good())[TASK].replace(b"read_co2", b"take_thermal_picture")}),
        "task.xml is not what was approved",
    ),
}


@pytest.mark.parametrize("kind", MANIFESTS)
def test_a_manifest_that_cannot_be_used_even_if_it_is_signed(kind: str) -> None:
    make, words = MANIFESTS[kind]
    assert words in refused(make())


def hashed(**changes: bytes) -> bytes:
    """Other files, with their right hashes in a manifest that is signed."""
    from hashlib import sha256

    manifest = manifest_of(good())
    for name, data in changes.items():
        manifest["files"][name] = sha256(data).hexdigest()
    return signed_with({**changes, MANIFEST: json.dumps(manifest).encode()})


BOMB = (
    b'<?xml version="1.0"?><!DOCTYPE t [<!ENTITY a "aaaaaaaaaa">'
    + b"".join(b'<!ENTITY %c "%s">' % (k + 1, b"&%c;" % k * 10) for k in range(ord("a"), ord("i")))
    + b']><task xmlns="urn:fieldhand:task:1" id="&i;"/>'
)


@pytest.mark.parametrize(
    ("changes", "words"),
    [
        ({TASK: BOMB}, "DOCTYPE"),
        ({TASK: b"<task>" * 100_000}, "task.xml"),
        ({TASK: b""}, "empty"),
        ({ROBOT: b"a: &a [*a, *a]"}, "aliases"),
        ({ROBOT: b"[" * 1_000}, "robot.yaml"),
        ({"site.geojson": b"[" * 100_000}, "nested"),
        ({"site.geojson": b"{}"}, "FeatureCollection"),
    ],
    ids=["entity bomb", "deep XML", "no XML", "YAML bomb", "deep YAML", "deep JSON", "no site"],
)
def test_files_that_cannot_be_used_even_if_they_are_signed(changes: dict[str, bytes], words: str) -> None:
    with pytest.raises(InputError) as refusal:
        opened(hashed(**changes))
    assert words in str(refusal.value)
    assert "m.mission" in str(refusal.value)


def test_a_task_for_another_robot_is_refused_by_its_schema() -> None:
    with pytest.raises(TaskError, match="take_x_ray"):
        opened(hashed(**{TASK: members_of(good())[TASK].replace(b"read_co2", b"take_x_ray")}))


def test_a_task_that_is_written_otherwise_is_not_the_one_that_was_approved() -> None:
    """The hash in the approval is of the Task as this program writes it: a comment more is another document."""
    with pytest.raises(BundleError, match="reads the Task document differently"):
        opened(hashed(**{TASK: members_of(good())[TASK].replace(b"<plan>", b"<!-- and then --><plan>")}))


@pytest.mark.parametrize(
    "signature",
    [
        b"",
        b"fieldhand-ed25519 AAAA\nAAAA\n",
        b"fieldhand-ed25519 " + b"A" * 43 + b"=\n" + b"A" * 86 + b"==\n",
        b"\xff" * 100,
    ],
    ids=["none", "short", "zeros", "no text"],
)
def test_a_signature_that_is_none(signature: bytes) -> None:
    from fieldhand.approval.bundle.container import wrap

    assert "signature is broken" in refused(wrap(members_of(good()) | {SIGNATURE: signature}))


def test_a_signature_has_one_way_to_be_written() -> None:
    from fieldhand.approval.bundle.container import wrap

    text = members_of(good())[SIGNATURE]
    letters = b"ABCDEFGHIJKLMNOPQRSTUVWXYZabcdefghijklmnopqrstuvwxyz0123456789+/"
    spare = bytes([letters[letters.index(text[-4]) ^ 1]])  # the last letter has four bits that say nothing
    other = text[:-4] + spare + text[-3:]
    assert "signature is broken" in refused(wrap(members_of(good()) | {SIGNATURE: other}))


def test_a_revoked_key_counts_no_more_whenever_it_signed() -> None:
    with pytest.raises(NotTrustedError, match="revoked on 2030"):
        opened(good(), keys=known(revoked="2030-01-01T00:00:00+00:00"))


def test_an_approval_dated_ahead_is_refused_where_no_time_zone_explains_it() -> None:
    early = NOW - timedelta(hours=20)
    assert opened(good(), now=early).manifest.approved.by == "Ada"
    with pytest.raises(BundleError, match="the clock of this machine shows 2026-04-29"):
        opened(good(), now=NOW - timedelta(days=2))


def test_nothing_is_read_before_its_signer_is_known(monkeypatch: pytest.MonkeyPatch) -> None:
    from fieldhand.approval.bundle import opening

    for reader in ("parse_manifest", "parse_profile", "site_of", "decode", "require_valid"):
        monkeypatch.setattr(opening, reader, lambda *_, **__: pytest.fail("it was read"))
    with pytest.raises(NotTrustedError):
        opened(good(), keys={})
