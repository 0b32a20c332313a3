"""The application of the command line with all its commands."""

from __future__ import annotations

from collections.abc import Callable
from typing import Annotated

import typer

from fieldhand.cli.approve import approve
from fieldhand.cli.check import check
from fieldhand.cli.demo import demo
from fieldhand.cli.export import export
from fieldhand.cli.import_tree import import_tree
from fieldhand.cli.inspect import inspect
from fieldhand.cli.keys import keys
from fieldhand.cli.missions import missions
from fieldhand.cli.order import order
from fieldhand.cli.outbox import outbox
from fieldhand.cli.plan import plan
from fieldhand.cli.plugin_commands import CommandsWithPlugins
from fieldhand.cli.plugins import plugins
from fieldhand.cli.replay import replay
from fieldhand.cli.report import report
from fieldhand.cli.resume import resume
from fieldhand.cli.robot import robot
from fieldhand.cli.run import run
from fieldhand.cli.send import send
from fieldhand.cli.sim_robot import sim_robot
from fieldhand.cli.site import site
from fieldhand.cli.status import status
from fieldhand.cli.tell import abort, come_home, pause
from fieldhand.cli.watch import watch


def assemble(*others: Callable[..., None]) -> typer.Typer:
    """Return the application: the commands of this package, then ``others``, then those of plugins."""
    app = typer.Typer(
        name="fieldhand",
        cls=CommandsWithPlugins,
        help="Say in plain words what a field robot should do; get a checked mission, approve it, have it carried out.",
        no_args_is_help=True,
        pretty_exceptions_enable=False,
        context_settings={"help_option_names": ["-h", "--help"]},
    )
    commands: tuple[Callable[..., None], ...] = (
        plan,
        check,
        approve,
        inspect,
        run,
        resume,
        status,
        pause,
        abort,
        missions,
        report,
        replay,
        export,
        send,
        outbox,
        watch,
        order,
        site,
        sim_robot,
        plugins,
        demo,
        *others,
    )
    for command in commands:
        app.command()(command)
    app.command("import")(import_tree)
    app.command("return")(come_home)
    app.add_typer(robot)
    app.add_typer(keys)
    app.callback()(_top)
    return app


def _version(wanted: bool) -> None:
    if wanted:
        from fieldhand import __version__

        typer.echo(f"fieldhand {__version__}")
        raise typer.Exit


def _top(
    version: Annotated[
        bool, typer.Option("--version", callback=_version, is_eager=True, help="Print the version and stop.")
    ] = False,
) -> None:
    pass
