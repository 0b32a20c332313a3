"""Test harmful files: zip bombs, paths outside the archive, external references, and damage of any kind."""

from __future__ import annotations

import sqlite3
from collections.abc import Sequence
from pathlib import Path

import numpy as np
import pytest
import shapely
from hypothesis import HealthCheck, given, settings
from hypothesis import strategies as st

from fieldhand.errors import SiteError
from fieldhand.site.formats.sandbox import ReadLimits, read_limits, read_sandboxed
from fieldhand.site.loader import load_site
from support.examples import examples
from support.sites.gisfiles import kml, write_layer, zipped
from support.sites.points import collection, point, square

LON, LAT = -120.42, 37.26
TREES = [point(LON + k * 1e-4, LAT) for k in range(3)]


def told(path: Path, data: bytes | None = None) -> str:
    if data is not None:
        path.write_bytes(data)
    with pytest.raises(SiteError) as caught:
        load_site(path)
    assert path.name in str(caught.value)
    return str(caught.value)


def bomb() -> str:
    levels = "".join(f'<!ENTITY {b} "{f"&{a};" * 10}">' for a, b in zip("abcdefgh", "bcdefghi", strict=True))
    return f'<!DOCTYPE kml [<!ENTITY a "aaaaaaaaaa">{levels}]>'


@pytest.mark.parametrize(
    ("data", "says"),
    [
        (kml("<Placemark><name>&i;</name></Placemark>", head=bomb()), "document type or entities"),
        (kml(head='<!DOCTYPE kml [<!ENTITY e SYSTEM "file:///etc/hostname">]>'), "document type or entities"),
        (kml(head='<!DOCTYPE kml SYSTEM "http://example.org/kml.dtd">'), "document type or entities"),
        (kml("<Folder>" * 5000 + "</Folder>" * 5000), "nested too deeply"),
        (kml("<Placemark>"), "line 1: the file is not well-formed XML"),
        (kml("&nbsp;"), "not well-formed XML"),
        (kml(root="html"), "not KML (its root is 'html')"),
        (b"<OGRVRTDataSource><OGRVRTLayer name='x'/></OGRVRTDataSource>", "refers to other files"),
        (kml("<!-- <OGRVRTDataSource> -->"), "refers to other files"),
        (kml(), "no points"),
        (b"\xff\xfe", "not well-formed"),
    ],
)  # fmt: skip
def test_a_harmful_kml_file_is_rejected(tmp_path, data, says):
    assert says in told(tmp_path / "farm.kml", data)
    assert says in told(zipped(tmp_path / "farm.kmz", {"doc.kml": data}))


@pytest.mark.parametrize("name", ["../evil.csv", "/tmp/evil.csv", "a/../../evil.csv", "..\\evil.csv", "C:/evil.csv"])
def test_an_archive_with_paths_outside_itself_is_refused_and_nothing_is_written(tmp_path, name):
    path = zipped(tmp_path / "farm.zip", {name: b"lat,lon\n37.26,-120.42\n"})
    assert "leads out of it" in told(path)
    assert not list(tmp_path.rglob("evil.csv"))


def test_archives_that_unpack_to_too_much_are_rejected(tmp_path, monkeypatch):
    from fieldhand.site.formats import archive

    assert "unpacks to more than" in told(zipped(tmp_path / "bomb.zip", {"a.csv": bytes(30_000_000)}))
    assert "2,001 files" in told(zipped(tmp_path / "many.zip", {f"{k}.txt": b"" for k in range(2001)}))
    monkeypatch.setattr(archive, "MAX_UNPACKED", 1000)
    noise = np.random.default_rng(1).bytes(900)
    big = zipped(tmp_path / "big.zip", {"a.csv": noise, "b.csv": noise}).read_bytes()
    with pytest.raises(SiteError, match="unpacks to more than"):
        archive.unpack(big, {".csv"}, tmp_path, "big.zip")


def test_damaged_archives_and_archives_without_a_site_are_reported(tmp_path):
    assert "no site file" in told(zipped(tmp_path / "a.zip", {"readme.txt": b"x", "inner.zip": b"PK\x03\x04"}))
    assert "2 .csv files" in told(zipped(tmp_path / "b.zip", {"a.csv": b"x", "b.csv": b"x"}))
    assert "archive is damaged" in told(tmp_path / "c.zip", b"PK\x03\x04" + b"x" * 100)
    good = zipped(tmp_path / "d.zip", {"a.csv": np.random.default_rng(1).bytes(3000)}).read_bytes()
    assert "archive is damaged" in told(tmp_path / "d.zip", good[:500] + bytes(100) + good[600:])
    path = zipped(tmp_path / "e.zip", {"a.csv": b"x"})
    data = bytearray(path.read_bytes())
    data[data.index(b"PK\x01\x02") + 8] |= 1  # the flag of encryption, in the directory
    assert "encrypted" in told(path, bytes(data))
    assert "the name ends in zip, but the content is not in that format" in told(tmp_path / "f.zip", b"lat,lon")


def test_a_geopackage_with_views_or_virtual_tables_is_rejected(tmp_path):
    path = write_layer(tmp_path / "farm.gpkg", "trees", [shapely.Point(LON, LAT)])
    with sqlite3.connect(path) as database:
        database.execute("CREATE VIEW more AS SELECT * FROM trees, trees AS b, trees AS c")
        database.execute(
            "INSERT INTO gpkg_contents SELECT 'more', data_type, 'more', description, last_change, min_x, min_y, max_x,"
            " max_y, srs_id FROM gpkg_contents WHERE table_name = 'trees'"
        )
        database.execute(
            "INSERT INTO gpkg_geometry_columns SELECT 'more', column_name, geometry_type_name, srs_id, z, m"
            " FROM gpkg_geometry_columns WHERE table_name = 'trees'"
        )
    database.close()
    site = load_site(path)
    assert len(site.trees) == 1
    assert "views were left out (only tables are read): more" in site.notes
    with sqlite3.connect(path) as database:
        database.execute("PRAGMA writable_schema = ON")
        database.execute(
            "INSERT INTO sqlite_master VALUES ('table', 'x', 'x', 0, 'CREATE VIRTUAL TABLE x USING VirtualText(y)')"
        )
    database.close()
    assert "virtual tables" in told(path)
    other = tmp_path / "other.gpkg"
    with sqlite3.connect(other) as database:
        database.execute("CREATE TABLE trees (a)")
    database.close()
    assert "not a GeoPackage" in told(other)
    assert "cannot be read" in told(other, path.read_bytes()[:5000])


def test_a_shapefile_needs_its_coordinate_system_and_its_main_file(tmp_path):
    path = write_layer(
        tmp_path / "farm.shp", "farm", [shapely.Point(701234.0, 4129876.0)], {"a": [1]}, crs="EPSG:32610"
    )
    (tmp_path / "farm.prj").unlink()
    assert "coordinate system" in told(path)
    assert "only part of a Shapefile" in told(tmp_path / "farm.dbf")
    (tmp_path / "farm.prj").write_text('LOCAL_CS["here"]')
    assert "coordinate system" in told(path)
    assert "cannot be read" in told(tmp_path / "farm.shp", path.read_bytes()[:60])
    assert "cannot be read" in told(tmp_path / "alone.shp", b"\x00\x00\x27\x0a")


def test_a_feature_without_geometry_is_reported(tmp_path):
    path = tmp_path / "farm.gpkg"
    write_layer(path, "trees", [shapely.Point(LON, LAT), None], {"age": [1, 2]})
    assert "feature 2: it has no geometry" in told(path)
    assert len(load_site(path, lenient=True).trees) == 1
    write_layer(path, "keep_outs", [shapely.Polygon(square(LON + 5e-4, LAT)), None], {"name": ["a", "b"]}, append=True)
    with pytest.raises(SiteError, match="feature 4: it has no geometry"):
        load_site(path, lenient=True)


@pytest.mark.parametrize(
    "data", [b'{"a":' * 100_000, b"[" * 5_000_000, b'{"type":"FeatureCollection","features":[' + b"9" * 5000]
)
def test_deep_and_huge_json_is_refused(tmp_path, data):
    assert told(tmp_path / "deep.geojson", data)


ENDINGS = ["geojson", "csv", "shp", "gpkg", "kml", "kmz", "zip", "txt", "bin", ""]


@pytest.fixture(scope="module")
def good(tmp_path_factory) -> Sequence[tuple[str, bytes]]:
    folder = tmp_path_factory.mktemp("good")
    shapes = [shapely.Point(LON + k * 1e-4, LAT) for k in range(4)]
    for name in ("a.shp", "a.gpkg", "a.kml"):
        write_layer(folder / name, "a", shapes, {"row": [1, 1, 2, 2], "name": ["a", "b", "c", "d"]})
    zipped(folder / "a.kmz", {"doc.kml": (folder / "a.kml").read_bytes()})
    zipped(folder / "a.zip", {f"a.{e}": (folder / f"a.{e}").read_bytes() for e in ("shp", "shx", "dbf", "prj")})
    (folder / "a.csv").write_text("lat,lon,row\n37.26,-120.42,1\n37.2601,-120.42,1\n")
    (folder / "a.geojson").write_bytes(collection(*TREES))
    names = ["a.shp", "a.gpkg", "a.kml", "a.kmz", "a.zip", "a.csv", "a.geojson"]
    return [(Path(name).suffix[1:], (folder / name).read_bytes()) for name in names]


def outcome(path: Path, *, lenient: bool) -> str:
    """Return the number of trees, or the error."""
    try:
        return f"{len(load_site(path, lenient=lenient).trees)} trees"
    except SiteError as fault:
        return fault.what


@settings(
    max_examples=examples(15, thorough=300), deadline=None, suppress_health_check=[HealthCheck.function_scoped_fixture]
)
@given(data=st.data())
def test_any_bytes_give_a_site_or_a_one_line_error(data, good, tmp_path):
    ending, whole = data.draw(st.sampled_from(good) | st.tuples(st.sampled_from(ENDINGS), st.binary(max_size=200)))
    spoilt = bytearray(whole)
    for _ in range(data.draw(st.integers(0, 8)) if spoilt else 0):
        spoilt[data.draw(st.integers(0, len(spoilt) - 1))] = data.draw(st.integers(0, 255))
    cut = data.draw(st.integers(0, len(spoilt)) | st.just(len(spoilt)))
    path = tmp_path / f"farm.{data.draw(st.sampled_from([ending, ending, *ENDINGS]))}"
    path.write_bytes(bytes(spoilt[:cut]))
    for lenient in (False, True):
        said = outcome(path, lenient=lenient)
        assert "\n" not in said
        assert str(tmp_path.parent) not in said


def test_a_small_file_that_needs_much_memory_or_time_gives_a_one_line_error(tmp_path):
    """The file is a compressed KML with a placemark of a million corners in many layers."""
    ring = " ".join(f"{LON + k * 1e-9},{LAT}" for k in range(200_000))
    body = f"<Placemark><LineString><coordinates>{ring}</coordinates></LineString></Placemark>" * 8
    text = f'<kml xmlns="http://www.opengis.net/kml/2.2"><Document>{body}</Document></kml>'
    data = zipped(tmp_path / "bomb.kmz", {"doc.kml": text.encode()}).read_bytes()
    for allowed in (
        ReadLimits(memory=300_000_000, result=10**9, cpu_s=60, wall_s=120),
        ReadLimits(memory=3_000_000_000, result=1_000_000, cpu_s=60, wall_s=120),
        ReadLimits(memory=3_000_000_000, result=10**9, cpu_s=1, wall_s=120),
        ReadLimits(memory=3_000_000_000, result=10**9, cpu_s=60, wall_s=0.01),
    ):
        with pytest.raises(SiteError, match="cannot be read"):
            read_sandboxed("zip", {"bomb.kmz": data}, "bomb.kmz", lenient=False, allowed=allowed)


def test_the_limits_suffice_for_a_site_of_its_size(tmp_path):
    shapes = [shapely.Point(LON + k % 300 * 1e-5, LAT + k // 300 * 1e-5) for k in range(20_000)]
    path = write_layer(tmp_path / "farm.gpkg", "trees", shapes, {"row": [k // 300 for k in range(20_000)]})
    assert read_limits(path.stat().st_size).memory <= 1_100_000_000
    assert len(load_site(path).trees) == 20_000
