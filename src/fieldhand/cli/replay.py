"""``fieldhand replay``: a mission drawn again from its event log."""

from __future__ import annotations

from pathlib import Path
from typing import Annotated

import typer

from fieldhand.cli.options import JsonOption, LenientOption, RobotOption, SiteOption

_ENDINGS = (".html", ".gif", ".mp4")


def replay(
    events: Annotated[Path, typer.Argument(help="An event log (JSON lines or MCAP), whole or cut off.")],
    site: SiteOption,
    output: Annotated[
        Path, typer.Option("-o", "--output", help="Where to write: .html, .gif, or .mp4 (needs ffmpeg).")
    ],
    robot: RobotOption = "husky",
    seconds: Annotated[float, typer.Option("--seconds", min=0.5, max=120, help="Length of a GIF or MP4.")] = 10.0,
    lenient: LenientOption = False,
    json: JsonOption = False,
) -> None:
    """Draw a mission again as an animation: the way, the captures, the clock and the battery."""
    from fieldhand.cli import show
    from fieldhand.cli.inputs import open_ground, write_file
    from fieldhand.errors import OutputError
    from fieldhand.evaluation.telling import Teller
    from fieldhand.exchange.replay import film_of, page_of, save_animation
    from fieldhand.past import read_log

    if output.suffix.lower() not in _ENDINGS:
        what = f"{output.suffix or 'no ending'} is no kind of animation"
        raise OutputError(what, where=str(output), advice=f"end its name in {', '.join(_ENDINGS)}")
    log = read_log(events)
    ground = open_ground(site, robot, lenient=lenient)
    film = film_of(log, ground.site, tell=Teller(ground.robot).tell)
    if output.suffix.lower() == ".html":
        write_file(output, page_of(film, ground.site))
    else:
        save_animation(film, ground.site, output, seconds=seconds)
    if json:
        facts = {"events": len(log), "captures": len(film.captures), "mission_s": film.seconds}
        show.print_json({"file": str(output), **facts})
    else:
        show.out.print(f"Replay: {output}")
