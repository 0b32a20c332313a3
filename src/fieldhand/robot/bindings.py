"""ROS 2 bindings of a robot: the actions, services and topics that execute each action of its profile.

The bindings are read from the ``ros2`` part of a profile by :mod:`fieldhand.robot.loader`. They need no code from the
robot's manufacturer; interfaces that a profile does not name are not used.

A name that begins with ``/`` is absolute; any other is relative to the robot's namespace. Types are written
``package/msg/Name``, ``package/srv/Name`` or ``package/action/Name``. A path names a value in a message:
``percentage``, ``pose.pose.position.x``, ``cells[0].value``.
"""

from __future__ import annotations

from collections.abc import Mapping
from dataclasses import dataclass, field
from typing import Literal

from fieldhand.short_repr import short_repr

#: Supported ROS 2 releases. The definitions of nav2_msgs differ between them.
Distro = Literal["humble", "iron", "jazzy", "kilted"]

#: Action type for driving: one pose at a time, all waypoints of the way at once, waypoints in degrees, the way itself,
#: or that of Nav2's route server.
NavigationType = Literal[
    "nav2_msgs/action/NavigateToPose",
    "nav2_msgs/action/NavigateThroughPoses",
    "nav2_msgs/action/FollowGPSWaypoints",
    "nav2_msgs/action/FollowPath",
    "nav2_msgs/action/ComputeAndTrackRoute",
]

#: Those with which the robot follows the approved way itself.
EXACT_TYPES = ("nav2_msgs/action/FollowPath", "nav2_msgs/action/ComputeAndTrackRoute")

#: Action type for a path on which an implement works: waypoints to drive through, or the path itself.
WorkingType = Literal["nav2_msgs/action/NavigateThroughPoses", "nav2_msgs/action/FollowPath"]

#: Nodes of Nav2 without which nothing drives.
NAVIGATION_NODES = ("bt_navigator", "controller_server", "planner_server")
#: The same where the way is followed without the navigator, and where the route server determines it.
FOLLOWING_NODES, ROUTE_NODES = ("controller_server",), ("route_server", "controller_server")

#: Meaning of a navigation failure code for a mission: a fault kind of ``execution/drivers/protocol.py``.
NavigationFault = Literal["failed", "blocked", "lost"]

#: References to the current place in a request; any other name after ``$`` is a parameter of the action.
PLACE_REFERENCES = ("$place", "$kind", "$lat", "$lon")

RequestValue = str | float | bool


@dataclass(frozen=True, kw_only=True)
class FieldBinding:
    """A number in a message: ``value at path * scale + offset``, in the unit of the quantity."""

    path: str
    scale: float = 1.0
    offset: float = 0.0


@dataclass(frozen=True, kw_only=True)
class TopicBinding:
    """A subscribed topic with its quality of service and the maximum age of its last message.

    Attributes:
        topic: Name of the topic.
        type: Message type.
        stale_s: Age in seconds beyond which the last message no longer counts.
        reliable: Request reliable delivery; a reliable subscriber receives nothing from a best-effort publisher,
            as most sensors are.
        transient: Request messages that were published before the subscription (transient local).
    """

    topic: str
    type: str
    stale_s: float
    reliable: bool = False
    transient: bool = False


@dataclass(frozen=True, kw_only=True)
class NextMessage:
    """A reading taken from the next message of a topic after the capture began, or after its call returned.

    Attributes:
        topic: Name of the topic.
        type: Message type.
        value: Number in the message.
        within_s: Maximum wait for the message, in seconds.
        reliable: Request reliable delivery.
    """

    topic: str
    type: str
    value: FieldBinding
    within_s: float
    reliable: bool = False


#: Message types of images.
ImageType = Literal["sensor_msgs/msg/Image", "sensor_msgs/msg/CompressedImage"]


@dataclass(frozen=True, kw_only=True)
class NextImage:
    """An image taken from the next message of a topic after the capture began, or after its call returned.

    Attributes:
        topic: Name of the topic, to which the program subscribes only during the capture.
        type: Message type.
        within_s: Maximum wait for the message, in seconds.
        reliable: Request reliable delivery.
    """

    topic: str
    type: ImageType
    within_s: float
    reliable: bool = False


@dataclass(frozen=True, kw_only=True)
class CallBinding:
    """A call of a ROS action or service that makes a capture.

    Attributes:
        kind: ``action`` or ``service``.
        name: Name of the action or service.
        type: Its type.
        request: Values of the goal or request by path: a constant, a parameter (``$depth_cm``), or a reference to the
            current place (:data:`PLACE_REFERENCES`). Other fields keep the defaults of the type.
        readings: Number of each quantity in the result or response.
        success: Path of the success flag; empty if there is none.
        message: Path of the text that explains a failure; empty if there is none.
        within_s: Maximum time from sending the request to the result, in seconds.
        images: Path of each image in the result or response, by its name.
    """

    kind: Literal["action", "service"]
    name: str
    type: str
    request: Mapping[str, RequestValue] = field(default_factory=dict)
    readings: Mapping[str, FieldBinding] = field(default_factory=dict)
    success: str = ""
    message: str = ""
    within_s: float
    images: Mapping[str, str] = field(default_factory=dict)


@dataclass(frozen=True, kw_only=True)
class SwitchBinding:
    """The switch of an implement: a service that is called, or a topic to which is published.

    Attributes:
        kind: ``service`` or ``topic``.
        name: Name of the service or topic.
        type: Its type.
        on, off: Values of the request or message by path, as in :class:`CallBinding`; without a reference to the place.
        success: Path of the success flag of a service; empty if there is none.
        message: Path of the text that explains a failure; empty if there is none.
        within_s: Maximum time from sending the request to the response, in seconds.
    """

    kind: Literal["service", "topic"]
    name: str
    type: str
    on: Mapping[str, RequestValue] = field(default_factory=dict)
    off: Mapping[str, RequestValue] = field(default_factory=dict)
    success: str = ""
    message: str = ""
    within_s: float = 5.0


@dataclass(frozen=True, kw_only=True)
class ActionBinding:
    """Execution of an action of the profile: a call, readings from topics, or a call followed by readings.

    Attributes:
        call: ROS action or service to call; None if the action only reads topics.
        topics: Quantities read from topics, each from the next message after the call; if none arrives in time, from
            the last message since the call was sent.
        switch: Switch of an implement; None for an action at a place.
        images: Images taken from topics, by name, in the same way.
    """

    call: CallBinding | None = None
    topics: Mapping[str, NextMessage] = field(default_factory=dict)
    switch: SwitchBinding | None = None
    images: Mapping[str, NextImage] = field(default_factory=dict)


@dataclass(frozen=True, kw_only=True)
class Datum:
    """The geographic position and heading of the map frame's origin.

    Attributes:
        lat, lon: Degrees, WGS 84.
        heading_deg: Heading of the map's x axis in degrees clockwise from true north; 90 if x points east (REP 103).
    """

    lat: float
    lon: float
    heading_deg: float = 90.0


@dataclass(frozen=True, kw_only=True)
class NavigationBinding:
    """Navigation of the robot: the driving action, its frame, its time limits and its failure codes.

    Attributes:
        action: Name of the navigation action.
        type: Its type.
        frame: Frame of the goal poses.
        datum: Position of the map frame; None to convert coordinates with ``from_ll``.
        from_ll: Service of robot_localization that converts degrees to the map frame; empty if ``datum`` is given.
        tolerance_m: Maximum distance from the goal, in metres, at which a drive that navigation reports as done counts.
        behavior_tree: Behavior tree passed to Nav2; empty for its default.
        speed_limit: Topic of Nav2's speed limit (``nav2_msgs/msg/SpeedLimit``); if empty, a drive below the robot's
            speed fails.
        codes: Meanings of failure codes, in addition to the known ones.
        without_code: Meaning of a failure without a code; None for ``blocked`` in Humble, which sends none, and later
            an interruption that is no failure of the drive.
        accept_s: Maximum time until a goal is accepted or rejected, in seconds.
        quiet_s: Seconds without feedback after which navigation counts as lost.
        slower: Maximum duration of a drive, as a multiple of its length divided by its speed, plus ``extra_s``.
        extra_s: Seconds added to the maximum duration of a drive.
        working: Action type for the paths of implements; empty to use ``type``.
        working_action: Name of that action.
        controller: Controller that follows paths; empty for Nav2's default.
        goal_checker: Goal checker that ends them; empty for Nav2's only one.
        nodes: Lifecycle nodes of the navigation, which must be active; one that does not exist is not asked.
        follow_path: Action of Nav2's controller, which may drive on when the navigator is gone; empty for none.
        stuck_s: Seconds without coming nearer to the goal after which a drive counts as blocked.
        most_recoveries: Recoveries without coming nearer after which it does, too.
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
    without_code: NavigationFault | None = None
    accept_s: float = 5.0
    quiet_s: float = 15.0
    slower: float = 5.0
    extra_s: float = 60.0
    working: WorkingType | Literal[""] = ""
    working_action: str = ""
    controller: str = ""
    goal_checker: str = ""
    nodes: tuple[str, ...] = NAVIGATION_NODES
    follow_path: str = "follow_path"
    stuck_s: float = 60.0
    most_recoveries: int = 6


@dataclass(frozen=True, kw_only=True)
class PositionBinding:
    """The position source of the robot: a ``sensor_msgs/msg/NavSatFix``.

    Attributes:
        fix: Topic of the fixes.
        most_sigma_m: Maximum standard deviation in metres, of the worse of east and north, beyond which the robot is
            lost. If the receiver reports none, only the type of the fix counts.
    """

    fix: TopicBinding
    most_sigma_m: float = 1.0


@dataclass(frozen=True, kw_only=True)
class BatteryBinding:
    """The battery charge in percent, usually from a ``sensor_msgs/msg/BatteryState``, whose percentage is 0 to 1."""

    topic: TopicBinding
    value: FieldBinding


@dataclass(frozen=True, kw_only=True)
class OdometerBinding:
    """The metres that the robot has driven since it was switched on, which it counts whoever drives it."""

    topic: TopicBinding
    value: FieldBinding


@dataclass(frozen=True, kw_only=True)
class StopBinding:
    """An emergency stop: active while the value at ``path`` equals ``stopped``."""

    topic: TopicBinding
    path: str
    stopped: bool = True


@dataclass(frozen=True, kw_only=True)
class EventBinding:
    """An event in a message: the value of a measured event, or the test under which an event holds.

    Attributes:
        value: Value in the message, true and false as 1 and 0; a path that names a list gives its length.
        equals: Value at which the event holds.
        above, below: Threshold beyond which it holds.
    """

    topic: TopicBinding
    value: FieldBinding
    equals: float | None = None
    above: float | None = None
    below: float | None = None


@dataclass(frozen=True, kw_only=True, repr=False)
class Ros2Bindings:
    """The ROS 2 interfaces of a robot.

    Attributes:
        distro: ROS 2 release that the profile insists on; None for the one that the robot is heard to have.
        namespace: Prefix of every relative name: empty, or ``/`` and a name.
        navigation: Driving.
        position: Position source.
        battery: Battery charge.
        odometry: ``nav_msgs/msg/Odometry`` along which driven metres are counted; None to count them along the fixes.
        odometer: Counter of all metres, from which those driven during a power cut are known; None to estimate them.
        stop: Emergency stop; None if the robot has none.
        actions: Bindings by action name; an action without one cannot be executed on this robot.
        interfaces: Definitions of non-standard types by type, as in ``.msg``, ``.srv`` and ``.action`` files.
        use_sim_time: True for a simulated robot that publishes its time on ``/clock``.
        events: Bindings by event name; an event without one is unknown on this robot.
    """

    distro: Distro | None
    namespace: str
    navigation: NavigationBinding
    position: PositionBinding
    battery: BatteryBinding
    odometry: TopicBinding | None = None
    odometer: OdometerBinding | None = None
    stop: StopBinding | None = None
    actions: Mapping[str, ActionBinding] = field(default_factory=dict)
    interfaces: Mapping[str, str] = field(default_factory=dict)
    use_sim_time: bool = False
    events: Mapping[str, EventBinding] = field(default_factory=dict)

    __repr__ = short_repr

    @property
    def release(self) -> Distro:
        """Return the profile's release; the oldest one that has its navigation where the profile has none."""
        if self.distro is not None:
            return self.distro
        return "jazzy" if self.navigation.type.endswith("/FollowGPSWaypoints") else "humble"

    def whole_name(self, name: str) -> str:
        """Return the absolute name, which begins with ``/``, of a name in the robot's namespace."""
        return name if name.startswith("/") else f"{self.namespace}/{name}"
