"""Pydantic models of the ``ros2`` part of a profile file: its keys and their value ranges.

These models check the part by itself; :mod:`fieldhand.robot.bindings_loader` checks it against the actions and
quantities of the profile. The fields of message types can be checked only where the types are installed
(``fieldhand robot check``). docs/formats.md documents the keys.
"""

from __future__ import annotations

import math
import re
from typing import Annotated, Literal, get_args

from pydantic import AfterValidator, BeforeValidator, Field, PlainValidator, model_validator

from fieldhand.robot.bindings import (
    Distro,
    ImageType,
    NavigationFault,
    NavigationType,
    RequestValue,
    WorkingType,
)
from fieldhand.robot.fields import IdentifierField, Keyed, NumberField, Positive, UnitField, no_bool

#: Maximum length of a name; ROS requires shorter ones.
_LONGEST_NAME = 255
#: Maximum length of an interface definition in characters, and maximum number of definitions: they are part of every
#: bundle.
_LONGEST_TEXT, _MOST_INTERFACES = 20_000, 50
#: Maximum number of images of a capture.
_MOST_IMAGES = 8
#: Number of separator lines (``---``) in the definition of each kind of interface.
_SECTIONS = {"msg": 0, "srv": 1, "action": 2}


def _ros_name(value: str) -> str:
    if len(value) > _LONGEST_NAME or not re.fullmatch(r"/?[A-Za-z_][A-Za-z0-9_]*(/[A-Za-z_][A-Za-z0-9_]*)*", value):
        raise ValueError(
            f"{value[:80]!r} is not a ROS name; use letters, digits and _, separated by single /, such as gps/fix"
        )
    return value


def as_namespace(value: str) -> str:
    """Return a namespace in normal form: empty, or ``/`` and a name.

    Raises:
        ValueError: The value is not a namespace.
    """
    return "" if value in ("", "/") else "/" + _ros_name(value).removeprefix("/")


def _path(value: str) -> str:
    part = r"[a-z][a-z0-9_]*(\[\d{1,5}\])?"
    if len(value) > _LONGEST_NAME or not re.fullmatch(rf"{part}(\.{part})*", value):
        raise ValueError(f"{value[:80]!r} is not a path to a field; write it as pose.pose.position.x or cells[0].value")
    return value


def _typed(kind: str, value: str) -> str:
    if len(value) > _LONGEST_NAME or not re.fullmatch(rf"[a-z][a-z0-9_]*/{kind}/[A-Z][A-Za-z0-9]*", value):
        raise ValueError(f"{value[:80]!r} is not a type here; write package/{kind}/Name")
    return value


def _navigation(value: object) -> object:
    """Expand a bare type name such as ``NavigateToPose`` to the type of Nav2."""
    return f"nav2_msgs/action/{value}" if isinstance(value, str) and "/" not in value else value


def _only_path(data: object) -> object:
    """Expand the short form ``reading: temperature`` to ``reading: {path: temperature}``."""
    return {"path": data} if isinstance(data, str) else data


def _constant(value: object) -> RequestValue:
    """Validate a constant of a request: no list, no mapping, and no value outside the range of every ROS type."""
    match value:
        case bool():
            return value
        case str() if len(value) <= _LONGEST_NAME:
            return value
        case int() if -(2**63) <= value < 2**64:
            return value
        case float() if math.isfinite(value):
            return value
    raise ValueError(
        f"must be a text of at most {_LONGEST_NAME} characters, a number, true or false; correct the value"
    )


def _text(value: str) -> str:
    if not value.strip() or len(value) > _LONGEST_TEXT or not all(c.isprintable() or c in "\n\r\t" for c in value):
        raise ValueError(f"is not a definition; give the lines of its file, at most {_LONGEST_TEXT} characters")
    return value


RosName = Annotated[str, AfterValidator(_ros_name)]
FieldPath = Annotated[str, AfterValidator(_path)]
MessageType = Annotated[str, AfterValidator(lambda value: _typed("msg", value))]
ActionType = Annotated[str, AfterValidator(lambda value: _typed("action", value))]
ServiceType = Annotated[str, AfterValidator(lambda value: _typed("srv", value))]
AnyType = Annotated[str, AfterValidator(lambda value: _typed("(?:msg|srv|action)", value))]
TimeLimitField = Annotated[Positive, Field(le=3600)]
#: Maximum age of the last message in seconds, up to a day for topics that are published only on change.
Stale = Annotated[Positive, Field(le=86_400)]
Metres = Annotated[Positive, Field(le=100)]
Code = Annotated[int, BeforeValidator(no_bool), Field(ge=0, le=65_535)]
Constant = Annotated[RequestValue, PlainValidator(_constant)]


class _ConvertedDocument(Keyed):
    """A number in a message with its conversion to the unit of the quantity."""

    path: FieldPath | None = None
    unit: UnitField | None = None
    scale: NumberField | None = None
    offset: NumberField | None = None

    @model_validator(mode="after")
    def _converted_once(self) -> _ConvertedDocument:
        if self.unit is not None and (self.scale, self.offset) != (None, None):
            raise ValueError("unit conflicts with scale and offset; give either the unit, or scale and offset")
        if self.scale == 0:
            raise ValueError("scale is 0; every reading would be the same")
        return self


class _TopicDocument(Keyed):
    """A subscribed topic with its quality of service."""

    topic: RosName
    reliable: bool = False
    transient: bool = False

    @model_validator(mode="after")
    def _heard(self) -> _TopicDocument:
        if self.transient and not self.reliable:
            raise ValueError("transient needs reliable; add reliable: true")
        return self


class ReadingDocument(_ConvertedDocument):
    """``{path: temperature, unit: K}``, or the path alone."""


class NextMessageDocument(_ConvertedDocument):
    """A reading taken from the next message of a topic."""

    topic: RosName
    type: MessageType
    within_s: TimeLimitField | None = None
    reliable: bool = False


class NextImageDocument(Keyed):
    """An image taken from the next message of a topic."""

    topic: RosName
    type: ImageType = "sensor_msgs/msg/Image"
    within_s: TimeLimitField | None = None
    reliable: bool = False


class _CallDocument(Keyed):
    """The keys shared by action and service calls."""

    name: RosName
    request: Annotated[dict[FieldPath, Constant], Field(max_length=100)] = Field(default_factory=dict)
    readings: dict[str, Annotated[ReadingDocument, BeforeValidator(_only_path)]] = Field(default_factory=dict)
    success: FieldPath | None = None
    message: FieldPath | None = None
    within_s: TimeLimitField | None = None
    images: Annotated[dict[IdentifierField, FieldPath], Field(max_length=_MOST_IMAGES)] = Field(default_factory=dict)


class ActionCallDocument(_CallDocument):
    """A ROS action that makes a capture."""

    type: ActionType


class ServiceCallDocument(_CallDocument):
    """A ROS service that makes a capture."""

    type: ServiceType


#: Types of switches for which the values and the success flag need not be given.
_SWITCH_TYPES = {
    "std_srvs/srv/SetBool": ("data", "success", "message"),
    "std_msgs/msg/Bool": ("data", None, None),
}


class SwitchDocument(Keyed):
    """The switch of an implement: ``{service: mower/enable}``, or a topic."""

    service: RosName | None = None
    topic: RosName | None = None
    type: AnyType | None = None
    enable: Annotated[dict[FieldPath, Constant], Field(max_length=100)] = Field(default_factory=dict)
    disable: Annotated[dict[FieldPath, Constant], Field(max_length=100)] = Field(default_factory=dict)
    success: FieldPath | None = None
    message: FieldPath | None = None
    within_s: TimeLimitField = 5.0

    @property
    def whole_type(self) -> str:
        """Return the type: that of the file, else the standard one of its kind."""
        return self.type or ("std_srvs/srv/SetBool" if self.service is not None else "std_msgs/msg/Bool")

    @property
    def values(self) -> tuple[dict[str, RequestValue], dict[str, RequestValue], str, str]:
        """Return the values that switch it on and off, and the paths of success flag and message."""
        flag, success, message = _SWITCH_TYPES.get(self.whole_type, (None, None, None))
        on = self.enable or ({} if flag is None else {flag: True})
        off = self.disable or ({} if flag is None else {flag: False})
        return on, off, self.success or success or "", self.message or message or ""

    @model_validator(mode="after")
    def _one_switch(self) -> SwitchDocument:
        if (self.service is None) == (self.topic is None):
            raise ValueError("give either service or topic, the switch of the implement")
        kind = "srv" if self.service is not None else "msg"
        if f"/{kind}/" not in self.whole_type:
            raise ValueError(f"the type {self.whole_type} does not belong to it; write package/{kind}/Name")
        on, off, _, _ = self.values
        if not on or not off or on == off:
            raise ValueError("enable and disable must differ; give the values that switch the implement on and off")
        if self.topic is not None and (self.success is not None or self.message is not None):
            raise ValueError("a topic answers nothing; leave success and message out")
        return self


class ActionBindingDocument(Keyed):
    """The binding of an action of the profile: a call, topics, or both; for an implement its switch."""

    action: ActionCallDocument | None = None
    service: ServiceCallDocument | None = None
    topics: dict[str, NextMessageDocument] = Field(default_factory=dict)
    images: Annotated[dict[IdentifierField, NextImageDocument], Field(max_length=_MOST_IMAGES)] = Field(
        default_factory=dict
    )
    switch: SwitchDocument | None = None

    @model_validator(mode="after")
    def _by_something(self) -> ActionBindingDocument:
        if self.switch is not None:
            if self.action is not None or self.service is not None or self.topics or self.images:
                raise ValueError("switch belongs to an implement; leave action, service, topics and images out")
            return self
        if self.action is not None and self.service is not None:
            raise ValueError("both action and service are given; give only one of them")
        call = self.action or self.service
        if call is None and not self.topics and not self.images:
            raise ValueError("nothing performs the action; give action, service, topics or images")
        if call is not None and (twice := sorted(call.images.keys() & self.images.keys())):
            raise ValueError(f"the image {twice[0]} is given twice; keep it either in the call or in images")
        return self


class DatumDocument(Keyed):
    """The geographic position and heading of the map frame's origin."""

    lat: Annotated[NumberField, Field(ge=-90, le=90)]
    lon: Annotated[NumberField, Field(ge=-180, le=180)]
    heading_deg: Annotated[NumberField, Field(ge=-360, le=360)] = 90.0


class NavigationDocument(Keyed):
    """Navigation of the robot."""

    type: Annotated[NavigationType, BeforeValidator(_navigation)] = "nav2_msgs/action/NavigateToPose"
    action: RosName | None = None
    frame: RosName = "map"
    datum: DatumDocument | None = None
    from_ll: RosName | None = None
    tolerance_m: Metres = 0.5
    behavior_tree: Annotated[str, Field(max_length=1000)] = ""
    speed_limit: RosName | None = None
    codes: Annotated[dict[Code, NavigationFault], Field(max_length=100)] = Field(default_factory=dict)
    without_code: NavigationFault | None = None
    accept_s: TimeLimitField = 5.0
    quiet_s: TimeLimitField = 15.0
    slower: Annotated[NumberField, Field(ge=1, le=100)] = 5.0
    extra_s: Annotated[NumberField, Field(ge=0, le=3600)] = 60.0
    working: Annotated[WorkingType, BeforeValidator(_navigation)] | None = None
    working_action: RosName | None = None
    controller: Annotated[str, Field(max_length=100)] = ""
    goal_checker: Annotated[str, Field(max_length=100)] = ""
    nodes: Annotated[tuple[RosName, ...], Field(max_length=20)] | None = None
    follow_path: RosName | Literal[""] = "follow_path"
    stuck_s: TimeLimitField = 60.0
    most_recoveries: Annotated[int, BeforeValidator(no_bool), Field(ge=1, le=1000)] = 6

    @model_validator(mode="after")
    def _one_map(self) -> NavigationDocument:
        if self.type.endswith("/FollowGPSWaypoints"):
            if self.datum is not None or self.from_ll is not None:
                raise ValueError("FollowGPSWaypoints takes degrees; leave datum and from_ll out")
        elif self.type.endswith("/ComputeAndTrackRoute") and self.working not in (None, "nav2_msgs/action/FollowPath"):
            raise ValueError("with ComputeAndTrackRoute the controller follows every path; leave working out")
        if self.type.endswith("/FollowGPSWaypoints"):
            return self
        if (self.datum is None) == (self.from_ll is None):
            raise ValueError("give either datum (where the map frame lies) or from_ll (the service that knows it)")
        return self


class PositionDocument(_TopicDocument):
    """The position source of the robot."""

    type: Literal["sensor_msgs/msg/NavSatFix"] = "sensor_msgs/msg/NavSatFix"
    stale_s: Stale = 3.0
    most_sigma_m: Metres = 1.0


class BatteryDocument(_TopicDocument, _ConvertedDocument):
    """The battery charge."""

    type: MessageType = "sensor_msgs/msg/BatteryState"
    stale_s: Stale = 30.0


class OdometryDocument(_TopicDocument):
    """The odometry along which driven metres are counted."""

    type: Literal["nav_msgs/msg/Odometry"] = "nav_msgs/msg/Odometry"
    stale_s: Stale = 3.0


class OdometerDocument(_TopicDocument, _ConvertedDocument):
    """The counter of all metres that the robot has driven."""

    type: MessageType = "std_msgs/msg/Float64"
    stale_s: Stale = 10.0


class StopDocument(_TopicDocument):
    """An emergency stop."""

    type: MessageType = "std_msgs/msg/Bool"
    path: FieldPath = "data"
    stopped: bool = True
    stale_s: Stale = 10.0


class EventBindingDocument(_TopicDocument, _ConvertedDocument):
    """A topic that reports an event."""

    type: MessageType = "std_msgs/msg/Bool"
    equals: bool | NumberField | None = None
    above: NumberField | None = None
    below: NumberField | None = None
    stale_s: Stale = 10.0

    @model_validator(mode="after")
    def _one_test(self) -> EventBindingDocument:
        if sum(test is not None for test in (self.equals, self.above, self.below)) > 1:
            raise ValueError("several tests are given; give only one of equals, above and below")
        return self


#: Releases whose Nav2 has a route server.
_WITH_ROUTES = ("jazzy", "kilted")


class Ros2Document(Keyed):
    """The ``ros2`` part of a profile."""

    distro: Distro | None = None
    namespace: Annotated[str, AfterValidator(as_namespace)] = ""
    use_sim_time: bool = False
    navigation: NavigationDocument
    position: PositionDocument
    battery: BatteryDocument
    odometry: OdometryDocument | None = None
    odometer: OdometerDocument | None = None
    stop: StopDocument | None = None
    actions: dict[IdentifierField, ActionBindingDocument] = Field(default_factory=dict)
    events: dict[IdentifierField, EventBindingDocument] = Field(default_factory=dict)
    interfaces: Annotated[dict[AnyType, Annotated[str, AfterValidator(_text)]], Field(max_length=_MOST_INTERFACES)] = (
        Field(default_factory=dict)
    )

    @model_validator(mode="after")
    def _known_there(self) -> Ros2Document:
        if self.navigation.type.endswith("/ComputeAndTrackRoute") and self.distro not in _WITH_ROUTES:
            raise ValueError(f"Nav2 of {self.distro} has no route server; use FollowPath, or one of jazzy, kilted")
        if self.distro == "humble" and self.navigation.type.endswith("/FollowGPSWaypoints"):
            newer = ", ".join(name for name in get_args(Distro) if name != "humble")
            raise ValueError(f"Nav2 of humble has no FollowGPSWaypoints; use another type, or one of {newer}")
        return self

    @model_validator(mode="after")
    def _whole_definitions(self) -> Ros2Document:
        for name, text in self.interfaces.items():
            kind = name.split("/")[1]
            dashes = sum(line.strip() == "---" for line in text.splitlines())
            if dashes != _SECTIONS[kind]:
                raise ValueError(
                    f"the definition of {name} has {dashes} lines of ---; a .{kind} file has {_SECTIONS[kind]}"
                )
        return self
