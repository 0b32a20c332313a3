"""All that a mission says while it runs and at its end is made of messages, and the catalogues have each of them."""

from __future__ import annotations

import re
from collections.abc import Iterator

import pytest

from fieldhand.evaluation.outcome import judge_end
from fieldhand.evaluation.progress import mission_progress
from fieldhand.language import kept_in_log, open_language
from fieldhand.wording.events import EventText, goal_names
from language.silent_language import silent_language
from support.missions.faulted_flights import Flown, fly

SPANISH = open_language("es")
SEEDS = range(16)


def printed(flown: Flown) -> Iterator[str]:
    """Return the text that ``run`` and ``status`` print of a mission."""
    event_text = EventText(flown.robot)
    yield from (line for line in map(event_text.line, flown.events) if line is not None)
    for count in range(0, len(flown.events) + 1, 3):
        now = mission_progress(flown.task, flown.robot, flown.events[:count], running=True)
        yield from (now.doing, now.near, kept_in_log(now.reason), *(g.why for g in now.goals))
        yield from (kept_in_log(one.why) for one in now.exceeded)
    _, reason, found = judge_end(flown.task, flown.events, flown.robot.energy.reserve_percent)
    yield from (kept_in_log(reason), *(kept_in_log(one.why) for one in found), *(o.why for o in flown.outcomes))
    yield from map(goal_names(flown.task, flown.robot), (goal.id for goal in flown.task.command.goals))


def names(flown: Flown) -> set[str]:
    """Words that no catalogue has: of the robot, the site, its places, its actions, and units."""
    actions = {a.name for a in flown.robot.actions} | {q.name for q in flown.robot.quantities}
    units = {"ppm", "degC", "percent", "C"}
    places = {t.place.id for t in flown.site.trees} | {z.name for z in flown.site.zones}
    nodes = {event.node for event in flown.events}
    whole = actions | units | places | nodes | {flown.robot.name, flown.site.name}
    return {word for name in whole for word in re.findall(r"[^\W\d]+", name)}


@pytest.mark.parametrize("seed", SEEDS)
def test_no_sentence_of_a_mission_with_faults_is_without_translation(seed: int) -> None:
    flown = fly(seed, demo=False)
    known, left = names(flown), []
    for line in printed(flown):
        said = SILENT.say(line)
        if words := [word for word in re.findall(r"[^\W\d]{2,}", said.replace("…", "")) if word not in known]:
            left.append((str(line), words))
    assert not left


SILENT = silent_language()


@pytest.mark.parametrize(
    ("kept", "spanish"),
    [
        (
            "12 m left; going to tree 14 and home takes 14 m on average, 31 % chance of running short",
            "quedan 12 m; ir al árbol 14 y volver toma 14 m de media, 31 % de probabilidad de que no alcance",
        ),
        ("ambient temperature 31.2 °C is not below 30 °C", "temperatura ambiente 31,2 °C no está por debajo de 30 °C"),
        (
            "CO₂ 380 ppm is below 400 ppm and ambient temperature 31 °C is between 30 °C and 32.5 °C",
            "CO₂ 380 ppm está por debajo de 400 ppm y temperatura ambiente 31 °C está entre 30 °C y 32,5 °C",
        ),
        (
            "drive to tree 4: something stands in the way at tree 5; trying again",
            "trayecto al árbol 4: algo cierra el paso en el árbol 5; se intenta de nuevo",
        ),
        ("451.5 m of 450 m driven: limit exceeded at 3:07, on the way to the end", None),
        ("rain is coming; the robot said so", "rain is coming; the robot said so"),
        ("x" * 10_000, "x" * 10_000),
    ],
)
def test_what_a_log_keeps_is_known_again(kept: str, spanish: str | None) -> None:
    said = SPANISH.say(kept_in_log(kept))
    if spanish is None:
        assert said != kept
    else:
        assert said == spanish
    assert kept_in_log(kept) == kept
