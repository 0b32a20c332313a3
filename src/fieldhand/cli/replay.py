"""``fieldhand replay``: a mission drawn again from its event log."""

from __future__ import annotations

from pathlib import Path
from typing import Annotated

import typer

from fieldhand.cli.options import JsonOption, LenientOption, MissionsOption, RecordedSiteOption
from fieldhand.cli.outputs import to_named_file

_ENDINGS = (".html", ".gif", ".mp4")


def replay(
    output: Annotated[
        Path,
        typer.Option(
            "-o", "--output", callback=to_named_file, help="Where to write: .html, .gif, or .mp4 (needs ffmpeg)."
        ),
    ],
    given: Annotated[
        str | None,
        typer.Argument(
            metavar="[MISSION|EVENTS]",
            help="Name or folder of a mission, else the one begun last; or an event log (JSON lines or MCAP).",
        ),
    ] = None,
    site: RecordedSiteOption = None,
    robot: Annotated[str | None, typer.Option("--robot", help="Of a log: the robot; husky if none is given.")] = None,
    seconds: Annotated[float, typer.Option("--seconds", min=0.5, max=120, help="Length of a GIF or MP4.")] = 10.0,
    lenient: LenientOption = False,
    kept: MissionsOption = None,
    json: JsonOption = False,
) -> None:
    """Draw a mission again as an animation: the way, the captures, the clock and the battery."""
    from fieldhand.cli import show
    from fieldhand.cli.bundles import require_site
    from fieldhand.cli.inputs import write_file
    from fieldhand.cli.recorded import folder_of, ground_of, log_of_folder, plan_of_folder, require_nothing_beside
    from fieldhand.errors import OutputError
    from fieldhand.evaluation.event_text import EventText
    from fieldhand.exchange.replay import film_of, page_of, save_animation
    from fieldhand.finished_missions import read_log

    if output.suffix.lower() not in _ENDINGS:
        what = f"{output.suffix or 'no ending'} is no kind of animation"
        raise OutputError(what, where=str(output), advice=f"end its name in {', '.join(_ENDINGS)}")
    folder = folder_of(given, kept)
    if folder is not None:
        require_nothing_beside(folder, site=site, robot=robot)
        log, ground = log_of_folder(folder).events, plan_of_folder(folder).ground
    else:
        log = read_log(Path(given or "")).events
        ground = ground_of(require_site(site), robot, lenient=lenient)
    film = film_of(log, ground.site, tell=EventText(ground.robot).line)
    if output.suffix.lower() == ".html":
        write_file(output, page_of(film, ground.site))
    else:
        save_animation(film, ground.site, output, seconds=seconds)
    if json:
        facts = {"events": len(log), "captures": len(film.captures), "mission_s": film.seconds}
        show.print_json({"file": str(output), **facts})
    else:
        show.out.print(f"Replay: {output}")
