"""A bundle holds what was approved, byte by byte, and any change to it is seen."""

from __future__ import annotations

import hashlib
import re
from pathlib import Path

import pytest
from hypothesis import assume, given, settings
from hypothesis import strategies as st
from shapely import Point

import fieldhand
from fieldhand.approval.bundle.container import MANIFEST, unwrap
from fieldhand.approval.bundle.opening import content_of, unseal
from fieldhand.approval.keys.public import PublicKey
from fieldhand.delivery.bundle_checks import require_sendable
from fieldhand.errors import BundleError, NotTrustedError
from fieldhand.robot.loader import load_robot
from fieldhand.site.formats import gis
from fieldhand.site.formats.files import SiteFiles, read_files
from fieldhand.site.loader import site_files, site_of
from fieldhand.task.codec import encode
from fieldhand.testing.small_orchard import at
from support.missions.signed import (
    KEY,
    NOW,
    WHEN,
    good,
    manifest_of,
    members_of,
    opened,
    orchard_files,
    pack_mission,
    signing_key,
)
from support.sites.gisfiles import kml, placemark, write_layer
from support.sites.points import collection, point


def test_what_comes_out_is_what_was_approved() -> None:
    site = site_of(orchard_files())
    bundle = opened(good())
    authorization = bundle.authorized.authorization
    assert (authorization.by, authorization.at) == ("Ada", WHEN)
    assert authorization.task_sha256 == hashlib.sha256(encode(bundle.authorized.task)).hexdigest()
    assert (authorization.site_sha256, authorization.robot_sha256) == (site.sha256, load_robot("husky").sha256)
    assert (bundle.site.sha256, bundle.site.content_sha256) == (site.sha256, site.content_sha256)
    assert bundle.site.trees == site.trees
    assert bundle.robot.sha256 == load_robot("husky").sha256
    assert bundle.signer.fingerprint == KEY.public.fingerprint
    assert bundle.hashes["bundle"] == hashlib.sha256(good()).hexdigest()
    for name, data in members_of(good()).items():
        assert bundle.hashes[name] == hashlib.sha256(data).hexdigest()


def test_the_same_approval_is_the_same_bytes_whatever_the_machine() -> None:
    assert pack_mission() == good()
    # Of these bytes a robot decides. If another version of the zip library writes others, this is the place to know.
    assert hashlib.sha256(_frame(good())).hexdigest() == _FRAME


_FRAME = "e7ac50ad4f95e527930f52085300c43ce5360bbcd200a3451e3320d22011316b"


def _frame(data: bytes) -> bytes:
    """The zip file without what its files hold."""
    from fieldhand.approval.bundle.container import wrap

    return wrap(dict.fromkeys(members_of(data), b""))


def test_warnings_and_language_are_signed() -> None:
    manifest = manifest_of(good())
    assert manifest["approved"]["confirmed"] == list(opened(good()).authorized.authorization.confirmed)
    assert "3 co2 readings" in manifest["approved"]["confirmed"][0]
    assert (manifest["approved"]["language"], manifest["task"]["planner"]) == ("en", "english")
    assert manifest["program"] == f"fieldhand {fieldhand.__version__}"


def _table(folder: Path) -> SiteFiles:
    lines = ["id,lat,lon", *(f"{k + 1},{at(0, k)[1]},{at(0, k)[0]}" for k in range(4))]
    (folder / "rows.CSV").write_text("\n".join(lines))
    return read_files(folder / "rows.CSV")


def _kml(folder: Path) -> SiteFiles:
    (folder / "farm.kml").write_bytes(kml(*(placemark(*at(0, k), name=str(k + 1)) for k in range(4))))
    return read_files(folder / "farm.kml")


def _shapefile(folder: Path) -> SiteFiles:
    shapes = [Point(*at(0, k)) for k in range(4)]
    return read_files(write_layer(folder / "blocks.shp", "blocks", shapes, {"id": [1, 2, 3, 4]}))


def _no_ending(folder: Path) -> SiteFiles:
    (folder / "orchard").write_bytes(orchard_files().parts["orchard.geojson"])
    return read_files(folder / "orchard")


def _builtin(folder: Path) -> SiteFiles:
    return site_files("demo")


@pytest.mark.parametrize("make", [_table, _kml, _shapefile, _no_ending, _builtin], ids=lambda f: f.__name__)
def test_a_site_of_any_format_is_the_same_site_on_the_robot(make, tmp_path: Path) -> None:
    files = make(tmp_path)
    here, there = site_of(files), opened(pack_mission(files)).site
    assert (there.sha256, there.content_sha256, there.name) == (here.sha256, here.content_sha256, here.name)
    assert str(tmp_path).encode() not in pack_mission(files)  # nor does it say where the file lay


@pytest.mark.parametrize("make", [_kml, _shapefile], ids=lambda f: f.__name__)
def test_gdal_reads_nothing_of_a_stranger(make, tmp_path: Path, monkeypatch: pytest.MonkeyPatch) -> None:
    """Neither to inspect a mission nor to send it, whatever reader of such files there is."""
    data = pack_mission(make(tmp_path))
    sealed = unseal(data, source="m.mission")

    def read(*_: object, **__: object) -> None:
        raise AssertionError("a file of a stranger was read")

    monkeypatch.setattr(gis, "read_sandboxed", read)
    monkeypatch.setattr(gis, "read_in_process", read)
    with pytest.raises(NotTrustedError, match="not read before a trusted key has signed"):
        content_of(sealed, now=NOW, stranger=True)
    assert require_sendable(data, source="m.mission", known={}, now=NOW).hashes == sealed.hashes
    with pytest.raises(NotTrustedError, match="not trusted here"):
        opened(data, {})
    with pytest.raises(AssertionError, match="a file of a stranger was read"):
        opened(data)


def test_a_site_that_was_read_leniently_is_read_so_again() -> None:
    trees = [point(*at(0, k), kind="tree", id=k + 1) for k in range(4)]
    files = SiteFiles(parts={"f.geojson": collection(*trees, point(500, 91))}, source="f.geojson")
    bundle = opened(pack_mission(files, lenient=True))
    assert len(bundle.site.trees) == 4
    assert manifest_of(pack_mission(files, lenient=True))["site"]["lenient"] is True


def test_the_files_must_be_those_that_were_approved() -> None:
    from fieldhand.approval.authorize import EveryWarning, approve
    from fieldhand.approval.bundle.packing import pack
    from fieldhand.approval.checks import examine
    from fieldhand.robot.loader import profile_bytes

    bundle = opened(good())
    other, husky = orchard_files(7), profile_bytes("husky")[0]
    task = bundle.authorized.task
    approved = approve(examine(task, bundle.site, bundle.robot), by="Ada", at=WHEN, confirmed=EveryWarning())
    for files, profile in ((other, husky), (orchard_files(), husky + b"\n")):
        with pytest.raises(BundleError, match="from what was approved"):
            pack(approved, bundle.site, bundle.robot, files=files, lenient=False, profile=profile, key=KEY, planner="x")


@settings(deadline=None)
@given(where=st.floats(0, 1, exclude_max=True), mask=st.integers(1, 255))
def test_a_changed_byte_anywhere_is_refused(where: float, mask: int) -> None:
    data = bytearray(good())
    data[int(where * len(data))] ^= mask
    with pytest.raises(BundleError):
        opened(bytes(data))


def test_every_bit_of_what_frames_the_files_counts() -> None:
    """Dates, rights, versions, extra fields: what no tool looks at is a place to hide something all the same."""
    content = {k for data in members_of(good()).values() for k in range(_start(data), _start(data) + len(data))}
    frame = [k for k in range(len(good())) if k not in content]
    assert len(frame) > 300
    for k in frame:
        data = bytearray(good())
        data[k] ^= 1 << (k % 8)
        with pytest.raises(BundleError):
            unwrap(bytes(data), source="m.mission")


def _start(member: bytes) -> int:
    found = good().find(member)
    assert found > 0
    return found


@settings(deadline=None)
@given(data=st.data())
def test_bytes_cut_out_put_in_or_exchanged_are_refused(data: st.DataObject) -> None:
    whole = good()
    a, b = sorted(data.draw(st.lists(st.integers(0, len(whole)), min_size=2, max_size=2)))
    put = data.draw(st.binary(max_size=40))
    changed = whole[:a] + put + whole[b:]
    assume(changed != whole)
    with pytest.raises(BundleError):
        opened(changed)


@settings(deadline=None)
@given(st.binary(max_size=2_000))
def test_any_other_bytes_are_refused(data: bytes) -> None:
    for tried in (data, b"PK\x03\x04" + data, good()[:500] + data, data + good()[-400:]):
        with pytest.raises(BundleError):
            opened(tried)


def test_only_a_trusted_key_counts() -> None:
    stranger = signing_key(2, "Mallory")
    with pytest.raises(NotTrustedError, match="not trusted here") as refused:
        opened(pack_mission(key=stranger))
    assert stranger.public.fingerprint in str(refused.value)
    with pytest.raises(NotTrustedError, match="not trusted here"):
        opened(good(), keys={})


def test_no_other_module_upholds_an_approval() -> None:
    """The door for approvals that were given elsewhere is behind the check of the signature, and nowhere else."""
    root = Path(fieldhand.__file__).parent
    users = {
        str(path.relative_to(root))
        for path in root.rglob("*.py")
        if re.search(r"\buphold\b", path.read_text(encoding="utf-8"))
    }
    assert users == {"approval/authorize.py", "approval/bundle/opening.py"}


def test_a_signature_of_something_else_is_none() -> None:
    from fieldhand.approval.bundle.container import SIGNATURE, wrap
    from fieldhand.approval.bundle.signature import Signature

    members = members_of(good())
    plain = Signature(public=PublicKey(raw=KEY.public.raw), value=KEY.sign(members[MANIFEST]))
    with pytest.raises(BundleError, match="signature is broken"):
        opened(wrap(members | {SIGNATURE: plain.text()}))
