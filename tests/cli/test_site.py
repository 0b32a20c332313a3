"""``fieldhand site``: what was understood of a site, short unless more is asked for, drawn, and as JSON."""

from __future__ import annotations

import json
from pathlib import Path

from fieldhand.site.random_orchards import random_orchard
from support.processes.command import fieldhand


def test_a_grower_reads_rows_aisles_and_what_can_be_reached() -> None:
    run = fieldhand("site", "demo")
    assert run.status == 0, run.err
    for words in (
        "10 rows running north-south (7 degrees east of north)",
        "named in the file",
        "Driving with the husky",
        "9 aisles",
        "Every tree can be reached",
        "Keep-out 'pond'",
    ):
        assert words in run.out


def test_another_robot_is_told_of_by_its_own_width() -> None:
    run = fieldhand("site", "demo", "--robot", "amiga", "--json")
    driving = json.loads(run.out)["driving"]
    assert driving["robot"] == "amiga"
    assert driving["width_m"] > 1.0


def test_json_has_every_row_and_tree_that_the_words_count(tmp_path: Path) -> None:
    made = random_orchard(4, trees=900, blocks=3)
    (tmp_path / "made.geojson").write_bytes(made.to_bytes())
    record = json.loads(fieldhand("site", "made.geojson", "--json", cwd=tmp_path).out)
    assert record["rows"] == len(record["row_table"]) > 30
    assert sum(row["trees"] for row in record["row_table"]) + record["in_no_row"] == record["trees"] == len(made.xy)
    assert len(record["aisle_table"]) == record["driving"]["aisles"]


def test_many_rows_are_listed_only_on_request(tmp_path: Path) -> None:
    (tmp_path / "made.geojson").write_bytes(random_orchard(4, trees=900, blocks=3).to_bytes())
    short = fieldhand("site", "made.geojson", cwd=tmp_path).out.splitlines()
    long = fieldhand("site", "made.geojson", "--rows", cwd=tmp_path).out.splitlines()
    assert len(short) < 30 < len(long)


def test_the_picture_is_drawn(tmp_path: Path) -> None:
    run = fieldhand("site", "demo", "--picture", "demo.png", cwd=tmp_path)
    assert "Map: demo.png" in run.out
    assert (tmp_path / "demo.png").read_bytes().startswith(b"\x89PNG")
