"""The replay of a log agrees with the mission, whatever the plan, where visits are left out because of an event."""

from __future__ import annotations

import numpy as np
import pytest

from fieldhand.evaluation.log_replay import replay_log
from fieldhand.execution.drivers.simulation.world import ScriptedEvent, World
from fieldhand.task.results import Acted, Ended, Shed, Worked
from missions.agreement import Drawn, husky, orchard
from support.missions.rig import Rig, of_type
from support.missions.watched import watch, watching


@pytest.mark.parametrize("response", ["wait", "skip", "skip_row"])
@pytest.mark.parametrize("seed", range(40))
def test_every_capture_is_found_where_the_plan_has_it(seed, response):
    plan = Drawn(np.random.default_rng(seed)).plan()
    task = watching(plan, watch("gate_closed", response))
    world = World(events=(ScriptedEvent(event="gate_closed", chance=0.3, every_s=40, for_s=15),))
    events = Rig(site=orchard(), robot=husky(), world=world, seed=seed).fly(task).events
    assert isinstance(events[-1], Ended)
    counts = replay_log(task.composition.plan, events)
    made = [e for e in events if isinstance(e, Acted | Worked) and e.status == "success"]
    done = {name: sum(e.node == name for e in made) for name in counts}
    assert {name: count.done for name, count in counts.items()} == done
    if events[-1].status == "completed":
        assert {name: count.seen for name, count in counts.items()} == done
        left_out = [e for e in of_type(events, Shed) if e.cause == "event"]
        assert all(count.left_out == 0 for count in counts.values()) or left_out
