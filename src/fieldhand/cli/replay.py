"""``fieldhand replay``: draw a mission as an animation from its event log."""

from __future__ import annotations

from pathlib import Path
from typing import Annotated

import typer

from fieldhand.cli.option_groups import grouped
from fieldhand.cli.options import JsonOption, RecordedArgument, RecordedOptions
from fieldhand.cli.outputs import to_named_file

_ENDINGS = (".html", ".gif", ".mp4")


@grouped("output source site robot seconds lenient missions json")
def replay(
    recorded: RecordedOptions,
    output: Annotated[
        Path,
        typer.Option(
            "-o", "--output", callback=to_named_file, help="Where to write: .html, .gif, or .mp4 (needs ffmpeg)."
        ),
    ],
    source: RecordedArgument = None,
    seconds: Annotated[float, typer.Option("--seconds", min=0.5, max=120, help="Length of a GIF or MP4.")] = 10.0,
    json: JsonOption = False,
) -> None:
    """Draw a mission again as an animation: the way, the captures, the clock and the battery."""
    from fieldhand.cli import show
    from fieldhand.cli.bundles import require_site
    from fieldhand.cli.inputs import write_file
    from fieldhand.cli.recorded import (
        folder_of,
        log_of_folder,
        plan_of_folder,
        require_nothing_beside,
        site_and_robot_of,
    )
    from fieldhand.errors import OutputError
    from fieldhand.exchange.replay import film_of, page_of, save_animation
    from fieldhand.finished_missions import read_log
    from fieldhand.wording.events import EventText

    if output.suffix.lower() not in _ENDINGS:
        what = f"{output.suffix or 'a name without extension'} is not a supported animation format"
        raise OutputError(what, where=str(output), advice=f"use a file name that ends in {', '.join(_ENDINGS)}")
    folder = folder_of(source, recorded.missions)
    if folder is not None:
        require_nothing_beside(folder, site=recorded.site, robot=recorded.robot)
        log, site_and_robot = log_of_folder(folder).events, plan_of_folder(folder).site_and_robot
    else:
        log = read_log(Path(source or "")).events
        site_and_robot = site_and_robot_of(require_site(recorded.site), recorded.robot, lenient=recorded.lenient)
    film = film_of(log, site_and_robot.site, tell=EventText(site_and_robot.robot).line)
    if output.suffix.lower() == ".html":
        write_file(output, page_of(film, site_and_robot.site))
    else:
        save_animation(film, site_and_robot.site, output, seconds=seconds)
    if json:
        facts = {"events": len(log), "captures": len(film.captures), "mission_s": film.seconds}
        show.print_json({"file": str(output), **facts})
    else:
        show.out.print(f"Replay: {output}")
