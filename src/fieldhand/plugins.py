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
from collections.abc import Collection, Iterator
from dataclasses import dataclass, replace
from functools import lru_cache
from typing import TYPE_CHECKING, Final, Literal, get_args

from fieldhand.errors import PluginError

if TYPE_CHECKING:
    from importlib.metadata import Distribution

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
_ENTRY_POINTS: Final = "entry_points.txt"


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
            if not EntryPoint.pattern.match(self.value):
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
    registered = [plugin for plugin in _registered(tuple(sys.path)) if plugin.group == group]
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
def _registered(path: tuple[str, ...]) -> tuple[Plugin, ...]:  # noqa: ARG001  another path has other distributions
    """Return the plugins of all distributions in no particular order, searched once per path.

    The files are parsed here: ``entry_points()`` raises where one entry of any distribution is invalid, depending on
    the release of Python and on whether the package importlib-metadata was imported, which replaces parts of it.
    """
    from importlib.metadata import distribution, distributions  # slow to import, and most commands need no plugin

    plugins: dict[Plugin, None] = {}
    for candidate in distributions():
        if "[fieldhand." in (candidate.read_text(_ENTRY_POINTS) or ""):
            name, _ = _name_and_version(candidate)
            # Of several versions on the path, only the one that Python imports counts.
            plugins |= dict.fromkeys(_parse(distribution(name) if name else candidate))
    return tuple(plugins)


def _parse(distribution: Distribution) -> Iterator[Plugin]:
    """Yield the plugins that a distribution registers, with their values as written."""
    name, version = _name_and_version(distribution)
    groups: dict[str, Group] = {group: group for group in GROUPS}
    group: Group | None = None
    for line in map(str.strip, (distribution.read_text(_ENTRY_POINTS) or "").splitlines()):
        if line.startswith("[") and line.endswith("]"):
            group = groups.get(line[1:-1])
        elif group is not None and line and not line.startswith("#"):
            key, _, value = line.partition("=")
            yield Plugin(group=group, name=key.strip(), value=value.strip(), distribution=name, version=version)


def _name_and_version(distribution: Distribution) -> tuple[str, str]:
    """Return name and version of a distribution; empty where its metadata is missing."""
    try:
        metadata = distribution.metadata
    except FileNotFoundError:  # raised by newer releases of importlib-metadata
        return "", ""
    # The type of the metadata has no get() in Python 3.10.
    name, version = (metadata[field] if field in metadata else "" for field in ("Name", "Version"))  # noqa: SIM401
    return name, version


def active(group: Group, *, built_in: Collection[str] = ()) -> dict[str, Plugin]:
    """Return the plugins of a group that are used, by name; see :func:`found`."""
    return {plugin.name: plugin for plugin in list_plugins(group, built_in=built_in) if plugin.is_active}
