"""Driving speeds: of the whole mission, or of a part of it."""

from __future__ import annotations

from collections.abc import Mapping, Sequence
from dataclasses import replace

from fieldhand.language import Number, message
from fieldhand.planning.grammar.dialogue.state import (
    DialogueState,
    NotComposed,
    OpenQuestion,
    SaidPace,
    Setting,
    with_assumption,
)
from fieldhand.planning.grammar.meaning import LinkedCommand, PaceClause
from fieldhand.task import plan as p


def paced(
    setting: Setting, state: DialogueState, command: PaceClause, following: Sequence[LinkedCommand]
) -> DialogueState:
    """Return the state after a driving speed: that of the command that it stands with, or of the whole mission."""
    command = said_speed(setting, command)
    leads = state.commands_in_sentence == 0
    alone = leads and (not following or (following[0].before is not None and following[0].before.full))
    first = leads and not state.plan.steps
    step = len(state.plan.steps) - (0 if leads or state.awaits_command else 1)
    said = SaidPace(
        pace=command, said=setting.spans_of(command.used), step=max(0, step), of_all=alone or first
    )  # fmt: skip
    return replace(state, paces=(*state.paces, said))


def paced_drive(setting: Setting, before: DialogueState, after: DialogueState, pace: PaceClause) -> DialogueState:
    """Return the state after a drive at a speed of its own."""
    step = len(before.plan.steps) if not before.scope else len(before.plan.steps) - 1
    spans = setting.spans_of(pace.used)
    said = SaidPace(pace=said_speed(setting, pace), said=spans, step=max(0, step), of_drive=True)
    return replace(after, paces=(*after.paces, said))


def said_speed(setting: Setting, command: PaceClause) -> PaceClause:
    """Return a driving speed with its number.

    Raises:
        OpenQuestion: It has none.
    """
    if command.speed > 0.0:
        return command
    most = setting.robot.speed_m_s
    asked = message(
        "'{said}': how fast? Say a speed, such as {half} m/s or {quarter} m/s; {robot} drives at most {most} m/s.",
        said=setting.quoted(command.used),
        half=Number(f"{most / 2:g}"),
        quarter=Number(f"{most / 4:g}"),
        robot=setting.robot.name,
        most=Number(f"{most:g}"),
    )
    raise OpenQuestion(asked, command.used)


def slow_assumption(setting: Setting, state: DialogueState, pace: PaceClause) -> DialogueState:
    """Return the state with the assumption of how fast "slowly" is."""
    if not pace.slowly:
        return state
    slow = message(
        "'{said}' is taken as {speed} m/s, as the robot's profile says.",
        context="assumption",
        said=setting.quoted(pace.used),
        speed=Number(f"{pace.speed:g}"),
    )
    return with_assumption(state, slow)


def with_paces(setting: Setting, state: DialogueState) -> DialogueState:
    """Return the state at the end of the request, with its driving speeds in the plan or as that of the mission.

    Raises:
        NotComposed: A speed is faster than the robot, or several are said of one part.
    """
    state = replace(state, paces=tuple(_of_its_work(setting, state, said) for said in state.paces))
    for said in state.paces:
        require_possible(setting, said.pace)
        state = slow_assumption(setting, state, said.pace)
    drives = [k for k, step in enumerate(state.plan.steps) if any(one.selector is not None for one in p.walk(step))]
    whole: SaidPace | None = None
    parts: dict[int, SaidPace] = {}
    for said in state.paces:
        of_all = said.of_all or (not said.of_drive and len(drives) <= 1)
        if not of_all and not said.of_drive:
            of_all = setting.either("of the whole mission, or of this part?", said.pace.used, (True, False))
        if of_all:
            if whole is not None and whole.pace.speed != said.pace.speed:
                raise NotComposed(message("two speeds are said of the whole mission", context="fault"), said.pace.used)
            whole = said
        elif said.step in parts or said.step >= len(state.plan.steps) or not any(k <= said.step for k in drives):
            raise NotComposed(message("it is not clear where this speed applies", context="fault"), said.pace.used)
        else:
            parts[said.step] = said
    if whole is not None:
        state = with_assumption(state, _of_whole_mission(setting, whole))
    return replace(state, plan=replace(state.plan, steps=_paced(state.plan.steps, parts, drives)), speed=whole)


def _of_its_work(setting: Setting, state: DialogueState, said: SaidPace) -> SaidPace:
    """Return a share of the robot's speed as one of the speed at which it works: "film row 7 at half speed".

    Raises:
        NotComposed: It works at several speeds.
    """
    steps = state.plan.steps
    if not said.pace.share or said.of_drive:
        return said
    meant = steps if said.of_all or said.step >= len(steps) else steps[said.step : said.step + 1]
    actions = {node.work.action for step in meant for node in p.walk(step) if node.work is not None}
    tools = [setting.robot.action[name].implement for name in actions]
    speeds = {tool.speed_m_s for tool in tools if tool is not None}
    if not speeds or said.pace.share == 1.0:
        return said
    if len(speeds) > 1:
        raise NotComposed(message("the work is done at several speeds", context="fault"), said.pace.used)
    return replace(said, pace=replace(said.pace, speed=round(said.pace.share * speeds.pop(), 4)))


def _of_whole_mission(setting: Setting, said: SaidPace) -> str:
    """Return that a speed is that of the whole mission; that it is no limit, if the robot is slower anyway."""
    robot = setting.robot
    if said.pace.speed > robot.speed_m_s:
        most = Number(f"{robot.speed_m_s:g}")
        return message("{robot} drives at most {most} m/s anyway.", context="assumption", robot=robot.name, most=most)
    return message(
        "The robot drives at most {speed} m/s on the whole mission, the way home included.",
        context="assumption",
        speed=Number(f"{said.pace.speed:g}"),
    )


def _paced(steps: Sequence[p.Node], parts: Mapping[int, SaidPace], drives: Sequence[int]) -> tuple[p.Node, ...]:
    """Return steps with the speeds of some of them: each with what was done since the last drive before it."""
    found: list[p.Node] = []
    for k, step in enumerate(steps):
        found.append(step)
        if k not in parts:
            continue
        since = k - max(one for one in drives if one <= k)
        body = p.InOrder(id="", steps=tuple(found[len(found) - 1 - since :]))
        del found[len(found) - 1 - since :]
        found.append(p.Pace(id="", speed_m_s=parts[k].pace.speed, body=body, said=parts[k].said))
    return tuple(found)


def require_possible(setting: Setting, pace: PaceClause) -> None:
    """Refuse a speed at which the robot cannot drive.

    Raises:
        NotComposed: It is faster than the robot, or slower than a Task can say.
    """
    robot = setting.robot
    if pace.speed > robot.speed_m_s * (1 + 1e-9) and not pace.at_most:
        what = message(
            "{robot} drives at most {most} m/s", context="fault", robot=robot.name, most=Number(f"{robot.speed_m_s:g}")
        )
        raise NotComposed(what, pace.used, message("say a lower speed, or leave it out"))
    if pace.speed < 0.01:
        raise NotComposed(
            message("that is slower than a robot drives", context="fault"),
            pace.used,
            message("say a speed of at least 0.01 m/s"),
        )
