"""Types on the wire: what is sent comes back, byte for byte as another implementation writes it."""

from __future__ import annotations

import math
import random
import struct
from dataclasses import replace
from typing import Any

import pytest
from hypothesis import given, settings
from hypothesis import strategies as st
from rosbags.typesys.store import Typestore

from fieldhand.execution.drivers.ros2 import transport as transport_module
from fieldhand.execution.drivers.ros2.dds.message_codec import Header, MessageCodec, Unreadable
from fieldhand.execution.drivers.ros2.dds.names import UserData, ros_type, wire_type
from fieldhand.execution.drivers.ros2.interfaces import FieldType, Interfaces
from fieldhand.execution.drivers.ros2.interfaces.definitions import INTEGERS, to_rosbags
from support.examples import examples

INTERFACES = Interfaces.of(
    "kilted",
    {
        "odd_msgs/msg/Keywords": "float64 from\nbyte[] class\nchar[3] serialize\nstring<=5[<=2] with\nbool[] is\n",
        "odd_msgs/srv/Ask": "Keywords[2] many\nwstring_free none\n---\n".replace("wstring_free none\n", "uint64 big\n"),
    },
)
CODEC = MessageCodec(INTERFACES)


def other_implementation() -> Typestore:
    store = Typestore()
    store.register({name: to_rosbags(INTERFACES.definition(name)) for name in INTERFACES.names()})
    return store


OTHER = other_implementation()


def drawn(kind: FieldType, chance: random.Random) -> Any:
    if kind.many != "one":
        size = kind.count if kind.many == "array" else chance.randint(0, min(kind.count or 3, 3))
        if kind.octets:
            return chance.randbytes(size)
        one = replace(kind, many="one", count=0)
        # An array of hundreds of values tells no more than a few.
        few = [drawn(one, chance) for _ in range(min(size, 3))]
        return tuple(few[n % 3] for n in range(size))
    if kind.base in INTEGERS:
        bits = INTEGERS[kind.base]
        least = -(1 << bits - 1) if kind.base.startswith("int") else 0
        return chance.choice([least, least + (1 << bits) - 1, least + chance.getrandbits(bits)])
    if kind.base == "string":
        text = "".join(chance.choices("aZ_ ü€𝄞\n", k=chance.randint(0, 5)))
        return text if not kind.most_characters else text.encode()[: kind.most_characters].decode(errors="ignore")
    if kind.base == "bool":
        return chance.random() < 0.5
    if kind.primitive:
        number = chance.choice([0.0, -math.inf, chance.gauss(0, 1e6)])
        return number if kind.base == "float64" else struct.unpack("f", struct.pack("f", number))[0]
    return drawn_message(kind.base, chance)


def drawn_message(name: str, chance: random.Random) -> dict[str, Any]:
    return {field: drawn(kind, chance) for field, kind in INTERFACES.fields(name).items()}


@settings(max_examples=examples(1, thorough=20), deadline=None)
@given(st.integers())
def test_every_interface_comes_back_and_others_write_the_same_bytes(seed: int) -> None:
    chance = random.Random(seed)
    assert len(INTERFACES.names()) > 200
    for name in INTERFACES.names():
        message = drawn_message(name, chance)
        sent = bytes(CODEC.encode(name, message).serialize())
        assert CODEC.decode(name, CODEC.type_of(name).deserialize(sent)) == message, name
        assert bytes(OTHER.serialize_cdr(OTHER.deserialize_cdr(sent, name), name)) == sent, name


def test_not_a_number_and_infinity_come_back() -> None:
    name = "sensor_msgs/msg/BatteryState"
    sent = CODEC.encode(name, {"voltage": math.nan, "charge": math.inf}).serialize()
    back = CODEC.decode(name, CODEC.type_of(name).deserialize(sent))
    assert math.isnan(back["voltage"])  # type: ignore[arg-type]
    assert back["charge"] == math.inf


def test_a_request_begins_with_whose_it_is_and_its_number() -> None:
    name = "odd_msgs/srv/Ask_Request"
    sent = CODEC.encode(name, {"big": 2**64 - 1}, Header(2**64 - 2, 7)).serialize()
    assert sent[4:20] == (2**64 - 2).to_bytes(8, "little") + (7).to_bytes(8, "little")
    back = CODEC.type_of(name, with_header=True).deserialize(sent)
    assert (back.guid, back.seq) == (2**64 - 2, 7)
    assert CODEC.decode(name, back)["big"] == 2**64 - 1
    assert len(CODEC.encode("odd_msgs/srv/Ask_Response", {}, Header(1, 1)).serialize()) == 4 + 16 + 1


@settings(max_examples=examples(20, thorough=200))
@given(st.data())
def test_bytes_that_do_not_fit_are_told_not_raised(data: st.DataObject) -> None:
    name = data.draw(st.sampled_from(["sensor_msgs/msg/NavSatFix", "nav2_msgs/action/NavigateToPose_FeedbackMessage"]))
    sent = bytes(CODEC.encode(name, {}).serialize())
    cut = data.draw(st.integers(4, len(sent) - 9))
    assert isinstance(CODEC.type_of(name).deserialize(sent[:cut]), Unreadable)


def test_a_message_that_is_too_large_is_not_unpacked(monkeypatch: pytest.MonkeyPatch) -> None:
    monkeypatch.setattr(transport_module, "MOST_BYTES", 1000)
    name = "std_msgs/msg/String"
    found = CODEC.type_of(name).deserialize(CODEC.encode(name, {"data": "x" * 1001}).serialize())
    assert isinstance(found, Unreadable)
    assert "more than 1000" in found.why
    # Images are larger than anything else that a robot sends.
    image = CODEC.encode("sensor_msgs/msg/Image", {"data": bytes(2000)}).serialize()
    sample = CODEC.type_of("sensor_msgs/msg/Image").deserialize(image)
    assert CODEC.decode("sensor_msgs/msg/Image", sample)["data"] == bytes(2000)
    monkeypatch.setattr(transport_module, "MOST_IMAGE_BYTES", 1000)
    assert isinstance(CODEC.type_of("sensor_msgs/msg/Image").deserialize(image), Unreadable)


def test_types_are_called_as_ros_calls_them() -> None:
    assert wire_type("nav2_msgs/action/NavigateToPose_SendGoal_Request") == (
        "nav2_msgs::action::dds_::NavigateToPose_SendGoal_Request_"
    )
    assert ros_type("nav2_msgs::action::dds_::NavigateToPose_SendGoal_Request_") == (
        "nav2_msgs/action/NavigateToPose_SendGoal"
    )
    assert ros_type(wire_type("sensor_msgs/msg/NavSatFix")) == "sensor_msgs/msg/NavSatFix"
    assert ros_type("HelloWorldData::Msg") == "HelloWorldData::Msg"


@settings(max_examples=examples(30, thorough=300))
@given(st.binary(max_size=60))
def test_user_data_of_anyone_are_read(data: bytes) -> None:
    assert all(isinstance(v, str) for v in UserData.parse(data).values.values())
    said = UserData(values={"clientid": "1.2", "typehash": "x"})
    assert UserData.parse(said.encoded()) == said
