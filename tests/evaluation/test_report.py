"""The report: what other programs and people read of a mission."""

from __future__ import annotations

import csv
import io
import json
import math
from dataclasses import replace

import pytest
from hypothesis import given, settings
from hypothesis import strategies as st

from fieldhand.errors import OutputError
from fieldhand.evaluation.outcome import judge
from fieldhand.evaluation.report import write_report
from fieldhand.evaluation.report_data import COLUMNS, as_text, observations_csv, observations_geojson
from fieldhand.evaluation.report_picture import draw_path_picture, driven_ways
from fieldhand.evaluation.report_text import branch_taken, escape
from fieldhand.forecast.estimate import estimate
from fieldhand.task.authorization import Authorization
from fieldhand.task.conditions import Compare
from fieldhand.task.plan import Act, ForEach, If, Sequence
from fieldhand.task.results import Acted, Arrived, Decided, Driving, Ended, Exited, Faulted, Shed, Started, Visiting
from fieldhand.task.selectors import Corners
from orchards import husky, orchard, task_for

SITE, ROBOT = orchard(), husky()
TASK = task_for(
    SITE, ForEach(id="", select=Corners(), body=Act(id="", action="take_thermal_picture")), "Do | <b>it</b>"
)
AUTHORIZATION = Authorization(
    by="Ada | Co", at="2026-05-01T08:00:00+02:00", task_sha256="a" * 64, site_sha256="b" * 64, robot_sha256="c" * 64
)


def captured(tree="1", value=31.5, status="success", **more):
    place = SITE.by_id[tree].place
    given = {
        "t": 75.0,
        "node": "n2",
        "action": "take_thermal_picture",
        "status": status,
        "kind": "tree",
        "place": tree,
        "lat": place.lat,
        "lon": place.lon,
        "readings": {"canopy_temperature": value} if status == "success" else {},
        "units": {"canopy_temperature": "degC"},
        "charge_percent": 98.0,
    }
    return Acted(**(given | more))


def drive(a, b, t=1.0):
    return Driving(t=t, node="n1", kind="tree", place=b.id, planned_m=9.0, path=((a.lat, a.lon), (b.lat, b.lon)))


def log(*captures):
    one, last = SITE.by_id["1"].place, SITE.by_id["20"].place
    start = SITE.start
    return [
        Started(
            t=0, task=TASK.id, robot="husky", site="orchard", lat=start.lat, lon=start.lon, charge_percent=99, seed=4
        ),
        Visiting(t=0, node="n1", places=("1", "5", "16", "20")),
        drive(start, one),
        Arrived(
            t=9, node="n1", kind="tree", place="1", lat=one.lat, lon=one.lon, leg_m=5, travelled_m=5, charge_percent=98
        ),
        *captures,
        drive(one, last, 80.0),
        Faulted(t=81, node="n2", fault="action_failed", what="the lens is *dirty*", handled=True),
        Shed(t=82, node="n1", places=("5", "16", "20"), optional=False, reason="no way home | else"),
        Exited(t=83, exit="faulted", then="return_to_end", reason="low budget"),
        Ended(t=90, status="returned", lat=0, lon=0, travelled_m=33.4, charge_percent=96.5, reason="low budget"),
    ]


def written(folder, events, **more):
    given = {
        "task": TASK,
        "site": SITE,
        "robot": ROBOT,
        "outcomes": judge(TASK, events),
        "authorization": AUTHORIZATION,
        "estimate": estimate(TASK, SITE, ROBOT),
    }
    return write_report(folder, events=events, **(given | more))


def test_the_report_says_what_was_asked_what_came_of_it_and_what_it_took(tmp_path):
    files = written(tmp_path / "new" / "folder", log(captured()))
    text = files.markdown.read_text(encoding="utf-8")
    assert all(path.is_file() for path in files.paths)
    assert r"> Do \| \<b\>it\</b\>" in text
    assert "**Returned** (low budget): 0 of 1 goal met." in text
    assert "| Take a thermal picture | 1 | 4 | ✗ failure |" in text
    assert "| Distance | 33 m |" in text
    assert "| Battery | 2.5 % |" in text
    assert "**mandatory**: 3 places (5, 16 and 20)" in text
    assert r"the lens is \*dirty\* (worked around)" in text
    assert "| 1:15 | tree 1 | take a thermal picture | canopy temperature 31.5 °C |" in text
    assert "simulated with seed 4" in text
    assert r"Approved by Ada \| Co" in text
    assert files.picture.read_bytes().startswith(b"\x89PNG")


def test_the_report_says_what_became_of_the_words_where_the_task_says_it(tmp_path):
    told = replace(TASK, composition=replace(TASK.composition, nominal_said=((6, 7),)))
    text = written(tmp_path, log(), task=told).markdown.read_text(encoding="utf-8")
    assert "- end: b\n" in text
    assert "- not in the plan: b\n" in text
    assert "by what became of them" not in written(tmp_path, log()).markdown.read_text(encoding="utf-8")


def test_a_log_that_was_cut_off_is_reported_as_such(tmp_path):
    for k in range(5):
        files = written(tmp_path, log(captured())[:k])
        assert "**Cut off**" in files.markdown.read_text(encoding="utf-8")


def test_no_estimate_leaves_the_comparison_out(tmp_path):
    text = written(tmp_path, log(), estimate=None).markdown.read_text(encoding="utf-8")
    assert "| Distance | 33 m |  |  |" in text
    assert "Nothing was captured." in text


def test_a_table_is_never_broken_by_what_it_holds(tmp_path):
    events = log(captured(place="a|b\n| c", what="x"), captured("5", action="take_thermal_picture"))
    lines = written(tmp_path, events).markdown.read_text(encoding="utf-8").splitlines()
    begin = lines.index("| Time | Place | Action | Reading |")
    rows = [line for line in lines[begin:] if line.startswith("|")]
    assert len(rows) == 4
    assert all(row.replace(r"\|", "").count("|") == 5 for row in rows)


@given(text=st.text(max_size=60))
def test_escaped_text_is_one_line_without_markup(text):
    line = escape(text)
    assert len(line.splitlines()) <= 1
    bare = line.replace("\\\\", "")
    for mark in "`*_[]|<>&~$":
        assert bare.count(mark) == bare.count(f"\\{mark}")
    assert not line.startswith(("#", "-", "+", "="))


cells = st.one_of(st.text(max_size=12), st.sampled_from(("=1+1", "+1", "-1", "@x", "\t=x", '",=1', "\r\n=2")))


@settings(max_examples=60)
@given(place=cells, what=cells, value=st.floats())
def test_csv_comes_back_as_it_went_in_and_no_text_begins_a_formula(place, what, value):
    event = captured(value=value, place=place, what=what)
    header, row = csv.reader(io.StringIO(observations_csv([event]), newline=""))
    assert tuple(header) == COLUMNS
    found = dict(zip(header, row, strict=True))
    for name, text in (("place", place), ("what", what)):
        assert found[name].removeprefix("'") == text.removeprefix("'")
        assert not found[name].startswith(("=", "+", "-", "@", "\t", "\r"))
    assert found["value"] == (str(value) if math.isfinite(value) else "")
    assert float(found["lat"]) == event.lat


def test_csv_has_a_row_for_each_reading_and_for_what_failed():
    two = captured(readings={"canopy_temperature": 30.0, "co2": -1.5}, units={"co2": "ppm"})
    rows = list(csv.DictReader(io.StringIO(observations_csv([two, captured(status="failed", what="dark")]))))
    assert [(r["quantity"], r["value"], r["unit"], r["status"]) for r in rows] == [
        ("canopy_temperature", "30.0", "", "success"),
        ("co2", "-1.5", "ppm", "success"),
        ("", "", "", "failed"),
    ]
    assert as_text("-1") == "'-1"


@settings(max_examples=40)
@given(value=st.floats(), lat=st.floats(-90, 90), lon=st.floats(-180, 180), what=st.text(max_size=9))
def test_geojson_is_what_rfc_7946_says(value, lat, lon, what):
    text = observations_geojson([captured(value=value, lat=lat, lon=lon, what=what)])

    def refuse(constant):
        raise AssertionError(f"{constant} is no JSON")

    collection = json.loads(text, parse_constant=refuse)
    assert collection["type"] == "FeatureCollection"
    (feature,) = collection["features"]
    assert feature["type"] == "Feature"
    assert feature["geometry"]["type"] == "Point"
    assert feature["geometry"]["coordinates"] == pytest.approx([lon, lat], abs=1e-7)
    assert feature["properties"]["canopy_temperature"] == (value if math.isfinite(value) else None)
    assert feature["properties"]["canopy_temperature_unit"] == "degC"


def test_the_picture_has_a_map_for_each_quantity_with_its_values_and_its_unit():
    events = log(captured(), captured("5", 36.0), captured("16", readings={"co2": 400.0}, units={"co2": "ppm"}))
    figure = draw_path_picture(SITE, events)
    bars = [ax for ax in figure.axes if ax.get_label() == "<colorbar>"]
    maps = [ax for ax in figure.axes if ax not in bars]
    assert [bar.get_ylabel() for bar in bars] == ["Canopy temperature [°C]", "CO₂ [ppm]"]
    assert [sum(line.get_gid() == "way" for line in ax.get_lines()) for ax in maps] == [2, 2]
    values = [c.get_array().tolist() for ax in maps for c in ax.collections if c.get_zorder() == 13]
    assert values == [[31.5, 36.0], [400.0]]


def test_the_picture_shows_captures_that_measure_nothing_and_those_that_failed():
    events = log(captured(readings={}), captured("5", status="failed"))
    (ax,) = draw_path_picture(SITE, events).axes
    assert ax.get_legend_handles_labels()[1] == ["Take a thermal picture", "Failed"]


def test_ways_are_where_the_log_says_in_local_metres():
    first, second = driven_ways(SITE, log())
    assert first[0] == pytest.approx(SITE.start.xy, abs=1e-3)
    assert second[-1] == pytest.approx(SITE.by_id["20"].place.xy, abs=1e-3)


def test_the_comparison_is_with_the_branch_that_was_taken():
    cold = Compare(reading="r", quantity="canopy_temperature", test="lt", value=33.0, unit="degC")
    first = Act(id="", action="take_thermal_picture", at=Corners(which=("nw",)), reading="r")
    then = Act(id="", action="read_co2", at=Corners(which=("se",)))
    task = task_for(SITE, Sequence(id="", steps=(first, If(id="", condition=cold, then=then))))
    forecast = estimate(task, SITE, ROBOT)
    for holds, captures in ((True, 2), (False, 1)):
        decided = Decided(t=1, node="n3", holds=holds, why="")
        assert branch_taken([decided], forecast).captures == captures
    assert branch_taken([Decided(t=1, node="n9", holds=True, why="")], forecast) == forecast.worst


def test_a_folder_that_cannot_be_written_is_one_clear_error(tmp_path):
    (tmp_path / "file").write_text("")
    with pytest.raises(OutputError, match="cannot be written"):
        written(tmp_path / "file" / "out", log())
    taken = tmp_path / "taken"
    (taken / "observations.csv").mkdir(parents=True)
    with pytest.raises(OutputError, match="cannot be written"):
        written(taken, log())
