"""Extension of griffe (mkdocs.yml): docstrings as Markdown, with the roles of reStructuredText as code."""

from __future__ import annotations

import re
from typing import Any

from griffe import Extension, Object

_ROLE = re.compile(r":(?:class|func|meth|mod|attr|data|exc|obj):`(~?)([^`]+)`")


class Roles(Extension):
    """Replaces roles in every docstring: of ``~`` and a dotted name the last part remains."""

    def on_instance(self, *, obj: Object, **_: Any) -> None:
        """Rewrite the docstring of an object."""
        if obj.docstring:
            text = _ROLE.sub(
                lambda role: f"`{role[2].rpartition('.')[2] if role[1] else role[2]}`", obj.docstring.value
            )
            obj.docstring.value = re.sub(r"::\n\n(?=    )", ":\n\n", text)


def _shown(name: str, *, last: bool) -> str:
    return name.rpartition(".")[2] if last else name
