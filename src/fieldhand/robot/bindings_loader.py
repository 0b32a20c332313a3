"""Convert the ``ros2`` part of a profile file to :class:`~fieldhand.robot.bindings.Ros2Bindings`.

The part is checked against the actions and quantities of the same profile: every action and parameter that it names
must exist, and every quantity that an action measures must have exactly one source.
"""

from __future__ import annotations

import difflib
from collections.abc import Iterable, Iterator
from dataclasses import dataclass
from typing import TYPE_CHECKING, Literal

from fieldhand.robot.bindings import (
    FOLLOWING_NODES,
    NAVIGATION_NODES,
    PLACE_REFERENCES,
    ROUTE_NODES,
    ActionBinding,
    BatteryBinding,
    CallBinding,
    Datum,
    EventBinding,
    FieldBinding,
    NavigationBinding,
    NextImage,
    NextMessage,
    OdometerBinding,
    PositionBinding,
    Ros2Bindings,
    StopBinding,
    SwitchBinding,
    TopicBinding,
    WorkingType,
)
from fieldhand.robot.bindings_document import (
    ActionBindingDocument,
    BatteryDocument,
    EventBindingDocument,
    NavigationDocument,
    NextMessageDocument,
    OdometerDocument,
    OdometryDocument,
    PositionDocument,
    ReadingDocument,
    Ros2Document,
    StopDocument,
    SwitchDocument,
)
from fieldhand.robot.units import STANDARD_FIELDS, conversion, known_units

if TYPE_CHECKING:
    from fieldhand.robot.document import ActionDocument, EventDocument, ProfileDocument

#: Default time limit of a call: this multiple of the action's duration, at least this many seconds.
_TIMES, _LEAST_S = 3.0, 30.0
#: Default wait for the next message of a topic, in seconds.
_NEXT_S = 10.0

Valued = ReadingDocument | NextMessageDocument | BatteryDocument | OdometerDocument | EventBindingDocument


@dataclass(frozen=True, kw_only=True)
class ProfileProblem:
    """A problem in a profile: key path, description and advice."""

    path: str
    what: str
    advice: str


def binding_problems(document: ProfileDocument) -> tuple[ProfileProblem, ...]:
    """Return all conflicts between the bindings and the rest of a profile."""
    return () if document.ros2 is None else tuple(_binding_problems(document, document.ros2))


def bindings_of(document: ProfileDocument) -> Ros2Bindings | None:
    """Return the bindings of a profile without conflicts; None if it has none."""
    ros2 = document.ros2
    if ros2 is None:
        return None
    units = {name: quantity.unit for name, quantity in document.quantities.items()}
    return Ros2Bindings(
        distro=ros2.distro,
        namespace=ros2.namespace,
        use_sim_time=ros2.use_sim_time,
        navigation=_navigation(ros2.navigation),
        position=PositionBinding(fix=_topic(ros2.position), most_sigma_m=ros2.position.most_sigma_m),
        battery=BatteryBinding(topic=_topic(ros2.battery), value=_field(ros2.battery, ros2.battery.type, "percent")),
        odometry=None if ros2.odometry is None else _topic(ros2.odometry),
        odometer=None
        if ros2.odometer is None
        else OdometerBinding(topic=_topic(ros2.odometer), value=_field(ros2.odometer, ros2.odometer.type, "m")),
        stop=None
        if ros2.stop is None
        else StopBinding(topic=_topic(ros2.stop), path=ros2.stop.path, stopped=ros2.stop.stopped),
        actions={name: _action(bound, document.doable[name], units) for name, bound in ros2.actions.items()},
        interfaces=ros2.interfaces,
        events={name: _event(bound, document.events[name]) for name, bound in ros2.events.items()},
    )


def _binding_problems(document: ProfileDocument, ros2: Ros2Document) -> Iterator[ProfileProblem]:
    units = {name: quantity.unit for name, quantity in document.quantities.items()}
    yield from _unreadable(ros2.battery, ros2.battery.type, "percent", "ros2.battery")
    if ros2.odometer is not None:
        yield from _unreadable(ros2.odometer, ros2.odometer.type, "m", "ros2.odometer")
    yield from _event_problems(document, ros2)
    doable = document.doable
    for name, bound in ros2.actions.items():
        where = f"ros2.actions.{name}"
        action = doable.get(name)
        if action is None:
            yield ProfileProblem(path=where, what=f"the profile has no action {name!r}", advice=_nearest(name, doable))
            continue
        yield from _requests(bound, action, where)
        yield from _switches(bound, action, where)
        yield from _sources(bound, action, where)
        call = bound.action or bound.service
        for quantity, reading in call.readings.items() if call is not None else ():
            kind = "action" if bound.action is not None else "service"
            if quantity in units:
                yield from _unreadable(reading, "", units[quantity], f"{where}.{kind}.readings.{quantity}")
        for quantity, message in bound.topics.items():
            if quantity in units:
                yield from _unreadable(message, message.type, units[quantity], f"{where}.topics.{quantity}")


def _event_problems(document: ProfileDocument, ros2: Ros2Document) -> Iterator[ProfileProblem]:
    for name, bound in ros2.events.items():
        where, event = f"ros2.events.{name}", document.events.get(name)
        if event is None:
            what = f"the profile has no event {name!r}"
            yield ProfileProblem(path=where, what=what, advice=_nearest(name, document.events))
            continue
        tested = (bound.equals, bound.above, bound.below) != (None, None, None)
        if event.unit is not None:
            if tested:
                what = "a measured event has no equals, above or below here"
                yield ProfileProblem(path=where, what=what, advice="put its threshold into events, or leave it out")
            yield from _unreadable(bound, bound.type, event.unit, where)
        elif bound.unit is not None:
            what = "an event that is true or false has no unit"
            yield ProfileProblem(path=where, what=what, advice="leave unit out")


def _event(bound: EventBindingDocument, event: EventDocument) -> EventBinding:
    if event.unit is not None:
        return EventBinding(topic=_topic(bound), value=_field(bound, bound.type, event.unit))
    value = FieldBinding(path=bound.path or "data", scale=bound.scale or 1.0, offset=bound.offset or 0.0)
    tested = (bound.above, bound.below) != (None, None)
    equals = None if tested else 1.0 if bound.equals is None else float(bound.equals)
    return EventBinding(topic=_topic(bound), value=value, equals=equals, above=bound.above, below=bound.below)


def _requests(bound: ActionBindingDocument, action: ActionDocument, where: str) -> Iterator[ProfileProblem]:
    """Yield references in a request to parameters that the action lacks."""
    call = bound.action or bound.service
    known = [*PLACE_REFERENCES, *(f"${name}" for name in action.parameters)]
    for path, value in call.request.items() if call is not None else ():
        if isinstance(value, str) and value.startswith("$") and value not in known:
            kind = "action" if bound.action is not None else "service"
            yield ProfileProblem(
                path=f"{where}.{kind}.request.{path}",
                what=f"{value!r} is neither a parameter of the action nor the place",
                advice=_nearest(value, known),
            )


def _switches(bound: ActionBindingDocument, action: ActionDocument, where: str) -> Iterator[ProfileProblem]:
    """Yield an implement without a switch, a switch without an implement, and unknown references in its values."""
    if (bound.switch is None) != (action.implement is None):
        implement = action.implement is not None
        yield ProfileProblem(
            path=where,
            what="the action is on while driving, but has no switch" if implement else "only an implement has a switch",
            advice="give switch with a service or a topic" if implement else "give action, service or topics",
        )
        return
    if bound.switch is None:
        return
    known = [f"${name}" for name in action.parameters]
    for key, values in (("enable", bound.switch.enable), ("disable", bound.switch.disable)):
        for path, value in values.items():
            if isinstance(value, str) and value.startswith("$") and value not in known:
                yield ProfileProblem(
                    path=f"{where}.switch.{key}.{path}",
                    what=f"{value!r} is not a parameter of the action",
                    advice=_nearest(value, known) if known else "give a constant",
                )


def _sources(bound: ActionBindingDocument, action: ActionDocument, where: str) -> Iterator[ProfileProblem]:
    """Yield quantities without a source, with two sources, or that the action does not measure."""
    call = bound.action or bound.service
    called = () if call is None else tuple(call.readings)
    for quantity in action.measures:
        if quantity not in called and quantity not in bound.topics:
            yield ProfileProblem(
                path=where,
                what=f"no source is given for {quantity!r}",
                advice="add it to the readings of the action or service, or to topics",
            )
    for quantity in dict.fromkeys((*called, *bound.topics)):
        if quantity in called and quantity in bound.topics:
            yield ProfileProblem(
                path=where, what=f"{quantity!r} is read twice", advice="keep it either in readings or in topics"
            )
        if quantity not in action.measures:
            measured = f"it measures {', '.join(action.measures)}" if action.measures else "it measures nothing"
            yield ProfileProblem(path=where, what=f"the action does not measure {quantity!r}", advice=measured)


def _unreadable(valued: Valued, type_name: str, wanted: str, where: str) -> Iterator[ProfileProblem]:
    """Yield the reason why a value cannot be converted to the required unit."""
    path, given = _place_and_unit(valued, type_name)
    if not path:
        yield ProfileProblem(
            path=where, what="the key 'path' is missing", advice="give the path of the value in the message"
        )
    if given and conversion(given, wanted) is None:
        yield ProfileProblem(
            path=where,
            what=f"{given} cannot be turned into {wanted}",
            advice=f"give scale and offset, or one of the units {', '.join(known_units())}",
        )


def _field(valued: Valued, type_name: str, wanted: str) -> FieldBinding:
    path, given = _place_and_unit(valued, type_name)
    stated = (1.0 if valued.scale is None else valued.scale, valued.offset or 0.0)
    scale, offset = (conversion(given, wanted) if given else None) or stated
    return FieldBinding(path=path, scale=scale, offset=offset)


def _place_and_unit(valued: Valued, type_name: str) -> tuple[str, str]:
    """Return the path and the unit of a number, empty if unknown; standard message types define both."""
    path, unit = STANDARD_FIELDS.get(type_name, ("", ""))
    if valued.unit is not None or (valued.scale, valued.offset) != (None, None):
        unit = valued.unit or ""
    elif valued.path not in (None, path):
        unit = ""
    return valued.path or path, unit


def _topic(
    document: PositionDocument
    | BatteryDocument
    | OdometryDocument
    | OdometerDocument
    | StopDocument
    | EventBindingDocument,
) -> TopicBinding:
    return TopicBinding(
        topic=document.topic,
        type=document.type,
        stale_s=document.stale_s,
        reliable=document.reliable,
        transient=document.transient,
    )


def _navigation(document: NavigationDocument) -> NavigationBinding:
    datum = document.datum
    values = document.model_dump(
        exclude={"datum", "action", "from_ll", "speed_limit", "working", "working_action", "nodes"}
    )
    working: WorkingType | Literal[""] = document.working or ""
    if not working and document.type.endswith("/ComputeAndTrackRoute"):
        working = "nav2_msgs/action/FollowPath"
    return NavigationBinding(
        **values,
        action=document.action or _USUAL_NAMES[document.type],
        datum=None if datum is None else Datum(lat=datum.lat, lon=datum.lon, heading_deg=datum.heading_deg),
        from_ll=document.from_ll or "",
        speed_limit=document.speed_limit or "",
        working=working,
        nodes=_USUAL_NODES.get(document.type, NAVIGATION_NODES) if document.nodes is None else document.nodes,
        working_action=document.working_action or (_USUAL_NAMES[working] if working else ""),
    )


#: Names under which Nav2 serves each action type by default.
_USUAL_NAMES = {
    "nav2_msgs/action/NavigateToPose": "navigate_to_pose",
    "nav2_msgs/action/NavigateThroughPoses": "navigate_through_poses",
    "nav2_msgs/action/FollowGPSWaypoints": "follow_gps_waypoints",
    "nav2_msgs/action/FollowPath": "follow_path",
    "nav2_msgs/action/ComputeAndTrackRoute": "compute_and_track_route",
}
#: Nodes without which nothing drives, where they are not those of the navigator.
_USUAL_NODES = {
    "nav2_msgs/action/FollowPath": FOLLOWING_NODES,
    "nav2_msgs/action/ComputeAndTrackRoute": ROUTE_NODES,
}


def _action(bound: ActionBindingDocument, action: ActionDocument, units: dict[str, str]) -> ActionBinding:
    return ActionBinding(
        call=_call(bound, action, units),
        switch=None if bound.switch is None else _switch(bound.switch),
        topics={
            name: NextMessage(
                topic=message.topic,
                type=message.type,
                value=_field(message, message.type, units[name]),
                within_s=message.within_s or max(_NEXT_S, _TIMES * (action.duration_s or 0.0)),
                reliable=message.reliable,
            )
            for name, message in bound.topics.items()
        },
        images={
            name: NextImage(
                topic=image.topic,
                type=image.type,
                within_s=image.within_s or max(_NEXT_S, _TIMES * (action.duration_s or 0.0)),
                reliable=image.reliable,
            )
            for name, image in bound.images.items()
        },
    )


def _call(bound: ActionBindingDocument, action: ActionDocument, units: dict[str, str]) -> CallBinding | None:
    call = bound.action or bound.service
    if call is None:
        return None
    return CallBinding(
        kind="action" if bound.action is not None else "service",
        name=call.name,
        type=call.type,
        request=call.request,
        readings={name: _field(reading, "", units[name]) for name, reading in call.readings.items()},
        success=call.success or "",
        message=call.message or "",
        within_s=call.within_s or max(_LEAST_S, _TIMES * (action.duration_s or 0.0)),
        images=call.images,
    )


def _switch(switch: SwitchDocument) -> SwitchBinding:
    on, off, success, message = switch.values
    return SwitchBinding(
        kind="service" if switch.service is not None else "topic",
        name=switch.service or switch.topic or "",
        type=switch.whole_type,
        on=on,
        off=off,
        success=success,
        message=message,
        within_s=switch.within_s,
    )


def _nearest(given: str, known: Iterable[str]) -> str:
    names = list(known)
    near = difflib.get_close_matches(given, names, n=1)
    return f"did you mean {near[0]!r}?" if near else f"known here: {', '.join(names)}"
