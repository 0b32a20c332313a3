"""Kinds of drivers by name: entry points of the group ``fieldhand.drivers``, the built-in ones among them."""

from __future__ import annotations

from collections.abc import Callable, Iterator
from contextlib import AbstractContextManager, ExitStack, contextmanager
from dataclasses import dataclass, replace
from typing import Protocol

from fieldhand.errors import FieldhandError, InputError
from fieldhand.execution.vehicle import Connection, Vehicle
from fieldhand.language import message
from fieldhand.plugins import Plugin, active
from fieldhand.robot.model import RobotProfile
from fieldhand.site.model import Site
from fieldhand.task.frames import Task

#: Connects to a robot for the duration of a context. Takes the site, the profile, the Task, the connection, and the
#: seconds of the wall clock within which the robot must respond.
ConnectDriver = Callable[[Site, RobotProfile, Task, Connection, float], AbstractContextManager[Vehicle]]


class Presence(Protocol):
    """Watches whether a robot could carry a mission out now."""

    def missing(self) -> tuple[str, ...]:
        """Return the parts of the robot that are missing now, in words; empty if it is ready."""
        ...

    def close(self) -> None:
        """Stop watching."""
        ...


@dataclass(frozen=True, kw_only=True)
class DriverKind:
    """A kind of driver: how robots of one middleware are reached. Distributions register one by an entry point.

    Attributes:
        connect: Connects to a robot; must raise a :class:`~fieldhand.errors.FieldhandError` if the robot does not
            respond, and must leave the robot without a running goal when its context ends.
        summary: One line for help texts.
        ros2: True if the options for ROS domain, namespace and simulated time apply.
        watch: Starts to watch a robot's presence, for a robot that waits for missions; None if that is not possible.
    """

    connect: ConnectDriver
    summary: str
    ros2: bool = False
    watch: Callable[[RobotProfile, Connection], Presence] | None = None


def driver_kind(name: str) -> DriverKind:
    """Return the driver of a name; its ``connect`` raises a PluginError if the plugin's own code fails.

    Raises:
        InputError: There is none of that name.
        PluginError: It cannot be imported, or is no driver.
    """
    plugins = active("fieldhand.drivers")
    if name not in plugins:
        raise InputError(
            message("a mission cannot run on '{on}'", on=name[:80]),
            where="--on",
            advice=message("choose one of {what}", what=", ".join(("simulation", *plugins))),
        )
    kind = plugins[name].load()
    if not isinstance(kind, DriverKind):
        raise plugins[name].error("is not a DriverKind")
    return replace(kind, connect=_explained(kind.connect, plugins[name]))


def _explained(connect: ConnectDriver, plugin: Plugin) -> ConnectDriver:
    """Return a function that connects, and names the plugin if its code fails."""

    @contextmanager
    def explained(
        site: Site, robot: RobotProfile, task: Task, connection: Connection, within_s: float
    ) -> Iterator[Vehicle]:
        with ExitStack() as stack:
            try:
                vehicle = stack.enter_context(connect(site, robot, task, connection, within_s))
            except FieldhandError:
                raise
            except Exception as error:  # a plugin's code may raise anything
                raise plugin.error(f"failed to connect: {type(error).__name__}: {error}".rstrip(": ")) from error
            yield replace(vehicle, robot=vehicle.robot or robot)

    return explained
