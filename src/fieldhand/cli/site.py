"""``fieldhand site``: what is known of a site."""

from __future__ import annotations

from typing import Annotated

import typer

from fieldhand.cli.options import JsonOption, PictureOption


def site(
    file: Annotated[str, typer.Argument(help="GeoJSON file of the site, or 'demo' for the built-in orchard.")],
    picture: PictureOption = None,
    json: JsonOption = False,
) -> None:
    """Say what was understood of a site: trees, markers, zones, attributes."""
    from dataclasses import asdict

    from fieldhand.cli import show
    from fieldhand.site.describe import describe, summary_lines
    from fieldhand.site.geojson import open_site

    opened = open_site(file)
    if picture is not None:
        from fieldhand.site.drawing import save_site_picture

        save_site_picture(opened, picture)
    if json:
        show.print_json(asdict(describe(opened)))
        return
    for line in summary_lines(opened):
        show.out.print(line)
    if picture is not None:
        show.out.print(f"Map: {picture}")
