"""The built-in robots as entry points of the group ``fieldhand.robots``: each is the YAML file of a profile.

A distribution registers a robot in the same way; the value is a :class:`pathlib.Path` or a resource of
:func:`importlib.resources.files`.
"""

from __future__ import annotations

from importlib import resources

_FOLDER = resources.files("fieldhand.robot") / "profiles"

AMIGA = _FOLDER / "amiga.yaml"
HUSKY = _FOLDER / "husky.yaml"
TRACTOR = _FOLDER / "tractor.yaml"
