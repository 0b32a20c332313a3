"""Earlier missions in a request: event logs, as the response of ``/api/run`` has them. The server keeps none."""

from __future__ import annotations

import json
from collections.abc import Iterator

from fieldhand.api.inputs import EarlierLogs
from fieldhand.errors import TaskError
from fieldhand.missions import earlier_missions
from fieldhand.site.earlier_missions import EarlierMissions
from fieldhand.site.model import Site
from fieldhand.task.earlier import uses_records, with_earlier
from fieldhand.task.event_lines import from_json
from fieldhand.task.frames import Task
from fieldhand.task.results import Event


def records_of(logs: EarlierLogs, site: Site) -> EarlierMissions | None:
    """Return what the missions of some event logs did on a site; None without any logs.

    Raises:
        TaskError: An event is malformed.
    """
    if logs is None:
        return None
    return earlier_missions(
        site, logs=[tuple(_events(log, number)) for number, log in enumerate(logs)] or [()], simulated=True
    )


def with_logs(task: Task, logs: EarlierLogs, site: Site) -> Task:
    """Return a Task with the missions of some event logs, if it depends on earlier missions and logs are given.

    Raises:
        TaskError: An event is malformed, or the Task depends on more captures than it can contain.
    """
    if logs is None or not uses_records(task):
        return task
    return with_earlier(task, records_of(logs, site))


def _events(log: list[dict[str, object]], number: int) -> Iterator[Event]:
    for at, event in enumerate(log):
        where = f"earlier[{number}][{at}]"
        try:
            found = from_json(json.dumps(event), where=where)
        except RecursionError:
            raise TaskError("is nested too deeply", where=where, advice="send the events of /api/run") from None
        if found is not None:
            yield found
