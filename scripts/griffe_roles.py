"""A griffe extension (mkdocs.yml) that turns reStructuredText roles in docstrings into Markdown code."""

from __future__ import annotations

import re
from typing import Any

from griffe import Extension, Object

_ROLE = re.compile(r":(?:class|func|meth|mod|attr|data|exc|obj):`(~?)([^`]+)`")


class Roles(Extension):
    """Extension that replaces the roles of every docstring; ``~`` reduces a dotted name to its last part."""

    def on_instance(self, *, obj: Object, **_: Any) -> None:
        """Rewrite the docstring of an object."""
        if obj.docstring:
            text = _ROLE.sub(
                lambda role: f"`{role[2].rpartition('.')[2] if role[1] else role[2]}`", obj.docstring.value
            )
            obj.docstring.value = re.sub(r"::\n\n(?=    )", ":\n\n", text)


def _shown(name: str, *, last: bool) -> str:
    return name.rpartition(".")[2] if last else name
