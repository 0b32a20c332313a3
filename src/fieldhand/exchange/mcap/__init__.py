"""Event logs as MCAP files, which Foxglove and Lichtblick open, and back (docs/exchange.md, "MCAP")."""

from fieldhand.exchange.mcap.reading import is_mcap, read_mcap
from fieldhand.exchange.mcap.writing import McapLog

__all__ = ["McapLog", "is_mcap", "read_mcap"]
