"""Description of a robot's ROS 2 interface, for ``fieldhand robot``."""

from __future__ import annotations

from collections.abc import Iterator, Mapping

from fieldhand.robot.bindings import ActionBinding, CallBinding, FieldBinding, Ros2Bindings, TopicBinding
from fieldhand.robot.model import RobotProfile


def binding_lines(profile: RobotProfile) -> Iterator[str]:
    """Yield lines that describe the ``ros2`` part of a profile, or that it has none."""
    ros2 = profile.ros2
    if ros2 is None:
        yield "ROS 2: the profile does not define how the robot is reached"
        return
    time = ", time from /clock" if ros2.use_sim_time else ""
    yield f"ROS 2: {ros2.distro or 'the release of the robot'}, names below {ros2.namespace or '/'}{time}"
    yield f"  drives by {ros2.whole_name(ros2.navigation.action)} ({ros2.navigation.type}) {_map(ros2)}"
    if ros2.navigation.working:
        working = ros2.navigation.working
        yield f"  drives with an implement by {ros2.whole_name(ros2.navigation.working_action)} ({working})"
    if ros2.navigation.speed_limit:
        yield f"  no faster than {ros2.whole_name(ros2.navigation.speed_limit)} says (nav2_msgs/msg/SpeedLimit)"
    yield f"  position {_topic(ros2, ros2.position.fix)}, to {ros2.position.most_sigma_m:g} m"
    yield f"  battery {_topic(ros2, ros2.battery.topic)}: {_value(ros2.battery.value)}"
    yield f"  metres {'along the position' if ros2.odometry is None else _topic(ros2, ros2.odometry)}"
    if ros2.odometer is not None:
        yield f"  all metres {_topic(ros2, ros2.odometer.topic)}: {_value(ros2.odometer.value)}"
    if ros2.stop is not None:
        yield f"  stop {_topic(ros2, ros2.stop.topic)}: while {ros2.stop.path} is {str(ros2.stop.stopped).lower()}"
    for action in profile.doable.values():
        bound = ros2.actions.get(action.name)
        if bound is None:
            yield f"  {action.name}: nothing performs it"
        else:
            yield from _action(ros2, action.name, bound)
    for name in ros2.interfaces:
        yield f"  defines {name}"


def _map(ros2: Ros2Bindings) -> str:
    navigation = ros2.navigation
    if navigation.from_ll:
        return f"in {navigation.frame}, which {ros2.whole_name(navigation.from_ll)} turns degrees into"
    if navigation.datum is not None:
        datum = navigation.datum
        return (
            f"in {navigation.frame}, whose origin is {datum.lat}, {datum.lon} and whose x leads {datum.heading_deg:g}°"
        )
    return "in degrees"


def _topic(ros2: Ros2Bindings, topic: TopicBinding) -> str:
    asked = [word for word, is_asked in (("reliable", topic.reliable), ("transient", topic.transient)) if is_asked]
    quality = f" {' '.join(asked)}" if asked else ""
    return f"{ros2.whole_name(topic.topic)} ({topic.type}){quality}, stale after {topic.stale_s:g} s"


def _action(ros2: Ros2Bindings, name: str, bound: ActionBinding) -> Iterator[str]:
    if bound.call is not None:
        yield f"  {name}: {_call(ros2, bound.call)}"
    if bound.switch is not None:
        switch = bound.switch
        where = f"{switch.kind} {ros2.whole_name(switch.name)} ({switch.type})"
        flag = f"; it worked if {switch.success}" if switch.success else ""
        yield f"  {name}: {where} with {_named(switch.on)} for on, {_named(switch.off)} for off{flag}"
    for quantity, message in bound.topics.items():
        where = f"{ros2.whole_name(message.topic)} ({message.type})"
        yield f"  {name}: {quantity} = {_value(message.value)} of the next {where} within {message.within_s:g} s"
    for label, image in bound.images.items():
        where = f"{ros2.whole_name(image.topic)} ({image.type})"
        yield f"  {name}: image {label} from the next {where} within {image.within_s:g} s"


def _call(ros2: Ros2Bindings, call: CallBinding) -> str:
    asked = f" with {_named(call.request)}" if call.request else ""
    read = "".join(f"; {quantity} = {_value(value)}" for quantity, value in call.readings.items())
    read += "".join(f"; image {label} = {path}" for label, path in call.images.items())
    flag = f"; it worked if {call.success}" if call.success else ""
    return f"{call.kind} {ros2.whole_name(call.name)} ({call.type}){asked} within {call.within_s:g} s{read}{flag}"


def _value(value: FieldBinding) -> str:
    scaled = value.path if value.scale == 1.0 else f"{value.path} · {value.scale:g}"
    sign = "+" if value.offset > 0 else "-"
    return scaled if value.offset == 0 else f"{scaled} {sign} {abs(value.offset):g}"


def _named(request: Mapping[str, object]) -> str:
    return ", ".join(f"{path} = {value}" for path, value in request.items())
