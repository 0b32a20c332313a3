"""Reading a request clause by clause."""

from __future__ import annotations

from collections.abc import Hashable, Mapping, Sequence
from dataclasses import replace

from fieldhand.language import message
from fieldhand.places import selectors as s
from fieldhand.planning.grammar.dialogue.allowances import allowed, failing
from fieldhand.planning.grammar.dialogue.capturing import (
    capture,
    capture_again,
    capture_elided,
    is_across_each,
    meant_things,
)
from fieldhand.planning.grammar.dialogue.compared import in_both_cases, is_compared
from fieldhand.planning.grammar.dialogue.conditions import (
    captured_where,
    ends_among_visits,
    in_no_case,
    otherwise,
    pass_on,
    question,
    until,
    when,
)
from fieldhand.planning.grammar.dialogue.driving import (
    drive,
    driven_home,
    enter,
    go_home,
    is_there,
    limit_visits,
    put_in_order,
    with_order_kept,
    without_home,
)
from fieldhand.planning.grammar.dialogue.energy import done_until_low, recharged, reserve_in_percent
from fieldhand.planning.grammar.dialogue.exceptional import without_exceptional
from fieldhand.planning.grammar.dialogue.faults import Fork
from fieldhand.planning.grammar.dialogue.fitting import in_area, is_spoken_of
from fieldhand.planning.grammar.dialogue.fragments import assembled
from fieldhand.planning.grammar.dialogue.in_parts import shared_out
from fieldhand.planning.grammar.dialogue.intervals import at_intervals, with_intervals
from fieldhand.planning.grammar.dialogue.its_parts import with_its_parts
from fieldhand.planning.grammar.dialogue.likewise import with_known_place
from fieldhand.planning.grammar.dialogue.paces import paced, paced_drive, with_paces
from fieldhand.planning.grammar.dialogue.plans import (
    EMPTY,
    as_for_each,
    block_at,
    is_idle_case,
    node_at,
    walk,
    with_node,
    without_idle_cases,
)
from fieldhand.planning.grammar.dialogue.series import at_compared, is_by_reading, with_read_place
from fieldhand.planning.grammar.dialogue.slow import ruled
from fieldhand.planning.grammar.dialogue.state import (
    DialogueState,
    NotComposed,
    OpenQuestion,
    Setting,
    with_assumption,
    with_joints,
    with_step,
)
from fieldhand.planning.grammar.dialogue.that_ground import with_that_ground
from fieldhand.planning.grammar.dialogue.those_rows import with_those_rows
from fieldhand.planning.grammar.dialogue.totals import reported, with_total
from fieldhand.planning.grammar.dialogue.turns import as_meant
from fieldhand.planning.grammar.dialogue.waits import waited, with_settling
from fieldhand.planning.grammar.dialogue.watching import watched
from fieldhand.planning.grammar.dialogue.working import driven_along, driven_to_ground, work_along
from fieldhand.planning.grammar.meaning import (
    LAST_THING,
    After,
    Again,
    Allowed,
    CaptureCommand,
    CaptureWhere,
    Command,
    Connective,
    Correction,
    DriveCommand,
    Failing,
    Home,
    InAnOrder,
    InTurn,
    Lead,
    LimitClause,
    LinkedCommand,
    Otherwise,
    PaceClause,
    PassOn,
    PlaceMeaning,
    RankCommand,
    ReadingQuestion,
    RechargeClause,
    Reordered,
    Reported,
    Said,
    SettleClause,
    StopCommand,
    Total,
    UntilCondition,
    VisitLimit,
    WatchCommand,
    WayRule,
    When,
    WorkCommand,
    wait_seconds,
)
from fieldhand.planning.selections import (
    AREAS,
    anchors,
    are_rows,
    are_unvisited,
    has_open_number,
    is_block,
    is_by_attribute,
    is_in_block,
    over,
    specifies_part,
)
from fieldhand.task import plan as p

#: Maximum number of ways in which one parse is continued; a request that leaves more open is not composed.
_MOST_WAYS = 32
_IDLE = message("it does not say what to do there", context="fault")
_WHAT_THERE = message("say what to take or measure there")


def read_in_each_way(
    setting: Setting, said: Said, *, in_fragments: bool = False
) -> tuple[list[DialogueState], list[NotComposed]]:
    """Return the state after all clauses for each way to continue them, and the faults of ways that lead nowhere.

    Args:
        setting: Robot and site that the clauses are read for.
        said: Clauses.
        in_fragments: True to read fragments ("Row 6. Thermal.") as the commands that they make up together.
    """
    states: list[DialogueState] = []
    faults: list[NotComposed] = []
    waiting: list[Mapping[Hashable, int]] = [{}]
    while waiting:
        chosen = waiting.pop(0)
        try:
            states.append(read_clauses(replace(setting, chosen=chosen), said, in_fragments=in_fragments))
        except Fork as fork:
            waiting += [{**chosen, fork.key: way} for way in range(fork.count)]
            if len(states) + len(waiting) > _MOST_WAYS:
                return [], []
        except NotComposed as fault:
            faults.append(fault)
    return states, faults


def read_clauses(setting: Setting, said: Said, *, in_fragments: bool = False) -> DialogueState:
    """Return the state after all clauses.

    Raises:
        NotComposed: The clauses do not fit together.
        Fork: They can be continued in several ways, and ``setting`` does not say in which.
    """
    clauses, edits = as_meant(setting, with_intervals(at_compared(shared_out(said.clauses)), setting.site))
    if in_fragments and (whole := assembled(setting, clauses)) != clauses:
        clauses = whole
    elif in_fragments:
        raise NotComposed(_IDLE, advice=_WHAT_THERE)
    state = DialogueState(edits=edits)
    for k, clause in enumerate(clauses):
        try:
            state = _read(setting, state, clause, clauses[k + 1 :])
        except NotComposed as fault:
            raise fault.about(clause.command.used) from None
    ended = _ended(setting, with_order_kept(setting, capture_elided(setting, state)))
    return with_paces(setting, with_settling(setting, ended))


def _ended(setting: Setting, state: DialogueState) -> DialogueState:
    """Return the state at the end of the request.

    Raises:
        NotComposed: Something is missing.
    """
    state = driven_to_ground(setting, driven_along(setting, state))
    if state.open or state.awaits_command or state.order is not None:
        raise NotComposed(_IDLE, advice=_WHAT_THERE)
    state = _without_idle(state)
    if all(step.ends_plan for step in state.plan.steps):
        raise NotComposed(message("it asks for nothing to be done", context="fault"))
    _require_time_to_work(setting, state)
    for _, node in walk(state.plan):
        if (loop := as_for_each(node)) is not None and _visits_open_number(loop):
            raise NotComposed(message("how many of the others?", context="fault"))
        if loop is not None and loop.at_most is not None and all(step.only_drives for step in loop.body.children):
            raise NotComposed(_IDLE, advice=_WHAT_THERE)  # "(photograph the leeks,) but visit at most ten plants"
        if loop is not None and has_open_number(loop.select):
            said = setting.request.rstrip(" .")
            raise OpenQuestion(message("'{said}': at how many places?", context="question", said=said))
        if node.is_series and any(step.work is not None and step.work.goes_around for step in node.children):
            _require_no_end(state)
        if node.is_series and any(step.ends_plan for step in node.children[:-1]):
            raise NotComposed(message("something follows the end of the mission", context="fault"))
        if node.is_choice and EMPTY in node.children:
            raise NotComposed(message("nothing is said to be done in one of the cases", context="fault"))
        if node.is_optional_step and not any(one.act or one.work for one in p.walk(node)):
            raise NotComposed(message("it does not say what may be left out", context="fault"))
    if state.nominal is None and state.in_case is not None:
        cases = state.plan.steps[-1].children if state.plan.steps[-1].is_choice else ()
        both_drive = len(cases) > 1 and all(case.children and case.children[-1].only_drives for case in cases)
        return _ended_in_case(replace(state, nominal="stay" if both_drive else state.in_case))
    if state.nominal is None and state.plan.steps[-1].ends_plan:
        stays = state.plan.steps[-2].only_drives
        return replace(state, nominal="stay" if stays else None, nominal_said=state.plan.steps[-1].said)
    if state.nominal is None and state.returned and state.plan.steps[-1].only_drives:
        return replace(state, nominal="stay")
    if state.nominal is None and state.returned and _returns_in_a_case(state.plan.steps[-1]):
        return _ended_in_case(replace(state, nominal="stay"))  # "if it is wet, mow, otherwise return to the charger"
    return state


def _require_time_to_work(setting: Setting, state: DialogueState) -> None:
    """Ask about "in two hours" for work of which none may be left out: within that time, or after it?

    Raises:
        OpenQuestion: It may be when the work begins.
    """
    later = next((limit for limit in state.limits if limit.later), None)
    left_out = any(node.is_optional or node.is_optional_step for _, node in walk(state.plan))
    if later is None or left_out or state.nominal is not None:
        return
    asked = message(
        "'{said}': within that time, or not before it is over? Say 'within', or the time of day at which it begins.",
        context="question",
        said=setting.quoted(later.used),
    )
    raise OpenQuestion(asked)


def _chooses_among(drive: DriveCommand, command: object) -> bool:
    """Return True for "go to the courgettes and photograph every second one", which is one of them."""
    kind = drive.place
    if not isinstance(command, CaptureCommand) or command.place is None or drive.picks or drive.along:
        return False
    some = command.place
    if kind.shape != "several" or kind.per is not None or kind.count is not None or not is_by_attribute(kind.selector):
        return False
    if some.shape not in ("one", "several") or some.refers_back or some.per is not None or some.beside:
        return False
    return specifies_part(some.selector) and not some.selector.relative and not is_by_attribute(some.selector)


def _without_idle(state: DialogueState) -> DialogueState:
    """Return the state without conditions of which nothing depends ("if it is low, leave it")."""
    idle = [node for _, node in walk(state.plan) if is_idle_case(node)]
    if not idle:
        return state
    state = with_joints(state, tuple(span for node in idle for span in node.said))
    return replace(state, plan=without_idle_cases(state.plan))


def _returns_in_a_case(step: p.Node) -> bool:
    """Return True for a choice of which one case ends with a drive."""
    return step.is_choice and any(case.children and case.children[-1].only_drives for case in step.children)


def _ended_in_case(state: DialogueState) -> DialogueState:
    """Return the state after it was assumed where the mission ends if only some of the cases say so."""
    if state.nominal == "stay":
        sentence = message(
            "Where the mission ends depends on the case; in a case that does not say where, the robot stays.",
            context="assumption",
        )
    else:
        way = message(str(state.nominal).replace("_", " "), context="way")
        sentence = message("The mission ends there in any case ({way}).", context="assumption", way=way)
    return with_assumption(state, sentence)


def _require_no_end(state: DialogueState) -> None:
    """Refuse the end of laps that is said before anything is done ("until the battery is at 40 %, mow the bank, ...").

    Raises:
        NotComposed: It is not clear what goes on until then.
    """
    if any(limit.until for limit in state.limits):
        raise NotComposed(message("it is not clear what ends then", context="fault"))


def _visits_open_number(loop: p.ForEach) -> bool:
    """Return True for visits of "different trees" of which nothing says how many."""
    unbounded = not loop.optional and loop.at_most is None and loop.until is None
    return unbounded and are_unvisited(loop.select)


def _read(
    setting: Setting, state: DialogueState, clause: LinkedCommand, following: Sequence[LinkedCommand]
) -> DialogueState:
    """Return the state after a clause."""
    state, command = with_that_ground(state, with_those_rows(state, clause.command))
    joined_by = clause.before
    same_sentence = bool(state.commands_in_sentence) and not (joined_by is not None and joined_by.full)
    command = with_its_parts(setting, state, command, same_sentence=same_sentence)
    clause = replace(clause, command=command)
    if is_compared(clause.command):
        outer, cases = state.scope, in_both_cases(setting, capture_elided(setting, state), clause)
        for number, one in enumerate(cases):
            state = _read(setting, state, one, cases[number + 1 :])
        return replace(state, scope=outer, loop=None, captured=None)
    if isinstance(clause.command, WatchCommand):
        joined = () if clause.before is None else setting.spans_of(clause.before.used)
        return watched(setting, with_joints(state, joined), clause.command)
    if state.after_watch:
        _require_apart(clause)
        state = replace(state, after_watch=False)
    if is_by_reading(clause.command):
        state = capture_elided(setting, state)  # "at tree 4 and at tree 9, then ... at the hotter one"
    state, command = with_read_place(setting, state, clause.command)
    joint, command = clause.before, with_known_place(setting, state, command)
    if joint is not None and joint.first:
        return _do_before_last(setting, state, command, joint, following)
    if joint is not None and joint.each and not is_across_each(state, getattr(command, "place", None)):
        raise NotComposed(message("it is not clear what is done after each of them", context="fault"))
    if state.plan.steps and isinstance(command, CaptureCommand | DriveCommand | Lead | When | Again):
        state = driven_home(setting, state)
    if joint is not None and joint.then and isinstance(command, CaptureCommand | WorkCommand):
        state = _behind_optional_or_in_it(setting, state, command)
    elided = state.lead is not None and state.lead.relation == "of" and isinstance(command, CaptureCommand)
    own_place = _has_own_place(command) or elided
    own_place = own_place or (isinstance(command, Again) and command.whole)
    if joint is not None and (joint.both or joint.then) and own_place and state.commands_in_sentence:
        state = capture_elided(setting, state)  # "take a picture at tree 4, at tree 5 and read CO2 at tree 6"
    if joint is not None and joint.full:
        state = _new_sentence(setting, state, command)
    if joint is not None and joint.then and state.runs_on and isinstance(command, DriveCommand):
        scope = setting.either("in the other case only, or in each?", command.used, (state.scope, ()))
        state = replace(state, scope=scope, runs_on=False, loop=None)
    steps_on = isinstance(command, DriveCommand) and command.place.shape == "step"
    if joint is not None and (joint.from_here or (joint.then and steps_on)) and state.where is not None:
        here = PlaceMeaning(s.Here(), "one")
        state = replace(state, where=here, where_scope=state.scope, loop=None)
    if joint is not None and joint.then and isinstance(command, Home):
        command = replace(command, used=command.used | joint.used)  # "afterwards go home"
    elif joint is not None and (joint.then or joint.both):
        state = with_joints(state, setting.spans_of(joint.used))
    state = replace(state, sequenced=state.sequenced or (joint is not None and (joint.then or joint.in_turn)))
    match command:
        case CaptureCommand():
            if all(wait_seconds(thing.action) is not None for thing in command.things):
                return waited(setting, state, command, joint)
            state, command = at_intervals(setting, state, command)
            if command.instead and not _is_another_case(state):
                raise NotComposed(message("it is not clear what is not done then", context="fault"))
            if state.lead is not None and not state.lead.relation and (joint is None or joint.both):
                raise NotComposed(
                    message(
                        "it is not clear whether this announces what follows, or is a step of its own", context="fault"
                    )
                )  # "two trees get a picture"
            again = any(thing.action == LAST_THING for thing in command.things)
            counted = any(one.count for one in command.things)
            if command.relation == "bare" and counted and _says_number(state, joint, command):
                raise NotComposed(message("it is not clear whether this is done once more", context="fault"))
            if command.relation == "bare" and _continues(state, joint, again=again):
                command = replace(command, relation="at")  # "at tree 40 a picture, then CO2"
            elif command.relation == "bare" and state.lead is not None and joint is not None and not joint.both:
                command = replace(command, relation="at")  # "at every tree of row 3, a picture and CO2"
            one_more = command.relation == "plain" and any(thing.count for thing in command.things)
            decided = command.relation == "bare" and bool(following) and following[0].before is None
            decided = decided and (again or isinstance(following[0].command, When))
            if (again and one_more) or decided:
                command = replace(command, relation="at")  # "a second reading whenever the first is below 400 ppm"
            if command.relation == "bare" and (not state.open or (again and state.choice is None)):
                raise NotComposed(message("it does not say what to do with it", context="fault"))
            meant = replace(command, things=meant_things(setting, state, command.things))
            state = without_exceptional(setting, state, meant, joint)
            return replace(capture(setting, state, command), asked_for=command.of)
        case DriveCommand():
            if command.picks and not any(isinstance(one.command, CaptureCommand | CaptureWhere) for one in following):
                raise NotComposed(message("it does not say what to do with them", context="fault"))
            if command.ends and any(
                not isinstance(one.command, LimitClause | RechargeClause | WayRule) for one in following
            ):
                raise NotComposed(message("something follows the end of the mission", context="fault"))
            if joint is not None and (joint.full or joint.then or joint.both):
                state = driven_to_ground(setting, state)
            if following and _chooses_among(command, following[0].command):
                command = replace(command, place=replace(command.place, shape="area"))
            if joint is not None and joint.then and not any(_works_elsewhere(one.command) for one in following):
                state = _behind_optional_step(state)
            driven = drive(setting, state, command)
            if command.pace is not None:
                driven = paced_drive(setting, state, driven, command.pace)
            return _same_there(setting, state, driven, command, following) if command.instead else driven
        case WorkCommand():
            return work_along(setting, state, command)
        case Lead():
            if command.begins and state.plan.steps:
                raise NotComposed(message("where to begin has to be said before the work", context="fault"))
            if joint is not None and not (joint.full or joint.then or joint.both):
                _require_other_places(state, command.place)
            return _lead(setting, state, command)
        case Home():
            return go_home(setting, state, command)
        case StopCommand():
            ends = command.stays and state.plan.steps and not state.scope
            if ends and any(_works_elsewhere(one.command) for one in following):
                raise NotComposed(message("something follows the end of the mission", context="fault"))
            return _stop(setting, state, command)
        case When():
            begins = state.commands_in_sentence == 0
            return when(setting, state, command, [*_way_home(following, begins=begins), *_rest_of_sentence(following)])
        case CaptureWhere():
            return captured_where(setting, state, command)
        case Otherwise() if following and isinstance(following[0].command, PassOn):
            return in_no_case(capture_elided(setting, state), setting.spans_of(command.used))
        case PassOn():
            return pass_on(setting, state, command)
        case Otherwise():
            state = capture_elided(setting, state)  # "read CO2 there and at tree 9, otherwise come home"
            if ends_among_visits(state):
                return _unless_ended(setting, state, command, following)
            runs_on = joint is None  # without a comma or a full stop nothing shows where the case ends
            said = setting.spans_of(command.used)
            return replace(otherwise(setting, state, said, in_all=command.in_all), runs_on=runs_on)
        case LimitClause():
            return _limit(setting, state, command)
        case PaceClause():
            return paced(setting, state, command, following)
        case SettleClause():
            return replace(state, settles=(*state.settles, command))
        case WayRule():
            return ruled(setting, state, command)
        case RechargeClause():
            return recharged(setting, state, command)
        case Allowed():
            return allowed(setting, state, command, _rest_of_sentence(following), joint)
        case UntilCondition():
            return until(setting, state, command)
        case RankCommand():
            return replace(state, ranking=command)
        case VisitLimit():
            return limit_visits(setting, state, command)
        case Total():
            return with_total(setting, capture_elided(setting, state), command)
        case Reported():
            return reported(setting, capture_elided(setting, state), command)
        case Again():
            return capture_again(setting, state, command)
        case InAnOrder():
            if not any(isinstance(clause.command, CaptureCommand) for clause in _rest_of_sentence(following)):
                state = capture_elided(setting, state)  # "pictures of row 1 from ... and of row 2 from ..."
            return put_in_order(setting, state, command)
        case After():
            return _after(setting, state, command)
        case ReadingQuestion():
            return question(setting, state, command)
        case Failing():
            return failing(setting, state, command)
        case InTurn() | Correction() | Reordered() | WatchCommand():
            raise AssertionError("these are resolved before the clauses are read")


def _unless_ended(
    setting: Setting, state: DialogueState, command: Otherwise, following: Sequence[LinkedCommand]
) -> DialogueState:
    """Return the state behind visits in one of which the mission may have ended ("..., otherwise come home").

    Raises:
        NotComposed: What follows is done in each visit, or behind them.
    """
    if not following or not isinstance(following[0].command, Home | DriveCommand):
        raise NotComposed(message("to which 'if' does it belong?", context="fault"))
    path = state.choice or ()
    choice = node_at(state.plan, path)
    said = replace(choice, said=(*choice.said, *setting.spans_of(command.used)))
    plan = with_node(state.plan, path, said)
    return replace(state, plan=plan, scope=(), loop=None, choice=None, in_case=None)


def _behind_optional_or_in_it(
    setting: Setting, state: DialogueState, command: CaptureCommand | WorkCommand
) -> DialogueState:
    """Return the state before work elsewhere that follows an optional step of the same sentence, or belongs to it.

    "Photograph the beans and, if there is time, the kale, then the beetroot" leaves it open; behind "if there is time,
    photograph the kale, then ..." all of it is optional.
    """
    if not _works_elsewhere(command):
        return state
    state = capture_elided(setting, state)
    behind = _behind_optional_step(state)
    if behind is state or state.commands_in_sentence <= len(state.block.steps):
        return state
    return setting.either("in that case only, or in each?", command.used, (behind, state))


def _behind_optional_step(state: DialogueState) -> DialogueState:
    """Return the state behind an optional step, to which a last drive does not belong ("..., then to the charger")."""
    step = state.scope[:-1]
    if not step or not node_at(state.plan, step).is_optional_step or not state.block.steps:
        return state
    return replace(state, scope=step[:-1], loop=None, captured=None)


def _require_apart(clause: LinkedCommand) -> None:
    """Raise an error for a way home that follows a wait ("wait 5 minutes and then come home"): it is a part of it."""
    joint = clause.before
    apart = joint is not None and joint.full and joint.used and not joint.then
    if isinstance(clause.command, Home | StopCommand) and not apart:
        raise NotComposed(message("it is not clear whether this follows the wait, or the plan", context="fault"))


def _stop(setting: Setting, state: DialogueState, command: StopCommand) -> DialogueState:
    """Return the state after the end of the mission."""
    said = setting.spans_of(command.used)
    if state.home is not None and not command.stays:
        return replace(state, nominal_said=(*state.nominal_said, *said))  # "..., then home, nothing else"
    if command.stays and not state.scope:
        before = state.nominal_said if state.nominal == "stay" else ()
        return replace(state, nominal="stay", nominal_said=(*before, *said))
    state = with_step(state, p.StopMission(id="", said=said))
    return replace(state, in_case="stay") if command.stays else state


def _same_there(
    setting: Setting,
    state: DialogueState,
    driven: DialogueState,
    command: DriveCommand,
    following: Sequence[LinkedCommand],
) -> DialogueState:
    """Return the state after what the first case captures was captured at the place of another case.

    Raises:
        NotComposed: It is not another case.
    """
    if not _is_another_case(state) or not state.things:
        raise NotComposed(message("it is not clear what is not done then", context="fault"))
    if any(isinstance(one.command, CaptureCommand) for one in _rest_of_sentence(following)):
        return driven
    return capture(setting, driven, CaptureCommand(state.things, None, command.used))


def _is_another_case(state: DialogueState) -> bool:
    """Return True behind "otherwise", and behind a condition that follows another one."""
    if not state.open or not state.scope:
        return False
    if state.scope[-1] == "otherwise":
        return True
    *outer, at, _ = state.scope
    before = block_at(state.plan, tuple(outer)).steps[: int(at)]
    return bool(before) and before[-1].is_choice


def _continues(state: DialogueState, joint: Connective | None, *, again: bool) -> bool:
    """Return True behind "then", "and" and a comma if a capture was the last step; ``again`` if it is repeated."""
    follows = joint is not None and not joint.full
    if not follows or state.scope or state.awaits_command or not state.plan.steps:
        return False
    last = state.plan.steps[-1]
    if joint is not None and not joint.then:
        return not again and (last.act is not None or last.visits_each)
    return last.act is not None


def _says_number(state: DialogueState, joint: Connective | None, command: CaptureCommand) -> bool:
    """Return True behind a comma for the captures made before it, of which it may give the number ("(4 pictures)")."""
    made = {one.action for one in state.things}
    return joint is not None and joint.bare and made == {one.action for one in command.things}


def _has_own_place(command: Command) -> bool:
    """Return True for a command that is done at a place of its own, and not at one that was named before it."""
    if not isinstance(command, CaptureCommand | DriveCommand):
        return isinstance(command, Home | StopCommand)
    return command.place is not None and command.place.shape == "one" and not command.place.selector.relative


def _works_elsewhere(command: Command) -> bool:
    """Return True for work that is done at a place of its own."""
    if isinstance(command, CaptureCommand | Lead):
        return command.place is not None and not is_spoken_of(command.place)
    return isinstance(command, WorkCommand) and command.along is not None


def _way_home(following: Sequence[LinkedCommand], *, begins: bool) -> list[LinkedCommand]:
    """Return the return that directly follows a condition, which then decides it ("if it is hot, come home").

    Args:
        following: Clauses behind the condition.
        begins: True if the condition begins its sentence ("above 35 degC and you come home").
    """
    first = following[0] if following else None
    if first is None or not isinstance(first.command, Home):
        return []
    joined = first.before is not None and not first.before.bare and not (begins and first.before.both)
    return [] if joined else [first]


def _rest_of_sentence(following: Sequence[LinkedCommand]) -> list[LinkedCommand]:
    """Return the clauses up to the end of the sentence that are neither limits nor the end of the mission."""
    found: list[LinkedCommand] = []
    for clause in following:
        if clause.before is not None and clause.before.full:
            break
        if not isinstance(clause.command, LimitClause | RechargeClause | WayRule | Home):
            found.append(clause)
    return found


def _new_sentence(setting: Setting, state: DialogueState, command: Command) -> DialogueState:
    """Return the state at the beginning of a sentence whose first command is known."""
    state = capture_elided(setting, state)
    if state.lead is not None and not state.lead.relation and _is_done_there(command, state.lead):
        state = replace(state, lead=replace(state.lead, relation="topic"))  # "Row 6. A picture of each tree."
    if state.open or (state.lead is not None and state.lead.relation != "topic"):
        raise NotComposed(_IDLE, advice=_WHAT_THERE)
    place = command.place if isinstance(command, CaptureCommand) else None
    if state.area is not None and not isinstance(command, When) and not is_there(setting, state.area, place):
        state = enter(setting, state, state.area)
    scope = state.scope if isinstance(command, Otherwise) else ()
    return replace(state, scope=scope, commands_in_sentence=0, within=None, each_of=None, runs_on=False)


def _is_done_there(command: Command, lead: Lead) -> bool:
    """Return True for a capture at places that were spoken of or are measured from one, or at each tree."""
    place = command.place if isinstance(command, CaptureCommand) else None
    if place is None:
        return False
    return is_spoken_of(place) or place.selector == s.Trees() or lead.place.selector in anchors(place.selector)


def _lead(setting: Setting, state: DialogueState, command: Lead) -> DialogueState:
    """Return the state in which the next command is done at a place."""
    state = capture_elided(setting, state)
    before, place = state.lead, command.place
    if before is not None and command.relation == "topic" and before.place.shape == "area" and before.place.per is None:
        place = in_area(setting, before, place)  # "in row 3 the CO2 matters: four trees will do"
        return replace(state, lead=replace(command, place=place, used=before.used | command.used))
    if (row := _row_of_block(before, place)) is not None and before is not None:
        return replace(state, lead=replace(command, place=row, relation="at", used=before.used | command.used))
    if command.things:
        state = replace(state, things=command.things)
    if state.awaits_command:
        raise NotComposed(message("it is not clear at which of two places this is done", context="fault"))
    return replace(state, lead=command)


def _row_of_block(before: Lead | None, place: PlaceMeaning) -> PlaceMeaning | None:
    """Return the rows of a block that two leads name together ("in the south block, row 31, ..."); None for others."""
    if before is None or before.relation == "topic" or before.place.per is not None or place.per is not None:
        return None
    for rows, block in ((place, before.place), (before.place, place)):
        in_block = is_in_block(rows.selector)
        if {rows.shape, block.shape} == {"area"} and is_block(block.selector) and not in_block:
            return replace(rows, selector=over(rows.selector, block.selector)) if are_rows(rows.selector) else None
    return None


def _require_other_places(state: DialogueState, place: PlaceMeaning) -> None:
    """Refuse places behind a comma that are part of the area before them ("in row 4, ... at the yellow trees").

    Raises:
        NotComposed: They are part of it.
    """
    last = state.where
    areas = last is not None and last.shape == "several" and any(isinstance(one, AREAS) for one in last.selector.walk())
    if areas and specifies_part(place.selector):
        raise NotComposed(
            message("it is not clear whether these are some of the places before, or others", context="fault")
        )


def _limit(setting: Setting, state: DialogueState, command: LimitClause) -> DialogueState:
    """Return the state after a limit."""
    said = setting.spans_of(command.used)
    if command.until and (repeated := done_until_low(setting, state, command)) is not None:
        return repeated
    state, command = reserve_in_percent(setting, state, command)
    state = replace(state, limits=(*state.limits, command), limits_said=(*state.limits_said, said))
    return replace(state, nominal="return_to_start") if command.back and state.nominal is None else state


def _do_before_last(
    setting: Setting, state: DialogueState, command: Command, joint: Connective, following: Sequence[LinkedCommand]
) -> DialogueState:
    """Return the state after a capture that is done before the command that was read last ("..., but first ...")."""
    steps = state.plan.steps
    if state.scope or not steps or following or not isinstance(command, CaptureCommand):
        raise NotComposed(message("it is not clear before what", context="fault"))
    if joint.of_all and command.place is not None and not command.place.selector.relative:
        made = capture(setting, DialogueState(readings=state.readings), command)
        plan = p.InOrder(id="", steps=(*made.plan.steps, *steps))
        return replace(
            with_joints(state, setting.spans_of(joint.used)), plan=plan, captured=None, loop=None, choice=None
        )
    last = steps[-1]
    if not last.visits_each and (last.act is None or last.act.at is None):
        raise NotComposed(message("it is not clear before what", context="fault"))
    state = capture(setting, replace(state, plan=EMPTY, loop=None, captured=None, where=None), command)
    plan = p.InOrder(id="", steps=(*steps[:-1], *state.plan.steps, last))
    return replace(with_joints(state, setting.spans_of(joint.used)), plan=plan, captured=None, loop=None)


def _done_after(setting: Setting, state: DialogueState, command: After) -> DialogueState:
    """Return the state after a command that is done before the only other one ("go to the charger after ...")."""
    steps = state.plan.steps
    if state.scope or state.commands_in_sentence > 1 or not steps or state.awaits_command or state.open:
        raise NotComposed(message("it is not clear after what", context="fault"))
    last = steps[-1]
    if not last.only_drives and not last.visits_each and (last.act is None or last.act.at is None):
        raise NotComposed(message("it is not clear after what", context="fault"))
    rest = replace(state.plan, steps=steps[:-1])
    done = _after(setting, replace(state, plan=rest, commands_in_sentence=0, loop=None, returned=False), command)
    plan = replace(done.plan, steps=(*done.plan.steps, last))
    return replace(
        done, plan=plan, captured=None, loop=None, returned=state.returned, where=state.where, where_scope=()
    )


def _after(setting: Setting, state: DialogueState, command: After) -> DialogueState:
    """Return the state after a command that is done before the others of its sentence, unless it was done already."""
    done, home = command.done, state.home
    if isinstance(done, CaptureCommand) and is_spoken_of(done.place):
        if {thing.action for thing in meant_things(setting, state, done.things)} <= {
            thing.action for thing in state.things
        }:
            return with_joints(state, setting.spans_of(command.used))
        raise NotComposed(message("it is not clear after what", context="fault"))
    if state.commands_in_sentence and home is None:
        return _done_after(setting, state, command)
    state = without_home(state) if home is not None else state
    state = with_joints(state, setting.spans_of(command.used & ~done.used))
    state = capture(setting, state, done) if isinstance(done, CaptureCommand) else drive(setting, state, done)
    # "Return to the start after photographing tree 9."
    return go_home(setting, state, home) if home is not None else state
