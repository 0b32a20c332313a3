"""Hooks of the site of the docs (mkdocs.yml)."""

from __future__ import annotations

import re
from typing import Any

#: A link to a file of the repository that is no page of the site.
_OUTSIDE = re.compile(r"\[([^\]]+)\]\((?:\.\./|[^)\s]*\.ipynb)[^)]*\)")


def on_page_markdown(markdown: str, **_: Any) -> str:
    """Return a page with links that leave the site as their text alone."""
    return _OUTSIDE.sub(r"\1", markdown)
