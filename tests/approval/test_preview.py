"""The map of a planned mission: every stop, every leg, every number."""

from __future__ import annotations

import pytest

from fieldhand.approval.preview import draw_map, save_map
from fieldhand.approval.readback import read_back
from fieldhand.approval.stops import plan_of
from fieldhand.errors import OutputError
from fieldhand.forecast.estimate import estimate
from fieldhand.places.selectors import Corners, TreeIs, Trees
from fieldhand.task.conditions import Compare
from fieldhand.task.frames import Budget, Constraints
from fieldhand.task.plan import Act, ForEach, If, InOrder, OptionalStep
from fieldhand.testing.small_orchard import block, husky, orchard, task_for

SITE, ROBOT = orchard(), husky()
PICTURE = Act(id="", action="take_thermal_picture")
COLD = Compare(reading="r", quantity="canopy_temperature", test="lt", value=33.0, unit="degC")
CORNERS = ForEach(id="", select=Corners(), body=PICTURE)
BRANCHING = InOrder(
    id="",
    steps=(
        Act(id="", action="take_thermal_picture", at=TreeIs(tree="1"), reading="r"),
        If(
            id="",
            condition=COLD,
            then=Act(id="", action="read_co2", at=TreeIs(tree="20")),
            otherwise=Act(id="", action="read_co2", at=TreeIs(tree="5")),
        ),
    ),
)


def drawn(plan, **more):
    task = task_for(SITE, plan, **more)
    forecast = estimate(task, SITE, ROBOT)
    words = read_back(task, SITE, ROBOT, forecast)
    return task, plan_of(task, [b.walk for b in forecast.branches], words.lines), words


def test_stops_of_a_loop_are_numbered_in_the_order_of_the_drive():
    _, plan, words = drawn(CORNERS)
    assert [stop.labels for stop in plan.stops] == [["1.1"], ["1.2"], ["1.3"], ["1.4"]]
    assert words.lines[0].number == 1
    assert {leg.certainty for leg in plan.legs} == {"certain"}
    assert plan.legs[0].points[0] == SITE.start.xy
    assert plan.legs[-1].points[-1] == SITE.markers["end"].xy
    for one, following in zip(plan.legs, plan.legs[1:], strict=False):
        assert one.points[-1] == following.points[0]


def test_what_hangs_on_a_reading_is_conditional_on_both_branches():
    _, plan, _ = drawn(BRANCHING)
    certain = {stop.place.id: (stop.certainty, stop.labels) for stop in plan.stops}
    assert certain == {"1": ("certain", ["1"]), "20": ("conditional", ["2"]), "5": ("conditional", ["3"])}
    assert sum(leg.certainty == "conditional" for leg in plan.legs) == 4


def test_optional_visits_are_drawn_as_the_budget_allows():
    budget = Constraints(budgets=(Budget(kind="distance_m", limit=60.0),))
    _, plan, _ = drawn(ForEach(id="", select=Trees(), body=PICTURE, optional=True), constraints=budget)
    assert plan.stops
    assert {stop.certainty for stop in plan.stops} == {"budget"}
    assert {leg.certainty for leg in plan.legs} == {"budget"}


def test_a_stop_of_an_optional_step_is_drawn_as_the_budget_allows_and_the_others_as_certain():
    step = OptionalStep(id="", body=Act(id="", action="read_co2", at=TreeIs(tree="20")))
    corner = Act(id="", action="take_thermal_picture", at=TreeIs(tree="1"))
    last = Act(id="", action="take_thermal_picture", at=TreeIs(tree="5"))
    _, plan, _ = drawn(InOrder(id="", steps=(corner, step, last)))
    shown = {stop.place.id: (stop.certainty, stop.labels) for stop in plan.stops}
    assert shown == {"1": ("certain", ["1"]), "20": ("budget", ["2"]), "5": ("certain", ["3"])}
    assert [leg.certainty for leg in plan.legs] == ["certain", "budget", "budget", "certain"]


@pytest.mark.parametrize("plan", [CORNERS, BRANCHING])
def test_every_stop_and_leg_stands_on_the_map_with_its_number(plan):
    task, gathered, words = drawn(plan, request="Do as the test says.")
    ax, panel = draw_map(task, SITE, gathered, words).axes
    lines = [line.get_gid() for line in ax.get_lines()]
    assert lines.count("leg") == len(gathered.legs)
    assert lines.count("stop") == sum(len(stop.actions) for stop in gathered.stops)
    assert "arrow" in lines
    labels = [text.get_text() for text in ax.texts if text.get_gid() == "label"]
    for stop in gathered.stops:
        assert f"{stop.labels[0]}  tree {stop.place.id}" in labels
    said = " ".join(text.get_text() for text in panel.texts)
    assert "Do as the test says." in said
    assert "Return to the end marker." in said
    assert "In all" in said


def test_a_request_of_any_text_is_drawn(tmp_path):
    request = "Pay $5 for a_b^c $x\n" + "and take pictures " * 400
    task = task_for(SITE, CORNERS, request=request)
    path = tmp_path / "deep" / "map.png"
    save_map(task, SITE, ROBOT, estimate(task, SITE, ROBOT), path)
    assert path.read_bytes().startswith(b"\x89PNG")


def test_a_map_that_cannot_be_written_is_one_clear_error(tmp_path):
    task = task_for(SITE, CORNERS)
    forecast = estimate(task, SITE, ROBOT)
    (tmp_path / "file").write_text("")
    with pytest.raises(OutputError, match="cannot be written"):
        save_map(task, SITE, ROBOT, forecast, tmp_path / "file" / "map.png")
    with pytest.raises(OutputError, match="not a supported picture format"):
        save_map(task, SITE, ROBOT, forecast, tmp_path / "map.mission")


def test_numbers_keep_off_the_names_of_the_site():
    site = orchard(zones=[block("zone", "wet corner", (-0.5, 3), (0.5, 4.6))])
    task = task_for(site, CORNERS)
    forecast = estimate(task, site, ROBOT)
    words = read_back(task, site, ROBOT, forecast)
    figure = draw_map(task, site, plan_of(task, [b.walk for b in forecast.branches], words.lines), words)
    figure.draw_without_rendering()
    texts = [t for t in figure.axes[0].texts if t.get_text()]
    (name,) = (t for t in texts if t.get_text() == "wet corner")
    numbers = [t for t in texts if t.get_gid() == "label"]
    assert len(numbers) == 4
    assert not any(t.get_window_extent().overlaps(name.get_window_extent()) for t in numbers)
