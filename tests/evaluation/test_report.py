"""The report: what other programs and people read of a mission."""

from __future__ import annotations

import base64
import csv
import io
import json
import math
import re
import unicodedata
from dataclasses import replace

import pytest
from hypothesis import given, settings
from hypothesis import strategies as st
from lxml import html

from fieldhand.errors import OutputError
from fieldhand.evaluation.outcome import judge
from fieldhand.evaluation.report.log_facts import branch_taken
from fieldhand.evaluation.report.maps import draw_map, report_maps
from fieldhand.evaluation.report.marks import driven_ways
from fieldhand.evaluation.report.observations import COLUMNS, observations_csv, observations_geojson
from fieldhand.evaluation.report.page import _printable as page_text
from fieldhand.evaluation.report.place_names import PlaceNames
from fieldhand.evaluation.report.readings import MOST_ROWS, relation, summaries
from fieldhand.evaluation.report.writing import write_report
from fieldhand.forecast.estimate import estimate
from fieldhand.hidden_characters import visible
from fieldhand.places.selectors import Corners
from fieldhand.site.loader import parse_site
from fieldhand.task.authorization import Authorization
from fieldhand.task.conditions import Compare
from fieldhand.task.plan import Act, ForEach, If, InOrder
from fieldhand.task.results import (
    Acted,
    Arrived,
    ClockSet,
    Continued,
    Decided,
    Driving,
    Ended,
    Exited,
    Faulted,
    InDoubt,
    Obstructed,
    Paused,
    Resumed,
    Shed,
    Started,
    Visiting,
    Waited,
)
from fieldhand.testing.small_orchard import husky, orchard, task_for

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


def page_of(files):
    """The page as a tree."""
    return html.document_fromstring(files.page.read_text(encoding="utf-8"))


def text_of(files):
    """Return the text that a reader sees of the page, one space between words."""
    body = page_of(files).find("body")
    return " ".join(" ".join(body.itertext()).split())


def test_the_report_says_what_was_asked_what_came_of_it_and_what_it_took(tmp_path):
    files = written(tmp_path / "new" / "folder", log(captured()), hashes=(("event log", "d" * 64),))
    text = text_of(files)
    assert all(path.is_file() for path in files.paths)
    assert "Do | <b>it</b>" in text
    assert "Returned (low budget): 0 of 1 goal met." in text
    assert "Take a thermal picture 1 4 ✗ not met" in text
    assert "33 m forecast" in text
    assert "2.5 % forecast" in text
    assert "3 places given up, though to be done, because the budget would probably not have been enough" in text
    assert "1:21: the lens is *dirty* (worked around)" in text
    assert re.search(r"1:15 row \d, position \d tree 1 Canopy temperature 31.5 °C", text)
    assert "33 °C" not in text, "no condition holds it against the profile's word for low"
    assert "simulated with seed 4" in text
    assert "Ada | Co, 2026-05-01T08:00:00+02:00" in text
    for digit in "abcd":
        assert digit * 64 in text


def test_the_report_says_what_became_of_the_words_where_the_task_says_it(tmp_path):
    told = replace(TASK, composition=replace(TASK.composition, nominal_said=((6, 7),)))
    assert "End b Not in the plan b" in " ".join(text_of(written(tmp_path, log(), task=told)).split())
    assert "How the words were planned" not in text_of(written(tmp_path, log()))


def test_a_log_that_was_cut_off_is_reported_as_such(tmp_path):
    for k in range(5):
        assert "Cut off: the log ends before" in text_of(written(tmp_path, log(captured())[:k]))


def test_no_estimate_and_no_approval_are_said_to_be_missing(tmp_path):
    text = text_of(written(tmp_path, log(), estimate=None, authorization=None))
    assert "forecast 3" not in text
    assert "Approved by unknown" in text


HOSTILE = (
    "<script>alert(1)</script>",
    '"><img src=x onerror=alert(1)>',
    "</style><script>alert(1)</script>",
    "{{ 7 * 7 }}{% for x in r %}",
    "\u202egnirts\u2066\x00\x1b[31m",
    "$\\frac{1}{0}$",
    "javascript:alert(1)",
    "a" * 300,
    "'\"&amp;<!--",
    "日本語 🌳",
)


@pytest.mark.parametrize("hostile", HOSTILE)
def test_nothing_that_came_from_outside_is_more_than_text(tmp_path, hostile):
    named = visible(hostile)  # what is hidden, a reader of sites refuses
    features = [
        {
            "type": "Feature",
            "geometry": {"type": "Point", "coordinates": [t.place.lon, t.place.lat]},
            "properties": {"kind": "tree", "id": f"{named}{t.place.id}", "row": f"{named}{t.index // 5}"},
        }
        for t in SITE.trees
    ]
    site = parse_site(
        json.dumps({"type": "FeatureCollection", "features": features}).encode(), name=named, lenient=True
    )
    tree = site.trees[0].place
    act = captured(place=tree.id, lat=tree.lat, lon=tree.lon, what=hostile, units={"canopy_temperature": hostile})
    events = [
        replace(log()[0], robot=hostile, site=hostile),
        Visiting(t=0, node="n1", places=tuple(t.place.id for t in site.trees)),
        act,
        replace(act, status="failed", readings={}),
        Decided(t=3, node="n2", holds=True, why=hostile),
        Shed(t=4, node="n1", places=(hostile, tree.id), optional=True, reason=hostile, chance_short=0.4),
        Faulted(t=5, node="n2", fault=hostile, what=hostile),
        Ended(t=9, status="faulted", lat=0, lon=0, travelled_m=1.0, charge_percent=90, reason=hostile),
    ]
    command = replace(TASK.command, request=hostile, assumptions=(hostile,))
    by = replace(AUTHORIZATION, by=hostile, confirmed=(hostile,))
    files = written(
        tmp_path, events, site=site, task=replace(TASK, command=command), authorization=by, estimate=None,
        robot=replace(ROBOT, name=hostile),
    )  # fmt: skip
    tree = page_of(files)
    tags = {e.tag for e in tree.iter() if isinstance(e.tag, str)}
    assert not tags & {"script", "iframe", "object", "embed", "link", "form", "base", "a"}
    assert not [e for e in tree.iter() if not isinstance(e.tag, str)], "no comments"
    assert [e.get("src")[:26] for e in tree.iter("img")] == ["data:image/svg+xml;base64,"]
    attributes = {name for e in tree.iter() if isinstance(e.tag, str) for name in e.attrib}
    assert not [name for name in attributes if name.startswith("on") or name in ("href", "style", "srcdoc")]
    assert len(tree.findall(".//style")) == 1
    source = files.page.read_text(encoding="utf-8")
    assert not {c for c in source if unicodedata.category(c) in ("Cc", "Cf", "Cs") and c != "\n"}
    assert " ".join(tree.find(".//blockquote").text_content().split()) == " ".join(page_text(hostile).split())


def test_the_page_asks_for_nothing_outside_itself(tmp_path):
    source = written(tmp_path, log(captured())).page.read_text(encoding="utf-8")
    assert "default-src 'none'" in source
    assert "url(" not in source
    assert "http" not in source.replace("http-equiv", "")
    drawing = base64.b64decode(re.search(r"svg\+xml;base64,([^\"]+)", source)[1]).decode()
    assert set(re.findall(r"https?://[^\"\s]+", drawing)) <= {
        "http://www.w3.org/2000/svg", "http://www.w3.org/1999/xlink", "http://www.w3.org/Graphics/SVG/1.1/DTD/svg11.dtd",
    }  # fmt: skip
    assert "<script" not in drawing


def test_the_same_mission_gives_the_same_page(tmp_path):
    one, two = (written(tmp_path / name, log(captured())).page.read_bytes() for name in "ab")
    assert one == two


def test_what_the_budget_left_out_is_folded_into_a_line(tmp_path):
    shed = [
        Shed(
            t=k,
            node="n1",
            places=(str(k),),
            optional=True,
            reason=f"tree {k}: 9{k} % chance",
            names_places=True,
            chance_short=0.9 + k / 100,
        )
        for k in (1, 2, 3, 7)
    ]
    files = written(tmp_path, [*log()[:2], *shed, log()[-1]])
    (said,) = [li for li in page_of(files).iter("li") if "left out because" in li.text_content()]
    line = " ".join(said.find("span").text_content().split())
    assert line.startswith(
        "4 places left out because the budget would probably not have been enough"
        " (91 to 97 % chance of running short): "
    )
    assert len(line) < 220
    assert len(said.findall(".//details//li")) == 4


@settings(max_examples=40)
@given(st.lists(st.integers(1, 20), min_size=1, max_size=40))
def test_many_trees_in_words_name_each_once(numbers):
    said = PlaceNames(SITE).many([str(n) for n in numbers])
    named = 0
    for part in re.split(r", (?=row|trees? )", said):
        for run in re.sub(r"^.*positions? ", "", part).replace(" and ", ", ").split(", "):
            first, _, last = run.partition(" to ")
            named += 1 if not last else int(last) - int(first) + 1
    assert named == len(set(numbers))


def test_places_that_the_end_kept_from_being_reached_are_named(tmp_path):
    text = text_of(written(tmp_path, [*log(captured())[:5], replace(log()[-1], status="faulted")]))
    assert "3 places not reached because the mission ended with a fault before" in text
    assert "not reached" not in text_of(
        written(tmp_path, [*log(captured())[:5], replace(log()[-1], status="completed")])
    )


@given(value=st.floats(-1e6, 1e6), limit=st.floats(-1e6, 1e6), digits=st.integers(0, 5))
def test_a_reading_is_never_said_to_lie_on_a_threshold_that_it_misses(value, limit, digits):
    said = relation(value, (limit,), digits, " x")
    assert said.startswith("exactly") == (value == limit)
    if abs(value - limit) > 1e-5:
        assert not re.match(r"[0.]+ x ", said), said
    assert (" above " in said) == (value > limit)


def test_a_reading_has_the_thresholds_that_the_plan_holds_it_against_and_no_others(tmp_path):
    warm = Compare(reading="n2", quantity="canopy_temperature", test="gt", value=30.0, unit="degC")
    then = If(id="n8", condition=warm, then=Act(id="n9", action="read_co2"))
    plan = replace(TASK.composition, plan=InOrder(id="n0", steps=(TASK.composition.plan, then)))
    events = log(captured(node="n2", value=31.5), captured(node="n7", value=36.0))
    files = written(tmp_path, events, task=replace(TASK, composition=plan))
    rows = [
        [" ".join(cell.text_content().split()) for cell in row]
        for row in page_of(files).findall(".//table[@class='readings']/tbody/tr")
    ]
    assert [row[-1] for row in rows] == ["1.5 °C above 30 °C", ""]
    assert "above 30 °C 1 of 1" in text_of(files)


def test_more_readings_than_a_page_holds_are_left_to_the_csv(tmp_path):
    files = written(tmp_path, log(*(captured(t=k) for k in range(MOST_ROWS + 5))))
    assert len(page_of(files).findall(".//table[@class='readings']/tbody/tr")) == MOST_ROWS
    assert "all are in observations.csv" in text_of(files)
    assert len(files.csv.read_text().splitlines()) == MOST_ROWS + 6


cells = st.one_of(st.text(max_size=12), st.sampled_from(("=1+1", "+1", "-1", "@x", "\t=x", '",=1', "\r\n=2")))


@settings(max_examples=60)
@given(place=cells, what=cells, value=st.floats())
def test_csv_comes_back_as_it_went_in_and_no_text_begins_a_formula(place, what, value):
    event = captured(value=value, place=place, what=what)
    header, row = csv.reader(io.StringIO(observations_csv([event]), newline=""))
    assert tuple(header) == COLUMNS
    found = dict(zip(header, row, strict=True))
    for name, text in (("place", place), ("what", what)):
        assert found[name].removeprefix("'") == visible(text).removeprefix("'")
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
    below = list(csv.DictReader(io.StringIO(observations_csv([captured(place="-1")]))))
    assert below[0]["place"] == "'-1", "text stays text"


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


def test_there_is_a_map_for_each_quantity_with_its_values_and_its_unit():
    events = log(captured(), captured("5", 36.0), captured("16", readings={"co2": 400.0}, units={"co2": "ppm"}))
    maps = report_maps(SITE, events, summaries(TASK, ROBOT, events))
    assert [(m.title, m.summary.unit, m.summary.values) for m in maps] == [
        ("Canopy temperature", " °C", (31.5, 36.0)), ("CO₂", " ppm", (400.0,)),
    ]  # fmt: skip
    assert [len(m.scale) > 1 for m in maps] == [True, False], "a scale of one value says nothing"


def test_no_two_names_on_a_map_cover_each_other():
    site = orchard(12, 14)
    places = [t.place for t in site.trees[::3]]
    events = [captured("1", 30 + k / 7, place=p.id, lat=p.lat, lon=p.lon) for k, p in enumerate(places)]
    figure, _ = draw_map(site, events, summaries(TASK, ROBOT, events)[0])
    renderer = figure.canvas.get_renderer()
    names = [t for t in figure.axes[0].texts if t.get_gid() in ("value", "row", "zone")]
    boxes = [t.get_window_extent(renderer) for t in names]
    assert sum(t.get_gid() == "value" for t in names) > 20
    assert not [
        (a, b) for k, a in enumerate(boxes) for b in boxes[:k] if a.shrunk(0.9, 0.7).overlaps(b.shrunk(0.9, 0.7))
    ]


def test_a_map_shows_captures_that_measure_nothing_and_those_that_failed():
    events = log(captured(readings={}), captured("5", status="failed"))
    (drawn,) = report_maps(SITE, events, summaries(TASK, ROBOT, events))
    meanings = [meaning for _, _, meaning in drawn.legend]
    assert {"Take a thermal picture", "failed", "driven", "given up, though to be done"} <= set(meanings)
    tried_again = log(captured("5", status="failed"), captured("5", attempt=2))
    (drawn,) = report_maps(SITE, tried_again, summaries(TASK, ROBOT, tried_again))
    assert "failed" not in [meaning for _, _, meaning in drawn.legend]


def test_ways_are_where_the_log_says_in_local_metres():
    (first, _), (second, _) = driven_ways(SITE, log())
    assert first[0] == pytest.approx(SITE.start.xy, abs=1e-3)
    assert second[-1] == pytest.approx(SITE.by_id["20"].place.xy, abs=1e-3)


def test_the_comparison_is_with_the_branch_that_was_taken():
    cold = Compare(reading="r", quantity="canopy_temperature", test="lt", value=33.0, unit="degC")
    first = Act(id="", action="take_thermal_picture", at=Corners(which=("nw",)), reading="r")
    then = Act(id="", action="read_co2", at=Corners(which=("se",)))
    task = task_for(SITE, InOrder(id="", steps=(first, If(id="", condition=cold, then=then))))
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


def faulty_log():
    """A mission in whose way something stood, that was cut off and paused, and that did not come to two trees."""
    five = SITE.by_id["5"].place
    begun, rest = log(captured()), log()[-1]
    where = {"kind": "tree", "place": "5", "lat": five.lat, "lon": five.lon}
    area = ((five.lat, five.lon), (five.lat + 1e-5, five.lon), (five.lat, five.lon + 1e-5))
    return [
        *begun[:-5],
        Obstructed(
            t=76, node="n1", travelled_m=7.0, blocked=(area,), unreachable=("5", "16"), what="a ladder", **where
        ),
        Waited(t=77, node="n1", wanted="way", seconds=60.0, over=False),
        InDoubt(t=78, node="n2", action="take_thermal_picture", then="skip", what="the power was cut", **where),
        Resumed(t=78, lat=five.lat, lon=five.lon, charge_percent=97.0),
        ClockSet(t=79, by_s=-60.0),
        Paused(t=80, reason="lunch"),
        Continued(t=81),
        Shed(t=82, node="n1", places=("5", "16"), optional=False, reason="no way", cause="unreachable"),
        Shed(t=82, node="n1", places=("20",), optional=False, reason="it is far", chance_short=0.4),
        replace(rest, t=90),
    ]


def test_faults_doubts_and_interruptions_stand_under_right_headings(tmp_path):
    read = text_of(written(tmp_path, faulty_log()))
    told = read[read.index("Faults, doubts and interruptions") : read.index("What it took")]
    for said in ("a ladder", "waited 1:00", "at tree 5 is in doubt; it was not taken again",
                 "continues after a power cut", "clock was set back", "paused (lunch)", "continued"):  # fmt: skip
        assert said in told
    left = read[read.index("What was not done") : read.index("Faults, doubts")]
    assert "2 places given up, though to be done, because no way led to them" in left
    assert (
        "1 place given up, though to be done, because the budget would probably not have been enough (40 % chance"
        in left
    )
    table = read[read.index("Every reading") : read.index("Record")]
    assert "in doubt" in table


def test_the_map_tells_what_no_way_led_to_from_what_the_budget_left_out():
    (shown,) = report_maps(SITE, faulty_log(), summaries(TASK, ROBOT, faulty_log()))
    meanings = [meaning for _, _, meaning in shown.legend]
    for meaning in ("something stands in the way", "no way led there", "capture in doubt", "went on after a power cut"):
        assert meaning in meanings
    assert "given up, though to be done" in meanings
    without = [e for e in faulty_log() if not isinstance(e, Shed) or e.cause == "unreachable"]
    (shown,) = report_maps(SITE, without, summaries(TASK, ROBOT, without))
    assert "given up, though to be done" not in [meaning for _, _, meaning in shown.legend]
    came = [*faulty_log()[:-1], captured("5"), captured("16")]
    (shown,) = report_maps(SITE, came, summaries(TASK, ROBOT, came))
    assert "no way led there" not in [meaning for _, _, meaning in shown.legend]


def test_the_bars_show_what_every_other_mission_and_nine_in_ten_stay_within(tmp_path):
    branch = estimate(TASK, SITE, ROBOT).worst
    files = written(tmp_path, log(captured()))
    assert (
        f"at most {branch.metres.p50:.0f} m half of the time, {branch.metres.p90:.0f} m nine times in ten"
        in text_of(files)
    )
    for bar in page_of(files).find_class("bar"):
        light, dark = (
            float(next(r.get("width") for r in bar.iter("rect") if r.get("fill") == fill))
            for fill in ("#d5ddd2", "#a9b8a5")
        )
        assert 0 < dark <= light <= 100
