"""``fieldhand plugins``: list the plugins of installed distributions, and their errors."""

from __future__ import annotations

from typing import TYPE_CHECKING, Any

from fieldhand.cli.options import JsonOption

if TYPE_CHECKING:
    from fieldhand.plugins import Plugin


def plugins(json: JsonOption = False) -> None:
    """List planners, drivers, solvers, robots, formats and commands, with the distribution that provides each.

    The exit status is 1 if one of them cannot be loaded; the others work nevertheless.
    """
    from fieldhand.cli import show
    from fieldhand.plugins import GROUPS, list_plugins

    records = [_record(plugin) for group in GROUPS for plugin in list_plugins(group)]
    if json:
        show.print_json({"plugins": records})
    else:
        for group in GROUPS:
            of_group = [record for record in records if record["group"] == group]
            if of_group:
                show.heading(group.removeprefix("fieldhand.").capitalize())
            for record in of_group:
                show.out.print(_line(record))
    if any(record["problem"] for record in records):
        raise SystemExit(1)


def _record(plugin: Plugin) -> dict[str, Any]:
    from fieldhand.errors import PluginError

    problem = ""
    if plugin.is_active:
        try:
            plugin.load()
        except PluginError as error:
            problem = str(error)
    return {
        "group": plugin.group,
        "name": plugin.name,
        "distribution": plugin.distribution,
        "version": plugin.version,
        "value": plugin.value,
        "overridden_by": plugin.overridden_by,
        "problem": problem,
    }


def _line(record: dict[str, Any]) -> str:
    line = f"  {record['name']:<14}{record['distribution']} {record['version']}"
    if record["overridden_by"]:
        return f"{line}: not used, {record['overridden_by']} provides this name"
    return f"{line}: broken: {record['problem']}" if record["problem"] else line
