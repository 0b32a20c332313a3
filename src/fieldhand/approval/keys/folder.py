"""Where keys are kept: in the user's configuration."""

from __future__ import annotations

from collections.abc import Mapping
from pathlib import Path


def config_folder(environ: Mapping[str, str]) -> Path:
    """``FIELDHAND_CONFIG``, else ``fieldhand`` in the user's folder for configuration."""
    own = environ.get("FIELDHAND_CONFIG")
    if own:
        return Path(own)
    config = environ.get("XDG_CONFIG_HOME") or str(Path(environ.get("HOME") or "~").expanduser() / ".config")
    return Path(config) / "fieldhand"
