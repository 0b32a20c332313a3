"""``fieldhand demo``: the whole way on the built-in orchard, with no key and no network."""

from __future__ import annotations

from pathlib import Path
from typing import Annotated

import typer

from fieldhand.cli.driver_options import DomainOption, DriverOption, NamespaceOption, OnOption, SimTimeOption
from fieldhand.cli.options import LangOption, SeedOption
from fieldhand.cli.outputs import to_folder

REQUEST = (
    "Take a thermal picture at the four corner trees, in any order, and where the canopy is hotter than 34 °C measure"
    " CO2 too. Then take pictures of as many Carmel trees in the northern half as you can without driving more than"
    " 450 meters."
)


def demo(
    output: Annotated[
        Path, typer.Option("-o", "--out", callback=to_folder, help="Folder for what the mission leaves behind.")
    ] = Path("out"),
    seed: SeedOption = 7,
    lang: LangOption = None,
    on: OnOption = None,
    domain: DomainOption = None,
    namespace: NamespaceOption = None,
    sim_time: SimTimeOption = False,
    driver_option: DriverOption = None,
) -> None:
    """Plan, approve, drive and judge a mission on the built-in orchard."""
    import os
    import shutil
    from dataclasses import replace

    from fieldhand.approval.production import require_unsigned_allowed
    from fieldhand.cli import show
    from fieldhand.cli.asking import Replies, plan_or_read
    from fieldhand.cli.driver_options import connected, connection_of
    from fieldhand.cli.flight import Orders, fly
    from fieldhand.cli.inputs import open_ground
    from fieldhand.execution.drivers.simulation.world import World
    from fieldhand.language import message, spoken

    language = spoken(lang, os.environ)
    require_unsigned_allowed(os.environ)
    connection = connection_of(
        on, domain, namespace, sim_time=sim_time, environ=os.environ, options=driver_option or ()
    )
    ground = open_ground("demo", "husky", language=language)
    task, document, planner = plan_or_read(REQUEST, ground, "english", None, Replies(language=language))
    # Nobody is there to read the warning that the budget is tight; it is shown, and the report says it was confirmed.
    orders = Orders(ask=False, confirm=True, by="demo", world=World(), seed=seed, folder=output, language=language)
    with connected(ground, task, connection, quiet=False, language=language) as vehicle:
        status = fly(ground, task, document, replace(orders, vehicle=vehicle), planner=planner)
    show.heading(language.say(message("Try next")))
    if shutil.which("fieldhand") is None:
        show.out.print("  . .venv/bin/activate")
    for line in (
        'fieldhand plan "Take pictures of the 5 trees with the highest yield." --site demo',
        'fieldhand run "Measure CO2 at the middle tree. If it is low, take 2 pictures of nearby trees." --site demo',
        "fieldhand site demo --picture orchard.png",
        "fieldhand robot husky",
        "fieldhand serve",
    ):
        show.out.print(f"  {line}")
    raise SystemExit(status)
