"""Change figures in the text of a profile and keep everything else: comments, order, spacing."""

from __future__ import annotations

from collections.abc import Mapping

import yaml

from fieldhand.errors import ProfileError
from fieldhand.robot.loader import GUIDE, parse_profile

#: Significant digits of a written figure.
_DIGITS = 4

Keys = tuple[str, ...]


def with_figures(data: bytes, figures: Mapping[Keys, float], *, note: str, source: str = "profile") -> bytes:
    """Return the text of a profile with other figures.

    Args:
        data: Text of a valid profile.
        figures: New values by key path: ``("energy", "idle_w")``.
        note: Comment for its first line.
        source: Name of the profile in messages.

    Raises:
        ProfileError: A key is not in the text, or the result is not a valid profile.
    """
    text = data.decode("utf-8-sig")
    root = yaml.compose(text, Loader=yaml.SafeLoader)
    edits = []
    for keys, value in figures.items():
        node = _find(root, keys)
        if node is None:
            raise ProfileError(
                f"the key {'.'.join(keys)!r} is not in the text", where=source, advice=f"write it out; {GUIDE}"
            )
        edits.append((node.start_mark.index, node.end_mark.index, figure(value)))
    for start, end, replacement in sorted(edits, reverse=True):
        text = f"{text[:start]}{replacement}{text[end:]}"
    comment = "".join(f"# {' '.join(line.split())}\n" for line in note.splitlines())
    changed = f"{comment}{text}".encode()
    parse_profile(changed, source=source)
    return changed


def figure(value: float) -> str:
    """Return a figure as text: 1234.6 is "1235", 0.98765 is "0.9877"."""
    if value == 0:
        return "0"
    text = f"{value:.{_DIGITS}g}"
    return f"{float(text):.0f}" if abs(value) >= 10 ** (_DIGITS - 1) else text if "e" not in text else f"{value:.12f}"


def _find(root: yaml.Node | None, keys: Keys) -> yaml.ScalarNode | None:
    node = root
    for key in keys:
        if not isinstance(node, yaml.MappingNode):
            return None
        node = next((value for name, value in node.value if name.value == key), None)
    return node if isinstance(node, yaml.ScalarNode) else None
