"""Missions flown by a robot with known figures give those figures back; what says nothing is refused."""

from __future__ import annotations

import itertools
import math
from dataclasses import replace
from datetime import datetime, timedelta

import pytest

from fieldhand import finished_missions
from fieldhand.compatibility import UTC
from fieldhand.errors import InputError, OutputError, ProfileError, TaskError
from fieldhand.evaluation.calibration import history
from fieldhand.evaluation.calibration.calibrate import calibrate
from fieldhand.evaluation.calibration.measured_steps import MeasuredMission, MeasuredStep, measure_mission
from fieldhand.robot.loader import load_robot, parse_profile, profile_bytes, robot_names
from fieldhand.robot.rewrite import figure, with_figures
from fieldhand.task.event_lines import to_json
from fieldhand.task.results import Arrived, Driving, Faulted
from support.missions.measured import PROFILE, TRUE, mission

NOW = datetime(2026, 5, 1, tzinfo=UTC)


def test_a_robot_with_known_figures_gives_them_back():
    found = calibrate(PROFILE, [measure_mission(mission(seed, speeds=(0.8, 0.4))) for seed in range(6)])
    fit = found.fit
    assert fit.legs.alpha.contains(0.7)
    assert fit.legs.scale.contains(1.0)
    assert fit.legs.alpha.high - fit.legs.alpha.low < 0.15
    assert fit.drive.value == pytest.approx(130.0, rel=1e-6)
    assert fit.idle.value == pytest.approx(75.0, rel=1e-6)
    assert fit.energies["take_thermal_picture"].value == pytest.approx(900.0, rel=1e-6)
    assert fit.durations["take_thermal_picture"].value == pytest.approx(11.0)
    assert set(fit.durations) == {"take_thermal_picture"}
    assert found.after.errors[1] < found.before.errors[1]
    assert abs(found.after.percent - found.actual[1]) < abs(found.before.percent - found.actual[1])


def test_speed_is_that_of_the_legs_that_were_not_told_to_be_slower():
    robot = replace(TRUE, speed_m_s=1.0)
    slower = [measure_mission(mission(seed, speeds=(1.0, 0.3))) for seed in range(3)]
    assert calibrate(robot, slower).fit.speed.value == pytest.approx(1.0)


def test_at_one_speed_idle_power_cannot_be_told_and_stays_while_the_forecast_is_right():
    found = calibrate(PROFILE, [measure_mission(mission(seed)) for seed in range(4)])
    assert found.fit.idle is None
    assert any("idle_w" in why for why in found.fit.kept)
    fitted = found.fit.profile(PROFILE)
    for metres, made in ((100.0, 0), (40.0, 7)):
        expected = TRUE.percent(metres, metres / 0.8 + 11 * made, 900.0 * made)
        assert fitted.percent(metres, metres / 0.8 + 11 * made, made * fitted.actions[0].energy_j) == pytest.approx(
            expected
        )


def test_legs_that_come_out_longer_than_planned_are_counted_as_planned():
    long = [
        replace(e, leg_m=1.3 * e.leg_m) if isinstance(e, Arrived) else e
        for seed in (0,)
        for e in mission(seed, stops=150)
    ]
    found = calibrate(PROFILE, [measure_mission(long)])
    assert found.fit.stretch == pytest.approx(1.3, rel=0.1)
    fitted = found.fit.profile(PROFILE)
    planned = sum(e.planned_m for e in long if isinstance(e, Driving))
    took = sum(b.t - a.t for a, b in itertools.pairwise(long) if isinstance(a, Driving))
    assert planned / fitted.speed_m_s == pytest.approx(took, rel=0.1)


def test_what_happened_between_does_not_count_as_driving_or_capturing():
    events = mission(1, stops=3)
    waited = Faulted(t=events[1].t, node="n", fault="x", what="", handled=True)
    steps = measure_mission([*events[:2], waited, *events[2:]]).steps
    assert math.isnan(steps[0].seconds)
    assert not steps[0].done
    assert steps[1].seconds == pytest.approx(11.0)


def test_a_drive_that_failed_does_not_spoil_the_energy():
    events = mission(1, stops=3)
    lost = [e for k, e in enumerate(events) if k != 2]  # a drive that never arrived, then a capture
    assert [s.sure for s in measure_mission(lost).steps] == [False, True, True, True, True, True]


@pytest.mark.parametrize("count", [0, 5, 19])
def test_too_few_legs_are_refused(count):
    with pytest.raises(InputError, match=f"{count} legs of at least"):
        calibrate(PROFILE, [measure_mission(mission(0, stops=count))])


def test_steps_whose_figures_are_no_numbers_are_left_out():
    events = mission(0, stops=30)
    broken = [replace(e, leg_m=math.nan) if isinstance(e, Arrived) and k < 9 else e for k, e in enumerate(events)]
    found = calibrate(PROFILE, [measure_mission(broken)])
    assert found.left_out["values that are not numbers"] == 3
    assert math.isfinite(found.fit.legs.alpha.value)


def test_logs_that_cannot_be_used_are_refused(tmp_path):
    log = tmp_path / "e.jsonl"

    def read(events, robot=PROFILE):
        log.write_text("".join(f"{to_json(e)}\n" for e in events))
        return finished_missions.measured_missions(robot, [log], tmp_path)

    assert len(read(mission(0))) == 1
    with pytest.raises(InputError, match="was recorded by the robot 'husky', not 'amiga'"):
        read(mission(0), load_robot("amiga"))
    with pytest.raises(InputError, match="identifies its robot"):
        read(mission(0)[1:])
    with pytest.raises(InputError, match="no driven missions of husky are stored"):
        finished_missions.measured_missions(PROFILE, [], tmp_path)
    log.write_text('{"event": "arrive", "leg_m": {}}\n')
    with pytest.raises(TaskError, match="line 1: not an event"):
        finished_missions.measured_missions(PROFILE, [log], tmp_path)


def test_the_same_log_twice_is_one_mission(tmp_path):
    log = tmp_path / "e.jsonl"
    log.write_text("".join(f"{to_json(e)}\n" for e in mission(0)))
    assert len(finished_missions.measured_missions(PROFILE, [log, log], tmp_path)) == 1


def test_what_is_kept_comes_back_and_the_same_mission_once(tmp_path):
    events = [mission(seed, stops=4) for seed in range(3)]
    saved = [finished_missions.save_history(tmp_path, PROFILE, e, NOW) for e in (*events, events[0])]
    assert saved == [True, True, True, False]
    kept = history.load_missions(tmp_path, "husky")
    assert repr([m.steps for m in kept]) == repr([measure_mission(e).steps for e in events]), "nan is not itself"
    assert all(m.simulated for m in kept)
    with pytest.raises(InputError, match=r"3 simulated ones are: --simulated takes them"):
        finished_missions.measured_missions(PROFILE, [], tmp_path)
    assert len(finished_missions.measured_missions(PROFILE, [], tmp_path, simulated=True)) == 3


def test_what_is_kept_is_bounded(tmp_path, monkeypatch):
    monkeypatch.setattr(history, "MOST_MISSIONS", 5)
    monkeypatch.setattr(history, "MOST_STEPS", 21)
    for k in range(9):
        driven = MeasuredMission(
            key=str(k), task="t", robot="husky", simulated=False, steps=(MeasuredStep(kind="leg"),) * 7
        )
        history.save_mission(tmp_path, PROFILE, driven, NOW + timedelta(days=k))
    assert [m.key for m in history.load_missions(tmp_path, "husky")] == ["6", "7", "8"]
    large = MeasuredMission(
        key="large", task="t", robot="husky", simulated=False, steps=(MeasuredStep(kind="leg"),) * 70
    )
    history.save_mission(tmp_path, PROFILE, large, NOW)
    assert [m.key for m in history.load_missions(tmp_path, "husky")] == ["large"]


def test_a_damaged_history_is_one_clear_line(tmp_path):
    history.history_file(tmp_path, "husky").write_bytes(b"no database at all" * 100)
    with pytest.raises(InputError, match="is not a history of missions"):
        history.load_missions(tmp_path, "husky")
    with pytest.raises(OutputError, match="cannot be stored"):
        finished_missions.save_history(tmp_path, PROFILE, mission(0, stops=1), NOW)


def test_the_new_profile_differs_in_figures_alone_and_is_another_profile():
    found = calibrate(PROFILE, [measure_mission(mission(seed)) for seed in range(3)])
    data = finished_missions.calibrated_profile(PROFILE, found, at=NOW)
    new = parse_profile(data)
    assert new.sha256 != PROFILE.sha256
    assert new.speed_m_s == pytest.approx(0.8, rel=1e-3)
    assert new.action["take_thermal_picture"].duration_s == 11.0
    assert new.action["read_co2"] == PROFILE.action["read_co2"]
    old_lines, new_lines = profile_bytes("husky")[0].decode().splitlines(), data.decode().splitlines()
    assert new_lines[0].startswith("# Calibrated 2026-05-01 from 90 legs")
    assert PROFILE.sha256 in new_lines[0]
    changed = [(a, b) for a, b in zip(old_lines, new_lines[1:], strict=True) if a != b]
    assert 3 <= len(changed) <= 6
    assert all(a.partition("#")[2] == b.partition("#")[2] for a, b in changed), "comments stay"


@pytest.mark.parametrize("name", robot_names())
def test_each_figure_of_a_profile_can_be_rewritten(name):
    robot, data = load_robot(name), profile_bytes(name)[0]
    keys = [("leg_cost", "alpha"), ("speed_m_s",), ("energy", "idle_w"), ("energy", "drive_j_per_m")]
    keys += [("actions", a.name, k) for a in robot.actions if a.implement is None for k in ("duration_s", "energy_j")]
    again = parse_profile(with_figures(data, dict.fromkeys(keys, 0.4321), note="n\nm: [x"))
    assert again.leg_cost.alpha == again.speed_m_s == again.energy.idle_w == again.actions[-1].energy_j == 0.4321
    with pytest.raises(ProfileError, match=r"'energy\.volts' is not in the text"):
        with_figures(data, {("energy", "volts"): 1.0}, note="")


@pytest.mark.parametrize(
    ("value", "said"),
    [(0.0, "0"), (1234567.0, "1235000"), (0.98765, "0.9877"), (8.0, "8"), (0.00001234, "0.000012340000")],
)
def test_figures_are_written_plainly(value, said):
    assert figure(value) == said
