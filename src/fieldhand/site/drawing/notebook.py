"""Show a site as HTML in notebooks: its picture and description."""

from __future__ import annotations

from io import BytesIO
from typing import TYPE_CHECKING

from fieldhand.markup import element, picture_html

if TYPE_CHECKING:
    from matplotlib.figure import Figure

    from fieldhand.site.model import Site

_DPI = 90


def html_of_site(site: Site) -> str:
    """Return the picture and the description of a site as HTML."""
    from fieldhand.site.describe.lines import report_lines
    from fieldhand.site.drawing.picture import site_picture

    return element("h4", site.name) + figure_html(site_picture(site)) + element("pre", "\n".join(report_lines(site)))


def figure_html(figure: Figure) -> str:
    """Return a figure as an embedded PNG."""
    from fieldhand.site.drawing.saving import make_text_visible

    make_text_visible(figure)
    data = BytesIO()
    figure.savefig(data, format="png", dpi=_DPI)
    return picture_html(data.getvalue(), "image/png")
