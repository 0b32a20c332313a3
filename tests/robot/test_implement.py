"""Implements: actions that are on while the robot drives, in a profile."""

from __future__ import annotations

import pytest
import yaml

from fieldhand.errors import ProfileError
from fieldhand.robot.implement import rate_unit
from fieldhand.robot.loader import load_robot, parse_profile, profile_bytes


@pytest.mark.parametrize(
    ("unit", "rate", "metres", "width_m", "amount"),
    [
        ("l/ha", 300.0, 1000.0, 2.0, 60.0),
        ("kg/ha", 100.0, 100.0, 1.0, 1.0),
        ("g/m2", 5.0, 10.0, 2.0, 100.0),
        ("g/m", 2.0, 50.0, 9.0, 100.0),
        ("l/km", 3.0, 500.0, 1.0, 1.5),
    ],
)
def test_an_amount_follows_from_rate_length_and_width(
    unit: str, rate: float, metres: float, width_m: float, amount: float
) -> None:
    parsed = rate_unit(unit)
    assert parsed is not None
    assert parsed.amount == unit.partition("/")[0]
    assert parsed.amount_for(rate, metres=metres, width_m=width_m) == pytest.approx(amount)


@pytest.mark.parametrize("unit", ["", "l", "l/h", "/ha", "l/ha/s", "3/ha"])
def test_other_units_are_not_rates(unit: str) -> None:
    assert rate_unit(unit) is None


def test_the_tractor_has_implements_and_actions_at_a_place() -> None:
    tractor = load_robot("tractor")
    assert set(tractor.implements) == {"mow", "spray", "film"}
    assert tractor.action["take_picture"].implement is None
    assert tractor.implements["spray"].implement.tank == 200  # type: ignore[union-attr]
    assert tractor.ros2 is not None
    switch = tractor.ros2.actions["spray"].switch
    assert switch is not None
    assert (switch.kind, switch.on, switch.off) == (
        "service",
        {"open": True, "rate_l_ha": "$rate_l_ha"},
        {"open": False},
    )


@pytest.mark.parametrize(
    ("action", "changes", "expected"),
    [
        ("spray", {"implement": None}, "the key 'duration_s' is missing"),
        ("spray", {"duration_s": 3}, "duration_s and energy_j belong to an action at a place"),
        ("spray", {"measures": ["soil_moisture"]}, "an implement measures nothing"),
        ("spray", {"implement": {"speed_m_s": 1, "rate": "rate"}}, "rate names 'rate', which is not a parameter"),
        ("spray", {"implement": {"speed_m_s": 1, "rate": "rate_l_ha"}}, "the rate is per area, so width_m is needed"),
        ("mow", {"implement": {"speed_m_s": 1, "tank": 4}}, "tank is given without rate"),
        ("mow", {"implement": {"speed_m_s": 1, "side": "top"}}, "implement.side"),
        ("mow", {"implement": {"speed_m_s": 0}}, "implement.speed_m_s"),
    ],
)
def test_an_unusable_implement_is_refused(action: str, changes: dict[str, object], expected: str) -> None:
    document = yaml.safe_load(profile_bytes("tractor")[0])
    document["actions"][action] |= changes
    with pytest.raises(ProfileError) as error:
        parse_profile(yaml.safe_dump(document).encode())
    assert expected in str(error.value)


def test_the_unit_of_a_rate_is_checked() -> None:
    document = yaml.safe_load(profile_bytes("tractor")[0])
    document["actions"]["spray"]["parameters"]["rate_l_ha"]["unit"] = "l"
    with pytest.raises(ProfileError, match="is not that of a rate"):
        parse_profile(yaml.safe_dump(document).encode())


@pytest.mark.parametrize(
    ("binding", "expected"),
    [
        ({"service": {"name": "mower", "type": "std_srvs/srv/Empty"}}, "has no switch"),
        ({"switch": {}}, "give either service or topic"),
        ({"switch": {"service": "mower", "topic": "mower"}}, "give either service or topic"),
        ({"switch": {"service": "mower", "type": "std_msgs/msg/Bool"}}, "does not belong to it"),
        ({"switch": {"service": "mower", "type": "a/srv/B"}}, "enable and disable must differ"),
        ({"switch": {"service": "m", "type": "a/srv/B", "enable": {"a": "$b"}, "disable": {"a": 0}}}, "'$b' is not a"),
        ({"switch": {"topic": "mower", "success": "ok"}}, "a topic answers nothing"),
    ],
)
def test_an_unusable_switch_is_refused(binding: dict[str, object], expected: str) -> None:
    document = yaml.safe_load(profile_bytes("tractor")[0])
    document["ros2"]["actions"]["mow"] = binding
    with pytest.raises(ProfileError) as error:
        parse_profile(yaml.safe_dump(document).encode())
    assert expected in str(error.value)


def test_only_an_implement_has_a_switch() -> None:
    document = yaml.safe_load(profile_bytes("tractor")[0])
    document["ros2"]["actions"]["take_picture"] = {"switch": {"service": "camera"}}
    with pytest.raises(ProfileError, match="only an implement has a switch"):
        parse_profile(yaml.safe_dump(document).encode())
