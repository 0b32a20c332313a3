"""``fieldhand bench coverage`` covers every generated block outside its headlands, and prints the figures of each."""

from __future__ import annotations

import json

import pytest

from fieldhand_bench.coverage.blocks import KINDS, make_blocks
from support.processes.command import fieldhand


@pytest.fixture(scope="module")
def measured():
    run = fieldhand("bench", "coverage", "--blocks", "5", "--repeats", "1", "--seed", "7", "--alone", "--json")
    assert run.status == 0, run.err
    return json.loads(run.out)


def test_every_block_is_covered_outside_its_headlands(measured):
    assert [block["kind"] for block in measured["blocks"]] == list(KINDS)
    for block in measured["blocks"]:
        assert block["ours"]["covered"] == pytest.approx(1.0, abs=1e-6), block["name"]
    assert measured["summary"]["least_covered"] == pytest.approx(1.0, abs=1e-6)


def test_the_figures_agree_with_the_block(measured):
    assert {"machine", "cpu", "cores", "load", "software"} <= measured["machine"].keys()
    for block in measured["blocks"]:
        ours = block["ours"]
        # No drive covers more than its length times the width.
        assert ours["length_m"] * block["width_m"] > 0.5 * block["hectares"] * 1e4
        assert ours["swaths"] > 1
        assert 0.0 <= ours["overlap"] < 1.0
        assert block["theirs"] is None


def test_the_table_fits_a_terminal():
    run = fieldhand("bench", "coverage", "--blocks", "2", "--repeats", "1", "--seed", "7", "--alone")
    assert run.status == 0, run.err
    rows = [line for line in run.out.splitlines() if " convex " in line or " concave " in line]
    assert len(rows) == 2
    assert all(len(row) <= 80 and "…" not in row for row in rows)


def test_blocks_are_the_same_for_a_seed_and_differ_between_seeds():
    few, more, other = make_blocks(4, 3), make_blocks(6, 3), make_blocks(4, 4)
    assert [block.area for block in few] == [block.area for block in more[:4]]
    assert all(one.area != two.area for one, two in zip(few, other, strict=True))
