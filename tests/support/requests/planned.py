"""Outcomes of the built-in planner for the requests of the tables, planned once in a run of the tests.

Many tests check the same plans, and planning takes longer than most checks. So outcomes are kept in a folder that all
processes of a run share. Tests of the planner compare them with those that it plans anew.
"""

from __future__ import annotations

import os
import pickle
from collections.abc import Callable, Mapping
from functools import cache
from hashlib import sha256
from pathlib import Path

from fieldhand.planning.english.planner import EnglishPlanner
from fieldhand.planning.planner import Outcome
from fieldhand.robot.loader import load_robot
from fieldhand.robot.model import RobotProfile
from fieldhand.site.loader import load_demo
from fieldhand.site.model import Site
from support.requests import orchards

SITES: Mapping[str, Callable[[], Site]] = {
    "demo": load_demo,
    "blocks": orchards.two_blocks,
    "crossed": orchards.crossed,
    "named": orchards.named_rows,
    "east-west": orchards.east_west,
    "scattered": orchards.scattered,
}
#: Folder of this run for outcomes, of which a process makes those that it finds missing.
_folder: Path | None = None


def keep_in(folder: Path) -> None:
    """Keep outcomes in a folder that the processes of this run share."""
    global _folder
    folder.mkdir(exist_ok=True)
    _folder = folder


@cache
def site_of(name: str) -> Site:
    """Return a site of :data:`SITES`."""
    return SITES[name]()


@cache
def robot_of(name: str) -> RobotProfile:
    """Return a built-in robot."""
    return load_robot(name)


@cache
def outcome_of(robot: str, request: str, site: str = "demo") -> Outcome:
    """Return what a request becomes, planned by whichever process is the first to ask."""
    kept = _folder and _folder / sha256(f"{robot}\n{site}\n{request}".encode()).hexdigest()
    if kept and kept.exists():
        found: Outcome = pickle.loads(kept.read_bytes())
        return found
    outcome = EnglishPlanner().plan(request, site_of(site), robot_of(robot))
    if kept:
        whole = kept.with_suffix(f".{os.getpid()}")
        whole.write_bytes(pickle.dumps(outcome))
        whole.replace(kept)
    return outcome
