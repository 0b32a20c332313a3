"""How a robot is reached over ROS 2, as data: which of its actions, services and topics carry out what.

Read from the ``ros2`` part of a profile by :mod:`fieldhand.robot.loader`. No code of the robot's maker is needed: what
a profile does not say is not done.

Names are those of ROS: one that begins with ``/`` is whole, any other stands below the robot's namespace. Types are
``package/msg/Name``, ``package/srv/Name``, ``package/action/Name``. A path leads to a value in a message:
``percentage``, ``pose.pose.position.x``, ``cells[0].value``.
"""

from __future__ import annotations

from collections.abc import Mapping
from dataclasses import dataclass, field
from typing import Literal

from fieldhand.short_repr import short_repr

#: Releases whose definitions of the standard interfaces are known; those of nav2_msgs differ between them.
Distro = Literal["humble", "iron", "jazzy", "kilted"]

#: What carries a drive out: one pose at a time, all corners of the way at once, or both as degrees.
NavigationType = Literal[
    "nav2_msgs/action/NavigateToPose", "nav2_msgs/action/NavigateThroughPoses", "nav2_msgs/action/FollowGPSWaypoints"
]

#: What a failure code of navigation means to a mission: the kinds of ``execution/drivers/protocol.py``.
NavigationFault = Literal["failed", "blocked", "lost"]

#: In a request, what stands for the place in hand; every other name behind ``$`` is a parameter of the action.
PLACE_REFERENCES = ("$place", "$kind", "$lat", "$lon")

RequestValue = str | float | bool


@dataclass(frozen=True, kw_only=True)
class FieldBinding:
    """A number in a message: the value at ``path``, times ``scale``, plus ``offset``, in the quantity's unit."""

    path: str
    scale: float = 1.0
    offset: float = 0.0


@dataclass(frozen=True, kw_only=True)
class TopicBinding:
    """A topic, and how old its last message may be.

    Attributes:
        stale_s: Seconds without a message after which nothing is known any more.
        reliable: Ask for reliable delivery; sensors mostly send best effort, which a reliable reader never hears.
        transient: Ask for what was sent before (transient local).
    """

    topic: str
    type: str
    stale_s: float
    reliable: bool = False
    transient: bool = False


@dataclass(frozen=True, kw_only=True)
class NextMessage:
    """A reading that is the next message of a topic after the capture began, or after its call was answered.

    Attributes:
        within_s: How long to wait for it.
    """

    topic: str
    type: str
    value: FieldBinding
    within_s: float
    reliable: bool = False


@dataclass(frozen=True, kw_only=True)
class CallBinding:
    """A ROS action or service that makes a capture.

    Attributes:
        kind: By which of the two.
        request: Values of the goal or request, by path: a constant, a parameter (``$depth_cm``), or what stands for the
            place in hand (:data:`PLACE_REFERENCES`). What is not named keeps the default of its type.
        readings: Where each quantity stands in the result or response.
        success: Path to the flag that says whether it succeeded; empty where there is none.
        message: Path to the words that say why not; empty where there are none.
        within_s: How long it may take, from being asked to the result.
    """

    kind: Literal["action", "service"]
    name: str
    type: str
    request: Mapping[str, RequestValue] = field(default_factory=dict)
    readings: Mapping[str, FieldBinding] = field(default_factory=dict)
    success: str = ""
    message: str = ""
    within_s: float


@dataclass(frozen=True, kw_only=True)
class ActionBinding:
    """How an action of the profile is carried out: by a call, by listening, or by a call and then listening.

    Attributes:
        topics: Quantities that are read from topics, each at the next message after the call; if none comes in time,
            at the last one since it was sent.
    """

    call: CallBinding | None = None
    topics: Mapping[str, NextMessage] = field(default_factory=dict)


@dataclass(frozen=True, kw_only=True)
class Datum:
    """The point of the earth at the origin of the map frame.

    Attributes:
        lat, lon: Degrees, WGS 84.
        heading_deg: Of the map's x axis, clockwise from true north; 90 where x leads east, as REP 103 has it.
    """

    lat: float
    lon: float
    heading_deg: float = 90.0


@dataclass(frozen=True, kw_only=True)
class NavigationBinding:
    """How the robot is driven.

    Attributes:
        frame: Frame of the poses that are sent.
        datum: Where the map frame lies; None where ``from_ll`` is asked.
        from_ll: Service of robot_localization that turns degrees into the map frame; empty where ``datum`` says it.
        tolerance_m: The robot has arrived if it stands within that of the goal when navigation says that it has.
        behavior_tree: Handed on to Nav2; empty for its own.
        speed_limit: Topic by which Nav2's controller is told how fast it may drive (``nav2_msgs/msg/SpeedLimit``);
            empty where it cannot be: a drive that is to be slower than the robot's speed then fails.
        codes: What failure codes mean, beside those that are known.
        without_code: What a failure without any code means: Humble gives none.
        accept_s: Within that a goal is accepted or rejected.
        quiet_s: Seconds without feedback after which navigation is taken to be gone.
        slower: A drive may last that many times as long as its metres at its speed, and ``extra_s`` more.
    """

    action: str
    type: NavigationType
    frame: str = "map"
    datum: Datum | None = None
    from_ll: str = ""
    tolerance_m: float = 0.5
    behavior_tree: str = ""
    speed_limit: str = ""
    codes: Mapping[int, NavigationFault] = field(default_factory=dict)
    without_code: NavigationFault = "blocked"
    accept_s: float = 5.0
    quiet_s: float = 15.0
    slower: float = 5.0
    extra_s: float = 60.0


@dataclass(frozen=True, kw_only=True)
class PositionBinding:
    """Where the robot is: a ``sensor_msgs/msg/NavSatFix``.

    Attributes:
        most_sigma_m: Standard deviation, of the worse of east and north, beyond which the robot is lost; where the
            receiver gives none, only the kind of the fix counts.
    """

    fix: TopicBinding
    most_sigma_m: float = 1.0


@dataclass(frozen=True, kw_only=True)
class BatteryBinding:
    """The battery's charge in percent: mostly a ``sensor_msgs/msg/BatteryState``, whose percentage is 0 to 1."""

    topic: TopicBinding
    value: FieldBinding


@dataclass(frozen=True, kw_only=True)
class StopBinding:
    """An emergency stop: the robot is stopped while the value at ``path`` is ``stopped``."""

    topic: TopicBinding
    path: str
    stopped: bool = True


@dataclass(frozen=True, kw_only=True, repr=False)
class Ros2Bindings:
    """A robot over ROS 2.

    Attributes:
        namespace: Before every name that does not begin with ``/``; empty, or ``/`` and a name.
        odometry: A ``nav_msgs/msg/Odometry``: metres are counted along it; without it, along the fixes.
        actions: By the names of the profile's actions; one that has none cannot be done on this robot.
        interfaces: Definitions of types that are no part of ROS's own, as ``.msg``, ``.srv`` and ``.action`` files have
            them, by type.
        use_sim_time: The robot is a simulation whose time stands on ``/clock``.
    """

    distro: Distro
    namespace: str
    navigation: NavigationBinding
    position: PositionBinding
    battery: BatteryBinding
    odometry: TopicBinding | None = None
    stop: StopBinding | None = None
    actions: Mapping[str, ActionBinding] = field(default_factory=dict)
    interfaces: Mapping[str, str] = field(default_factory=dict)
    use_sim_time: bool = False

    __repr__ = short_repr

    def whole_name(self, name: str) -> str:
        """A name with the robot's namespace before it, beginning with ``/``."""
        return name if name.startswith("/") else f"{self.namespace}/{name}"
