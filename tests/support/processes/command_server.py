"""A program that has loaded what ``fieldhand`` needs, and copies itself for each command that it is told to run.

Reads an order a line and answers each with the exit status of its command, negative for the signal that ended it; one
that goes on in the background with the number of its process, and later the order to wait for it with its exit status.
"""

from __future__ import annotations

import atexit
import gc
import importlib
import json
import os
import pkgutil
import signal
import sys
import tempfile
from typing import Any


def load() -> None:
    """Load the whole package; what a planner makes ready for its first request, once."""
    import matplotlib.backends.backend_agg  # noqa: F401
    import pydantic_ai.models.openai  # noqa: F401

    import fieldhand
    import fieldhand_bench

    for module in (
        *pkgutil.walk_packages(fieldhand.__path__, "fieldhand."),
        *pkgutil.walk_packages(fieldhand_bench.__path__, "fieldhand_bench."),
    ):
        # What needs a ROS that is sourced is loaded by whoever asks for it, and no command needs what is for tests.
        if not module.name.endswith("__main__") and not any(s in module.name for s in (".ros2.rclpy.", ".testing")):
            importlib.import_module(module.name)
    _prepare()


def _prepare() -> None:
    """Do once what the first command of a process takes its time for: compiled code, fonts, tables of the grammar."""
    import fieldhand as fh

    site, robot = fh.Site.demo(), fh.Robot.load("husky")
    plan = fh.plan("Take as many pictures as you can within 100 m.", site, robot)
    assert isinstance(plan, fh.Plan)
    review = fh.review(plan.task, site, robot)
    done = fh.simulate(fh.authorize(review, by="Ada"), seed=1)
    with tempfile.TemporaryDirectory() as folder:
        done.report(folder)


def become(order: dict[str, Any]) -> None:
    """Make this process the one that runs the command."""
    signal.alarm(order["limit_s"])
    if order["terminal"]:
        os.setsid()  # so that the terminal that is opened next is its own
    signal.signal(signal.SIGINT, signal.SIG_IGN if order["deaf"] else signal.default_int_handler)
    for number in (signal.SIGTERM, signal.SIGHUP):
        signal.signal(number, signal.SIG_DFL)
    if order["background"]:
        sys.stdout.reconfigure(line_buffering=True)  # somebody reads what it has said so far
    for number, (file, how) in enumerate(zip(order["files"], (os.O_RDONLY, os.O_WRONLY, os.O_WRONLY), strict=True)):
        how = os.O_RDWR if order["terminal"] else how | os.O_CREAT | os.O_TRUNC if how else how
        opened = os.open(file, how, 0o600)
        os.dup2(opened, number)
        os.close(opened)
    if order["terminal"]:
        _begin_at_terminal()
    os.chdir(order["cwd"])
    os.environ.clear()
    os.environ.update(order["env"])
    sys.argv = ["fieldhand", *order["words"]]


def _begin_at_terminal() -> None:
    """Do anew what depends on a terminal: open the streams, and load the modules that look at them when loaded."""
    sys.stdin = open(0, closefd=False, encoding=sys.stdin.encoding, errors=sys.stdin.errors)  # noqa: SIM115
    sys.stdout, sys.stderr = (
        open(number, "w", buffering=1, closefd=False, encoding=old.encoding, errors=old.errors)  # noqa: SIM115
        for number, old in ((1, sys.stdout), (2, sys.stderr))
    )
    for name in [n for n in sys.modules if n.startswith(("fieldhand.cli", "fieldhand.program", "fieldhand_bench"))]:
        del sys.modules[name]


def run() -> None:
    """Run the command, and end at once: to take a whole program apart would cost more than most commands do."""
    from fieldhand.program import main

    try:
        main()
        status = 0
    except SystemExit as ended:
        if not isinstance(ended.code, int | None):
            raise
        status = ended.code or 0
    atexit._run_exitfuncs()
    sys.stdout.flush()
    sys.stderr.flush()
    os._exit(status)


def main() -> None:
    orders, answers = os.fdopen(os.dup(0), "r"), os.fdopen(os.dup(1), "w")
    gc.disable()  # until all is loaded, none of which is garbage
    load()
    gc.enable()
    gc.freeze()  # nor need a copy look for garbage in what it was given
    for line in orders:
        order = json.loads(line)
        if "wait" in order:
            _, ended = os.waitpid(order["wait"], 0)
            print(os.waitstatus_to_exitcode(ended), file=answers, flush=True)
            continue
        child = os.fork()
        if not child:
            become(order)
            run()
        if order["background"]:
            print(child, file=answers, flush=True)
            continue
        _, ended = os.waitpid(child, 0)
        print(os.waitstatus_to_exitcode(ended), file=answers, flush=True)


if __name__ == "__main__":
    main()
