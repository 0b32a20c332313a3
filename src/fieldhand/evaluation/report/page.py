"""Render the report as one HTML page without scripts, links or other files."""

from __future__ import annotations

import base64
from collections.abc import Sequence
from functools import cache
from importlib import resources
from typing import TYPE_CHECKING, Any

from fieldhand.evaluation.report.content import GOAL_HEAD, HEADINGS, TABLE_HEAD, ReportContent
from fieldhand.evaluation.report.maps import ReportMap
from fieldhand.evaluation.report.worked import WORKED_HEAD
from fieldhand.hidden_characters import visible

if TYPE_CHECKING:
    from jinja2 import Template


def render_page(report: ReportContent, maps: Sequence[ReportMap]) -> str:
    """Return the page as HTML with all text escaped."""
    return _template().render(
        r=report,
        h=HEADINGS,
        goal_head=GOAL_HEAD,
        worked_head=WORKED_HEAD,
        table_head=TABLE_HEAD,
        maps=[_map_record(m) for m in maps],
    )


def _map_record(drawn: ReportMap) -> dict[str, Any]:
    read = drawn.summary
    known = read is not None and bool(read.values)
    return {
        "title": drawn.title,
        "width": f"{drawn.width:.0f}",
        "height": f"{drawn.height:.0f}",
        # An embedded image is isolated: its content cannot affect the page, nor its ids clash with other maps.
        "data": base64.b64encode(drawn.svg).decode("ascii"),
        "scale": drawn.scale,
        "lowest": f"{read.say(min(read.values))}{read.unit}" if read is not None and known else "",
        "highest": f"{read.say(max(read.values))}{read.unit}" if read is not None and known else "",
        "legend": drawn.legend,
        "facts": read.words if read is not None else (),
    }


@cache
def _template() -> Template:
    from jinja2 import Environment, StrictUndefined
    from markupsafe import Markup

    folder = resources.files("fieldhand.evaluation.report")
    environment = Environment(
        autoescape=True, undefined=StrictUndefined, finalize=_printable, keep_trailing_newline=True
    )
    template = environment.from_string((folder / "report.html").read_text(encoding="utf-8"))
    # The style sheet ships with the package; nothing else is inserted unescaped.
    template.globals["css"] = Markup((folder / "report.css").read_text(encoding="utf-8"))  # noqa: S704
    return template


def _printable(value: Any) -> Any:
    """Return text with hidden characters made visible and line ends kept; return other values unchanged."""
    from markupsafe import Markup

    return visible(value, lines=True) if isinstance(value, str) and not isinstance(value, Markup) else value
