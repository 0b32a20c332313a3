"""The report as one page that needs nothing beside it: no script, no network, nothing that a name could break."""

from __future__ import annotations

import base64
from collections.abc import Sequence
from functools import cache
from importlib import resources
from typing import TYPE_CHECKING, Any

from fieldhand.evaluation.report_maps import ReportMap
from fieldhand.evaluation.report_text import GOAL_HEAD, HEADINGS, TABLE_HEAD, Report
from fieldhand.visible import visible

if TYPE_CHECKING:
    from jinja2 import Template


def page(report: Report, maps: Sequence[ReportMap]) -> str:
    """The page as HTML; all text in it is escaped."""
    return _template().render(
        r=report,
        h=HEADINGS,
        goal_head=GOAL_HEAD,
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
        # An image of its own: what is inside it cannot reach the page, and its names cannot meet those of other maps.
        "data": base64.b64encode(drawn.svg).decode("ascii"),
        "scale": drawn.scale,
        "lowest": f"{read.say(min(read.values))}{read.unit}" if read is not None and known else "",
        "highest": f"{read.say(max(read.values))}{read.unit}" if read is not None and known else "",
        "marks": drawn.marks,
        "facts": read.words if read is not None else (),
    }


@cache
def _template() -> Template:
    from jinja2 import Environment, StrictUndefined
    from markupsafe import Markup

    folder = resources.files("fieldhand.evaluation") / "page"
    environment = Environment(
        autoescape=True, undefined=StrictUndefined, finalize=_printable, keep_trailing_newline=True
    )
    template = environment.from_string((folder / "report.html").read_text(encoding="utf-8"))
    # The style sheet is this program's own; nothing else goes in unescaped.
    template.globals["css"] = Markup((folder / "report.css").read_text(encoding="utf-8"))  # noqa: S704
    return template


def _printable(value: Any) -> Any:
    """Return text with its hidden characters made visible, line ends kept; anything else as it is."""
    from markupsafe import Markup

    return visible(value, lines=True) if isinstance(value, str) and not isinstance(value, Markup) else value
