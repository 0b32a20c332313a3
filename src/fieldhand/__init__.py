"""Fieldhand: plain words to a checked, approved mission for a field robot."""

__version__ = "0.1.0"
