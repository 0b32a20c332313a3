"""Test the file formats: the same orchard gives the same site in every format."""

from __future__ import annotations

import csv
import io
import subprocess
import sys
from pathlib import Path

import numpy as np
import pyproj
import pytest
import shapely
from hypothesis import given, settings
from hypothesis import strategies as st

from fieldhand.errors import SiteError
from fieldhand.site.loader import load_demo, load_site
from fieldhand.site.model import Site
from support.sites.gisfiles import kml, placemark, write_layer, zipped
from support.sites.points import collection, point, read, square

LON, LAT = -120.42, 37.26
UTM = "EPSG:32610"


def table(tmp_path: Path, data: bytes | str, name: str = "field.csv") -> Site:
    path = tmp_path / name
    path.write_bytes(data if isinstance(data, bytes) else data.encode())
    return load_site(path)


cells = st.one_of(
    st.integers(-(10**6), 10**6),
    st.floats(-1e6, 1e6, allow_nan=False).map(lambda v: round(v, 4)),
    st.booleans(),
    st.text("abcXYZ äöü,;\"'-", min_size=1, max_size=8)
    .map(str.strip)
    .filter(lambda t: t and t not in ("-", "na", "nan")),
)


@settings(max_examples=40, deadline=None)
@given(
    st.lists(
        st.tuples(
            st.integers(0, 4000), st.integers(0, 4000), st.dictionaries(st.sampled_from(["row", "age", "sort"]), cells)
        ),
        min_size=1,
        max_size=12,
        unique_by=lambda t: t[:2],
    ),
    st.sampled_from([",", ";", "\t"]),
)
def test_the_same_orchard_as_a_table_and_as_geojson_is_the_same_site(trees, delimiter):
    places = [(LON + east * 1e-6, LAT + north * 1e-6, said) for east, north, said in trees]
    text = io.StringIO()
    writer = csv.writer(text, delimiter=delimiter)
    names = ["row", "age", "sort"]
    writer.writerow(["Latitude", *names, "Longitude"])
    writer.writerows([repr(lat), *(said.get(n, "") for n in names), repr(lon)] for lon, lat, said in places)
    from fieldhand.site.formats.table import table_records

    one = read(*table_records(text.getvalue().encode(), "field.csv").features)
    other = read(*(point(lon, lat, **said) for lon, lat, said in places))
    assert one.content_sha256 == other.content_sha256
    assert np.array_equal(one.xy, other.xy)
    assert one.sha256 != other.sha256 or one == other


@pytest.mark.parametrize(
    "header",
    [
        "lat,lon",
        "Latitude,Longitude",
        "LAT,LNG",
        "y,x",
        "gps_lat,gps_long",
        "Latitude (deg),Longitude (deg)",
        "POINT_Y,POINT_X",
    ],
)
def test_latitude_and_longitude_columns_have_many_names(tmp_path, header):
    site = table(tmp_path, f"{header}\n{LAT},{LON}\n")
    assert (site.trees[0].place.lat, site.trees[0].place.lon) == (LAT, LON)
    assert dict(site.trees[0].properties) == {}


@pytest.mark.parametrize(
    "data",
    [
        b"lat;lon;age\n37,26;-120,42;3,5\n",
        b"lat\tlon\tage\n37,26\t-120,42\t3.5\n",
        b"\xef\xbb\xbflat,lon,age\r\n37.26,-120.42,3.5\r\n",
        "lat,lon,age\n37.26,-120.42,3.5\n".encode("utf-16"),
        b"sep=;\nlat;lon;age\n37.26;-120.42;3.5\n",
        b'\n"lat","lon","age"\n\n"37.26"," -120.42 ","3.5",,\n\n',
    ],
)
def test_separators_decimal_commas_and_encodings(tmp_path, data):
    tree = table(tmp_path, data).trees[0]
    assert (tree.place.lat, tree.place.lon, dict(tree.properties)) == (LAT, LON, {"age": 3.5})


def test_a_table_in_windows_1252_is_read_and_noted(tmp_path):
    site = table(tmp_path, "lat,lon,Größe\n37.26,-120.42,süß\n".encode("cp1252"))
    assert dict(site.trees[0].properties) == {"Größe": "süß"}
    assert "Windows-1252" in site.notes[0]


def test_cells_written_as_numbers_are_numbers(tmp_path):
    site = table(tmp_path, "lat,lon,a,b,c,d,e,f\n37.26,-120.42,007,1e3,-0.5,true,n/a,3 m\n")
    assert dict(site.trees[0].properties) == {"a": "007", "b": 1000.0, "c": -0.5, "d": True, "f": "3 m"}
    assert site.trees[0].properties["d"] is True


def test_a_table_may_hold_markers_and_rows_and_counts_lines(tmp_path):
    site = table(
        tmp_path, 'id,lat,lon,kind,row\nA1,37.26,-120.42,tree,4\n,37.2601,-120.42,start,\n"B\n2",37.2602,-120.42,,5\n'
    )
    assert list(site.markers) == ["start"]
    assert [(t.row, t.feature) for t in site.trees] == [("4", 2), ("5", 4)]


DEMO = load_demo()
DEGREES = np.array([(t.place.lon, t.place.lat) for t in DEMO.trees])
IN_UTM = np.column_stack(pyproj.Transformer.from_crs("EPSG:4326", UTM, always_xy=True).transform(*DEGREES.T))
FIELDS = {
    "row": [int(t.properties["row"]) for t in DEMO.trees],
    "variety": [str(t.properties["variety"]) for t in DEMO.trees],
}


def assert_is_the_demo(site: Site) -> None:
    assert np.abs(site.xy - DEMO.xy).max() < 0.001
    assert [t.properties["variety"] for t in site.trees] == FIELDS["variety"]
    assert [t.row for t in site.trees] == [t.row for t in DEMO.trees]


@pytest.mark.parametrize(
    ("name", "crs"),
    [
        ("trees.shp", "EPSG:4326"),
        ("trees.shp", UTM),
        ("trees.gpkg", "EPSG:4326"),
        ("trees.gpkg", UTM),
        ("trees.kml", "EPSG:4326"),
    ],
)
def test_a_file_in_any_coordinate_system_is_the_same_site(tmp_path, name, crs):
    points = [shapely.Point(p) for p in (DEGREES if crs == "EPSG:4326" else IN_UTM)]
    site = load_site(write_layer(tmp_path / name, "trees", points, FIELDS, crs=crs))
    assert_is_the_demo(site)
    assert any("UTM zone 10N" in note for note in site.notes) == (crs == UTM)


def test_a_zipped_shapefile_and_a_kmz_read_as_what_is_in_them(tmp_path):
    write_layer(tmp_path / "trees.shp", "trees", [shapely.Point(p) for p in IN_UTM], FIELDS, crs=UTM)
    parts = {f"farm/trees.{e}": (tmp_path / f"trees.{e}").read_bytes() for e in ("shp", "shx", "dbf", "prj")}
    assert_is_the_demo(load_site(zipped(tmp_path / "farm.zip", parts)))
    write_layer(tmp_path / "doc.kml", "trees", [shapely.Point(p) for p in DEGREES], FIELDS)
    packed = zipped(tmp_path / "farm.kmz", {"doc.kml": (tmp_path / "doc.kml").read_bytes(), "icon.png": b"x"})
    assert_is_the_demo(load_site(packed))


@pytest.mark.parametrize("name", ["farm.geojson", "farm.csv"])
def test_other_formats_may_be_zipped(tmp_path, name):
    data = collection(point(LON, LAT)) if name.endswith("json") else f"lat,lon\n{LAT},{LON}\n".encode()
    assert len(load_site(zipped(tmp_path / "farm.zip", {name: data, "readme.txt": b"x"})).trees) == 1


def test_a_shapefile_without_its_index_is_read(tmp_path):
    path = write_layer(tmp_path / "trees.shp", "trees", [shapely.Point(p) for p in IN_UTM], FIELDS, crs=UTM)
    (tmp_path / "trees.shx").unlink()
    before = sorted(tmp_path.iterdir())
    assert_is_the_demo(load_site(path))
    assert sorted(tmp_path.iterdir()) == before


def test_layers_are_joined_and_their_names_give_the_kinds(tmp_path):
    path = tmp_path / "farm.gpkg"
    write_layer(path, "trees", [shapely.Point(LON, LAT), shapely.Point(LON + 1e-4, LAT)], {"id": ["A", "B"]})
    write_layer(path, "keep_outs", [shapely.Polygon(square(LON + 5e-4, LAT))], {"name": ["heap"]}, append=True)
    write_layer(path, "boundary", [shapely.Polygon(square(LON, LAT, 1e-3))], {"id": [1]}, append=True)
    write_layer(path, "fences", [shapely.LineString([(LON, LAT + 2e-4), (LON + 1e-4, LAT + 2e-4)])], append=True)
    write_layer(path, "start", [shapely.Point(LON, LAT + 1e-4)], append=True)
    site = load_site(path)
    assert [t.place.id for t in site.trees] == ["A", "B"]
    assert [(z.kind, z.name) for z in site.zones] == [
        ("keep_out", "heap"),
        ("boundary", "boundary"),
        ("keep_out", "fence"),
    ]
    assert list(site.markers) == ["start"]
    assert any("layers were joined" in note for note in site.notes)


def test_kml_names_and_extended_data_become_properties(tmp_path):
    pond = "".join(f"{lon!r},{lat!r} " for lon, lat in square(LON + 1e-3, LAT))
    path = tmp_path / "farm.kml"
    path.write_bytes(
        kml(
            placemark(LON, LAT, "Old Joe", age=7, variety="Kerman"),
            placemark(LON, LAT + 1e-4, "Start"),
            f"<Placemark><name>North pond</name><Polygon><outerBoundaryIs><LinearRing><coordinates>{pond}</coordinates>"
            "</LinearRing></outerBoundaryIs></Polygon></Placemark>",
        )
    )
    site = load_site(path)
    assert dict(site.trees[0].properties) == {"name": "Old Joe", "age": 7.0, "variety": "Kerman"}
    assert list(site.markers) == ["start"]
    assert [(z.kind, z.name) for z in site.zones] == [("keep_out", "North pond")]


def test_without_the_extra_the_error_names_it(tmp_path, monkeypatch):
    path = tmp_path / "farm.kml"
    path.write_bytes(kml(placemark(LON, LAT)))
    monkeypatch.setitem(sys.modules, "pyogrio", None)
    with pytest.raises(SiteError, match=r"pip install 'fieldhand\[gis\]'"):
        load_site(path)


def test_gdal_never_reads_a_file_in_the_calling_process(tmp_path):
    path = tmp_path / "farm.kml"
    path.write_bytes(kml(placemark(LON, LAT)))
    script = (
        "import sys; from pathlib import Path; from fieldhand.site.loader import load_site\n"
        f"print(len(load_site(Path({str(path)!r})).trees), 'pyogrio' in sys.modules)"
    )
    done = subprocess.run([sys.executable, "-c", script], capture_output=True, text=True, check=True)
    assert done.stdout.split() == ["1", "False"]


def test_content_takes_precedence_over_the_extension(tmp_path):
    path = write_layer(tmp_path / "farm.gpkg", "trees", [shapely.Point(LON, LAT)])
    assert len(load_site(path.rename(tmp_path / "farm.json")).trees) == 1
    for name, data in (
        ("a", collection(point(LON, LAT))),
        ("b", b"lat,lon\n37.26,-120.42"),
        ("c", kml(placemark(LON, LAT))),
    ):
        (tmp_path / name).write_bytes(data)
        assert len(load_site(tmp_path / name).trees) == 1
