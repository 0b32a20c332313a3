"""The judge finds each mistake that is planted in a log, says what it is, and finds nothing in a log without one."""

from __future__ import annotations

import json
from dataclasses import replace
from typing import Any

import numpy as np
import pytest

from fieldhand.errors import CaseError
from fieldhand.testing.small_orchard import at as lon_lat
from fieldhand_bench.missions.case_form import ExpectForm
from fieldhand_bench.missions.case_site import CaseSite
from fieldhand_bench.missions.cases import Expected, ExpectedStep
from fieldhand_bench.missions.judge import judge
from fieldhand_bench.missions.log import read_log
from fieldhand_bench.missions.places import CasePlace, Positions
from support.missions.tampered import tampered

ROWS, COLUMNS = 4, 5


def degrees(tree: int) -> tuple[float, float]:
    lon, lat = lon_lat(*divmod(tree, COLUMNS))
    return lat, lon


def field() -> CaseSite:
    """Trees about 5 m apart, row by row from the south-west; the start is south of the first, the end of the last."""
    start, end = lon_lat(-1, 0), lon_lat(-1, COLUMNS - 1)
    return CaseSite(
        np.array([degrees(tree) for tree in range(ROWS * COLUMNS)]),
        tuple({"leaf_color": "green" if tree % 3 else "yellow"} for tree in range(ROWS * COLUMNS)),
        {"start": (start[1], start[0]), "end": (end[1], end[0])},
    )


GROUND = field()


def log(*acts: tuple[str, int], status: str = "completed", end: tuple[float, float] | None = None) -> list[str]:
    """A log of actions at trees, 10 m driven to each."""
    events: list[dict[str, Any]] = []
    for number, (action, tree) in enumerate(acts, start=1):
        lat, lon = degrees(tree)
        events.append({"event": "arrive", "lat": lat, "lon": lon, "travelled_m": 10.0 * number})
        events.append({"event": "action", "action": action, "status": "success", "lat": lat, "lon": lon})
    lat, lon = end or degrees(0)
    events.append({"event": "mission", "status": status, "lat": lat, "lon": lon, "travelled_m": 10.0 * len(acts)})
    return [json.dumps(event) for event in events]


def found(expect: dict[str, Any], lines: list[str]) -> str:
    """Return the faults; none if all is right."""
    expected = ExpectForm.model_validate(expect).expected()
    return "; ".join(judge(GROUND, expected, read_log(lines, GROUND)))


IN_ORDER = {
    "steps": [
        {"do": "photo", "at": {"corner": "sw"}, "as": "A"},
        {"do": "sniff", "at": {"same": "A"}},
        {"do": "photo", "n": 2, "at": {"next_to": "A"}},
        {"do": "photo", "at": {"corner": "ne"}},
    ],
    "max_travel_m": 60,
    "end": {"half": "south"},
}
DONE = [("photo", 0), ("sniff", 0), ("photo", 1), ("photo", 1), ("photo", 19)]


def test_what_was_asked_is_as_asked() -> None:
    assert found(IN_ORDER, log(*DONE)) == ""


@pytest.mark.parametrize(
    ("acts", "says"),
    [
        (DONE[:-1], "3 actions were done where 4 were asked for: 1 x photo missing"),
        ([*DONE, ("photo", 3)], "1 x photo too many"),
        ([*DONE, ("dance", 3)], "1 x dance too many"),
        (DONE[:3] + DONE[4:], "step 3 was to be photo x2 at {next_to: A}, and was photo x1"),
        ([("photo", 2), *DONE[1:]], "step 1 was to be photo x1 at {corner: sw}, and was photo x1 at the tree at pos"),
        ([DONE[0], ("sniff", 1), *DONE[2:]], "step 2 was to be sniff x1 at {same: A}"),
        ([*DONE[:2], ("photo", 2), ("photo", 2), DONE[4]], "step 3"),
        ([DONE[1], DONE[0], *DONE[2:]], "step 1 was to be photo"),
    ],
    ids=["missing", "too many", "uncalled for", "once", "wrong tree", "not the same", "no neighbour", "order"],
)
def test_each_step_is_what_when_and_where_it_was_asked(acts: list[tuple[str, int]], says: str) -> None:
    assert says in found(IN_ORDER, log(*acts))


def test_too_far_driven_and_a_wrong_end_are_said() -> None:
    far = [json.dumps(json.loads(line) | {"travelled_m": 61.0}) for line in log(*DONE)]
    assert found(IN_ORDER, far) == "61.0 m were driven, 60 m at most wanted"
    assert found(IN_ORDER, log(*DONE, end=degrees(19))) == "it did not end at {half: south}"
    assert "ended as aborted, wanted completed" in found(IN_ORDER, log(*DONE, status="aborted"))
    assert "does not say how the mission ended" in found(IN_ORDER, log(*DONE)[:-1])
    home = {"steps": [], "end": {"marker": "end"}}
    assert found(home, log(end=degrees(4))).startswith("it ended 5.0 m from the end marker")


def test_a_mission_that_was_to_be_given_up_must_be() -> None:
    assert found({"steps": [], "status": "returned"}, log()) == "the mission ended as completed, wanted returned"


NUMBERS = {
    "count_only": {"photo": [2, 3]},
    "distinct_trees": {"photo": [2, 3]},
    "at_all": {"half": "north", "attribute": {"leaf_color": "green"}},
    "min_steps": 2,
}


@pytest.mark.parametrize(
    ("acts", "says"),
    [
        ([("photo", 13), ("photo", 14)], ""),
        ([("photo", 13)], "photo was done 1 times, wanted 2 to 3"),
        ([("photo", 13), ("photo", 14), ("photo", 16), ("photo", 17)], "photo was done 4 times, wanted 2 to 3"),
        ([("photo", 13), ("photo", 14), ("sniff", 14)], "nobody asked for sniff"),
        ([("photo", 13), ("photo", 14), ("photo", 13)], "a tree was worked on twice"),
        ([("photo", 13), ("photo", 13)], "photo was done at 1 different trees, wanted 2 to 3"),
        ([("photo", 13), ("photo", 13)], "1 actions were done, 2 at least wanted"),
        ([("photo", 13), ("photo", 2)], "is not at {half: north, attribute: {leaf_color: green}}"),
        ([("photo", 13), ("photo", 15)], "is not at {half: north, attribute: {leaf_color: green}}"),
    ],
)
def test_numbers_trees_and_places_are_counted(acts: list[tuple[str, int]], says: str) -> None:
    wrong = found(NUMBERS, log(*acts))
    assert (says in wrong) if says else not wrong


def test_points_away_from_trees_are_well_only_where_they_are_asked_for() -> None:
    lines = log(("sniff", 0), ("sniff", 2), ("sniff", 4))
    between = [line.replace(str(degrees(2)[0]), str(degrees(2)[0] - 7e-5)) for line in lines]
    apart = {"count_only": {"sniff": [3, 3]}, "free_points": True, "apart_m": [9, 14]}
    assert "m from the nearest tree" in found({"count_only": {"sniff": [3, 3]}}, between)
    assert found(apart, between) == ""
    assert "two stops are 10.0 m apart, wanted 11 to 14 m" in found(apart | {"apart_m": [11, 14]}, lines)


def test_every_mistake_planted_in_a_log_is_found() -> None:
    names = []
    for mistake, lines in tampered(log(*DONE), degrees(7)):
        assert found(IN_ORDER, lines), mistake
        names.append(mistake)
    assert len(set(names)) == len(names) >= 13


@pytest.mark.parametrize(
    "line",
    ["{", "[]", '"x"', '{"event": "action", "status": "success", "lat": 1}', '{"event": "mission", "lat": "north"}',
     '{"event": "arrive", "travelled_m": "far"}',
     '{"event": "action", "status": "success", "action": "a", "lat": NaN, "lon": 0}'],
)  # fmt: skip
def test_a_log_that_cannot_be_judged_is_refused_with_the_line(line: str) -> None:
    with pytest.raises(CaseError, match="event log, line 2"):
        read_log(["", line], GROUND)


@pytest.mark.parametrize("seed", range(12))
def test_in_any_order_is_the_same_in_every_order(seed: int) -> None:
    rng = np.random.default_rng(seed)
    trees = rng.permutation(ROWS * COLUMNS)[: rng.integers(1, 9)].tolist()
    actions = rng.choice(["photo", "sniff"], len(trees)).tolist()
    # Each step is content with the tree that is worked on for it, and with some that are worked on for others.
    content = [frozenset({tree, *rng.permutation(trees)[:3].tolist()}) for tree in trees]
    steps = tuple(
        ExpectedStep(action=action, at=CasePlace(demands=(Positions(well),)))
        for action, well in zip(actions, content, strict=True)
    )
    acts = [(actions[k], trees[k]) for k in rng.permutation(len(trees)).tolist()]
    done = read_log(log(*acts), GROUND)
    expected = Expected(steps=steps, any_order=True)
    assert judge(GROUND, expected, done) == ()
    moved = replace(done, done=(replace(done.done[0], action="dance"), *done.done[1:]))
    assert judge(GROUND, expected, moved)


def test_in_any_order_steps_that_name_each_other_are_assigned_together() -> None:
    expect = {
        "order": "any",
        "steps": [
            {"do": "photo", "at": {"half": "north"}, "as": "A"},
            {"do": "sniff", "at": {"same": "A"}},
            {"do": "photo"},
        ],
    }
    # Both photos are in the north: only one of them can be the one at which there was a sniff.
    assert found(expect, log(("photo", 18), ("sniff", 12), ("photo", 12))) == ""
    assert "cannot be assigned" in found(expect, log(("photo", 18), ("sniff", 2), ("photo", 12)))


@pytest.mark.parametrize(
    ("place", "trees"),
    [
        ({"corner": "nw"}, {15}),
        ({"corner": "any"}, {0, 4, 15, 19}),
        ({"most": "north", "tol_m": 1}, {15, 16, 17, 18, 19}),
        ({"first": True}, {0, 1}),
        ({"last": True}, {19, 4, 3}),
        ({"attribute": {"leaf_color": "yellow"}, "half": "south"}, {0, 3, 6, 9}),
        ({"mid_edge": "south"}, {2, 7}),
    ],
)
def test_places_hold_for_the_trees_that_a_person_would_point_at(place: dict[str, Any], trees: set[int]) -> None:
    form = ExpectForm.model_validate({"steps": [{"do": "photo", "at": place}]}).expected()
    assert form.steps is not None
    assert {t for t in range(ROWS * COLUMNS) if form.steps[0].at.holds(GROUND, t, {})} == trees


@pytest.mark.parametrize(("metres", "fault"), [(4.9, ""), (5.1, "it drove 5.0 m from the trees {ids: [6]}")])
def test_drives_keep_away_from_trees(metres: float, fault: str) -> None:
    drive = {"event": "drive", "path": [degrees(0), degrees(1), degrees(2)]}  # past tree 6, a row farther north
    lines = [json.dumps(drive), *log(("photo", 2))]
    expect = {"steps": [{"do": "photo"}], "keeps_from": [{"trees": {"ids": [6]}, "m": metres}]}
    assert found(expect, lines).startswith(fault)
    assert bool(found(expect, lines)) == bool(fault)


@pytest.mark.parametrize(
    ("speed", "fault"),
    [(0.4, ""), (0.6, "it drove at 0.60 m/s within 3 m of the trees {ids: [2]}, 0.5 m/s at most wanted")],
)
def test_drives_are_slow_near_trees(speed: float, fault: str) -> None:
    """A drive that goes on at another speed counts with the part that was driven at each."""
    fast = {"event": "drive", "node": "n1", "place": "2", "path": [degrees(0), degrees(2)], "speed_m_s": 1.0}
    slow = {"event": "drive", "node": "n1", "place": "2", "path": [degrees(1), degrees(2)], "speed_m_s": speed}
    expect = {"steps": [{"do": "photo"}], "slow_near": [{"trees": {"ids": [2]}, "m": 3, "most_m_s": 0.5}]}
    assert found(expect, [json.dumps(fast), json.dumps(slow), *log(("photo", 2))]) == fault
    assert found(expect, [json.dumps(fast), *log(("photo", 2))]).startswith("it drove at 1.00 m/s")


# --- work along paths -------------------------------------------------------------------------------------------------

SPRAYED = {"worked": [{"do": "spray", "metres": [18, 22], "past": {"ids": [0, 1, 2, 3, 4]}}]}


def sprayed(row: int, last: int = COLUMNS - 1, action: str = "spray") -> list[str]:
    """A log of work beside one row, 1.5 m south of it."""
    corners = [(lat - 1.5 / 111_000.0, lon) for lat, lon in (degrees(row * COLUMNS), degrees(row * COLUMNS + last))]
    worked = {"event": "worked", "action": action, "status": "success", "travelled_m": 30.0, "paths": [corners]}
    return [json.dumps(worked), *log()]


def test_work_beside_the_right_row_is_as_asked() -> None:
    assert found(SPRAYED, sprayed(0)) == ""


@pytest.mark.parametrize(
    ("lines", "says"),
    [
        (log(), "spray was on along 0 m, wanted 18 to 22 m"),
        (sprayed(1), "5 of them not {ids: [0, 1, 2, 3, 4]}"),
        (sprayed(0, last=3), "spray was on along 15 m"),
        ([*sprayed(1)[:1], *sprayed(0)], "spray was on beside 10 trees"),
        (sprayed(0, action="mow"), "nobody asked for mow"),
        ([*sprayed(0)[:1], *log(("photo", 3))], "photo"),
    ],
)
def test_a_mistake_in_work_is_found(lines: list[str], says: str) -> None:
    assert says in found(SPRAYED, lines)


def test_work_that_nobody_asked_for_is_found() -> None:
    assert "nobody asked for spray" in found({"steps": []}, sprayed(0))
