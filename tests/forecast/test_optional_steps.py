"""An optional step on paper: done where it fits what is left, shed where it does not; what must follow is kept."""

from dataclasses import replace

import pytest
from hypothesis import given, settings
from hypothesis import strategies as st

from fieldhand.errors import PlaceError
from fieldhand.forecast.estimate import estimate, mandatory_part
from fieldhand.forecast.optional_visits import OptionalVisits
from fieldhand.forecast.remaining_work import remaining_work_after
from fieldhand.forecast.visit_order import drives_for, start_place
from fieldhand.forecast.walk_branch import walk_branch
from fieldhand.places.context import Context
from fieldhand.places.selectors import First, Here, Nearest, TreeIs, Trees, Where
from fieldhand.task import plan as p
from fieldhand.task.conditions import TreeHas
from fieldhand.task.frames import Budget, Constraints
from fieldhand.task.plan import Act, AnyOrder, ForEach, GoTo, If, InOrder, OptionalStep, Repeat, StopMission
from support.missions.paper import frames_at
from support.missions.rig import husky, orchard, task_for

SITE, ROBOT = orchard(), husky()
DRIVES = drives_for(SITE, ROBOT)
PICTURE = "take_thermal_picture"


def picture(tree=None, **more):
    return Act(id="", action=PICTURE, at=None if tree is None else TreeIs(tree=tree), **more)


def optional(*steps, reward=1.0):
    body = steps[0] if len(steps) == 1 else InOrder(id="", steps=steps)
    return OptionalStep(id="", body=body, reward=reward)


def steps(*nodes):
    return InOrder(id="", steps=nodes)


def within(metres):
    return Constraints(budgets=(Budget(kind="distance_m", limit=metres),))


def walked(plan, metres=1e6, **more):
    return walk_branch(task_for(plan, constraints=within(metres), **more), SITE, ROBOT, holds=lambda _: True)


def length(plan):
    return sum(walked(plan).legs_m)


def done(found):
    return [s.places[0].id for s in found.steps if s.kind == "act"]


def decided(found):
    """(done, shed) of each optional step that came up."""
    of = [s for s in found.steps if isinstance(s.node, OptionalStep)]
    assert all(s.kind == "visit-list" and len(s.places) + len(s.shed) == 1 for s in of)
    return [([p.id for p in s.places], [p.id for p in s.shed]) for s in of]


DETOUR = steps(picture("r0c0"), optional(picture("r3c2")), picture("r0c4"))
PLAIN = steps(picture("r0c0"), picture("r3c2"), picture("r0c4"))


def test_a_step_is_done_where_the_way_round_by_it_fits_and_shed_one_metre_below():
    enough = length(PLAIN) + 1e-6
    assert done(walked(DETOUR, enough)) == ["r0c0", "r3c2", "r0c4"]
    assert decided(walked(DETOUR, enough)) == [(["r3c2"], [])]
    assert done(walked(DETOUR, enough - 1.0)) == ["r0c0", "r0c4"]
    assert decided(walked(DETOUR, enough - 1.0)) == [([], ["r3c2"])]


@settings(max_examples=60, deadline=None)
@given(metres=st.floats(10, 200), trees=st.lists(st.sampled_from(sorted(SITE.by_id)), min_size=1, max_size=4))
def test_what_fits_without_optional_steps_fits_with_them(metres, trees):
    plan = steps(picture("r0c0"), *(optional(picture(t)) for t in trees), picture("r1c1"))
    must = steps(picture("r0c0"), picture("r1c1"))
    found = walked(plan, metres)
    assert done(found)[0] == "r0c0"
    assert done(found)[-1] == "r1c1"
    if length(must) <= metres:
        assert sum(found.legs_m) <= metres + 1e-6


def test_drives_inside_the_body_count_and_so_does_where_it_leaves_the_robot():
    body = (picture("r3c0"), picture("r3c4"))
    plan = steps(picture("r0c0"), optional(*body), picture("r0c1"))
    enough = length(steps(picture("r0c0"), *body, picture("r0c1"))) + 1e-6
    assert decided(walked(plan, enough)) == [(["r3c0"], [])]
    assert decided(walked(plan, enough - 1.0)) == [([], ["r3c0"])]


def test_a_body_is_one_visit_with_all_its_drives_and_work_on_its_longest_branch():
    yellow = TreeHas(attribute="variety", test="eq", value="Kerman")
    body = steps(
        picture("r3c0", count=2),
        If(id="", condition=yellow, then=picture("r3c4"), otherwise=picture("r3c1")),
    )
    node = OptionalStep(id="n1", body=body, reward=2.5)
    visit = OptionalVisits(task_for(node), SITE, ROBOT, DRIVES).of_step(node, Context(here=start_place(DRIVES)))
    action = ROBOT.action[PICTURE]
    assert (visit.place.id, visit.leaves.id, visit.reward) == ("r3c0", "r3c4", 2.5)
    assert visit.service_s == pytest.approx(3 * action.duration_s)
    assert visit.service_j == pytest.approx(3 * action.energy_j)
    assert visit.inside_m == pytest.approx(DRIVES.between(visit.place, visit.leaves).length_m)


def test_a_body_that_drives_nowhere_is_a_visit_to_the_place_in_hand():
    node = OptionalStep(id="n1", body=picture())
    here = DRIVES.stands((SITE.by_id["r2c2"].place,))[0]
    visit = OptionalVisits(task_for(node), SITE, ROBOT, DRIVES).of_step(node, Context(here=here))
    assert (visit.place, visit.inside_m, visit.leaves) == (here, 0.0, None)


def test_a_first_place_that_there_is_not_is_an_error():
    with pytest.raises(PlaceError):
        walked(steps(picture("r0c0"), optional(picture("r9c9"))))


def test_a_stop_in_a_step_that_is_shed_ends_nothing():
    plan = steps(picture("r0c0"), optional(picture("r3c4"), StopMission(id="")), picture("r0c1"))
    assert done(walked(plan, length(steps(picture("r0c0"), picture("r0c1"))) + 1)) == ["r0c0", "r0c1"]
    assert done(walked(plan)) == ["r0c0", "r3c4"]


def test_what_must_follow_and_a_walk_of_what_must_be_done_have_no_optional_step():
    task = task_for(steps(picture("r0c0"), optional(picture("r3c4")), picture("r0c1")))
    rest = remaining_work_after(
        task, SITE, ROBOT, DRIVES, frames_at(task.composition.plan, "n2"), Context(here=start_place(DRIVES))
    )
    assert rest.first.id == "r0c1"
    assert len(rest.legs_m) == 1
    assert rest.work.seconds == ROBOT.action[PICTURE].duration_s
    assert not any(isinstance(n, OptionalStep) for n in p.walk(mandatory_part(task).composition.plan))


def test_steps_of_an_any_order_set_may_be_optional():
    plan = AnyOrder(id="", steps=(picture("r0c4"), optional(picture("r3c0")), picture("r0c0")))
    assert sorted(done(walked(plan))) == ["r0c0", "r0c4", "r3c0"]
    tight = walked(plan, length(AnyOrder(id="", steps=(picture("r0c4"), picture("r0c0")))) + 1)
    assert sorted(done(tight)) == ["r0c0", "r0c4"]
    assert decided(tight) == [([], ["r3c0"])]


@pytest.mark.parametrize("order", ["best", "given"])
def test_an_optional_step_at_each_place_leaves_enough_for_the_places_that_remain(order):
    many = Where(attribute="variety", test="eq", value="Kerman")
    loop = ForEach(id="", select=many, body=steps(picture(), optional(picture(count=3))), order=order)
    bare = ForEach(id="", select=many, body=picture(), order=order)
    action = ROBOT.action[PICTURE]
    plain = walk_branch(task_for(bare), SITE, ROBOT, holds=lambda _: True)
    seconds = sum(s.seconds for s in plain.steps)
    budget = Budget(kind="duration_s", limit=seconds + 2.5 * 3 * action.duration_s)
    task = task_for(loop, constraints=Constraints(budgets=(budget,)))
    found = walk_branch(task, SITE, ROBOT, holds=lambda _: True)
    assert sum(s.seconds for s in found.steps) <= budget.limit
    assert [bool(places) for places, _ in decided(found)] == [True, True, *[False] * 6]
    assert done(found).count(done(plain)[-1]) == 1


def test_nested_loops_around_an_optional_step_are_set_aside_too():
    inner = ForEach(id="", select=Nearest(to=Here(), count=2), body=steps(picture(), optional(picture(count=4))))
    outer = ForEach(
        id="", select=Where(attribute="reward", test="eq", value=2.0), body=steps(GoTo(id="", place=Here()), inner)
    )
    plain = replace(outer, body=steps(GoTo(id="", place=Here()), replace(inner, body=picture())))
    seconds = sum(s.seconds for s in walk_branch(task_for(plain), SITE, ROBOT, holds=lambda _: True).steps)
    budget = Budget(kind="duration_s", limit=seconds + 1.0)
    found = walk_branch(task_for(outer, constraints=Constraints(budgets=(budget,))), SITE, ROBOT, holds=lambda _: True)
    assert len(decided(found)) == 8
    assert len(done(found)) >= 8


def test_in_a_repeat_the_step_is_decided_on_in_each_round():
    found = walked(Repeat(id="", times=3, body=steps(picture("r0c0"), optional(picture("r0c1")))))
    assert len(decided(found)) == 3


def test_the_estimate_counts_optional_steps_and_tells_those_that_do_not_fit():
    for metres, visits, shed in ((1e6, 1, []), (length(PLAIN) - 1, 0, ["r3c2"])):
        found = estimate(task_for(DETOUR, constraints=within(metres)), SITE, ROBOT)
        assert (found.worst.visits, [p.id for p in found.worst.shed]) == (visits, shed)
        assert found.problems == ()


def test_a_step_worth_nothing_is_never_done():
    assert decided(walked(steps(picture("r0c0"), optional(picture("r0c1"), reward=0.0)))) == [([], ["r0c1"])]


def test_an_optional_step_alone_in_a_try_or_branch_is_walked_as_any_other():
    body = If(id="", condition=TreeHas(attribute="variety", test="eq", value="x"), then=optional(picture("r0c1")))
    assert decided(walked(steps(GoTo(id="", place=First()), body))) == [(["r0c1"], [])]
    assert decided(walked(ForEach(id="", select=Trees(), body=optional(picture())))) != []
