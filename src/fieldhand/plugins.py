"""Extensions of other distributions, found by their entry points and loaded on first use.

A distribution registers an object in its ``pyproject.toml``::


    [project.entry-points."fieldhand.planners"]
    mine = "my_package.planner:make"

:func:`found` lists what is registered, in a fixed order and without importing any of it; :func:`active` keeps the one
of each name that is used; :meth:`Plugin.load` imports it. A broken extension raises one :class:`PluginError` that
names it.
"""

from __future__ import annotations

import sys
from collections.abc import Collection
from dataclasses import dataclass, replace
from functools import lru_cache
from typing import Any, Final, Literal, get_args

from fieldhand.errors import PluginError

__all__ = ["DISTRIBUTION", "GROUPS", "Group", "Plugin", "active", "list_plugins"]

#: Entry-point groups: planners, drivers of robots, solvers, robot profiles, formats of sites, commands.
Group = Literal[
    "fieldhand.planners",
    "fieldhand.drivers",
    "fieldhand.solvers",
    "fieldhand.robots",
    "fieldhand.formats",
    "fieldhand.commands",
]
GROUPS: Final[tuple[Group, ...]] = get_args(Group)

#: The distribution of this package: what it provides itself takes precedence over what others register.
DISTRIBUTION: Final = "fieldhand"

_UNKNOWN: Final = "an unknown distribution"


@dataclass(frozen=True, kw_only=True)
class Plugin:
    """An object that a distribution registers under a name.

    Attributes:
        group: Kind of extension.
        name: Name under which users choose it.
        value: Location of the object: ``module:attribute``.
        distribution: Distribution that registers it; empty where its metadata is missing.
        version: Version of that distribution.
        overridden_by: Distribution whose object is used under this name instead; empty if this one is used.
    """

    group: Group
    name: str
    value: str
    distribution: str
    version: str
    overridden_by: str = ""

    @property
    def is_active(self) -> bool:
        """Return True if this plugin is used under its name."""
        return not self.overridden_by

    @property
    def origin(self) -> str:
        """Return distribution and version, for messages."""
        return f"{self.distribution or _UNKNOWN} {self.version}".rstrip()

    def load(self) -> object:
        """Import the object.

        Raises:
            PluginError: The import raised any exception.
        """
        from importlib.metadata import EntryPoint

        try:
            return EntryPoint(name=self.name, value=self.value, group=self.group).load()
        except (Exception, SystemExit) as error:  # a plugin's import may raise anything
            if isinstance(error, AttributeError) and not EntryPoint.pattern.match(self.value):
                reason = f"'{self.value}' is not of the form module:attribute"
            else:
                reason = f"{type(error).__name__}: {error}".rstrip(": ")
            raise self.error(f"cannot be loaded: {reason}") from error

    def error(self, what: str) -> PluginError:
        """Return an error that names this plugin.

        Args:
            what: Description of the problem, as a phrase that follows the plugin's name.
        """
        return PluginError(
            f"the plugin '{self.name}' of {self.origin} {what}",
            where=f"{self.group}: {self.name} = {self.value}",
            advice=f"update or uninstall {self.distribution or 'the distribution that registers it'}",
        )


def list_plugins(group: Group, *, built_in: Collection[str] = ()) -> tuple[Plugin, ...]:
    """Return every plugin of a group, without importing any.

    Of several plugins with one name, the first is active, ordered by: this package, name of the distribution, value.
    The result is sorted by name, with the active plugin of each name first.

    Args:
        group: Kind of extension.
        built_in: Names that this package provides without an entry point; no plugin overrides them.
    """
    registered = [
        Plugin(
            group=group,
            name=entry.name,
            value=entry.value,
            distribution=entry.dist.name if entry.dist else "",
            version=entry.dist.version if entry.dist else "",
        )
        for entry in _entry_points(tuple(sys.path)).select(group=group)
    ]
    registered.sort(key=lambda p: (p.name, p.distribution != DISTRIBUTION, p.distribution, p.value))
    owners = dict.fromkeys(built_in, DISTRIBUTION)
    plugins: list[Plugin] = []
    for plugin in registered:
        owner = owners.get(plugin.name)
        if owner is None:
            owners[plugin.name] = plugin.distribution or _UNKNOWN
            plugins.append(plugin)
        else:
            plugins.append(replace(plugin, overridden_by=owner))
    return tuple(plugins)


@lru_cache(maxsize=4)
def _entry_points(path: tuple[str, ...]) -> Any:  # noqa: ARG001  another path has other distributions
    """Return the entry points of all distributions, searched once per path."""
    from importlib.metadata import entry_points  # slow to import, and most commands need no plugin

    return entry_points()


def active(group: Group, *, built_in: Collection[str] = ()) -> dict[str, Plugin]:
    """Return the plugins of a group that are used, by name; see :func:`found`."""
    return {plugin.name: plugin for plugin in list_plugins(group, built_in=built_in) if plugin.is_active}
