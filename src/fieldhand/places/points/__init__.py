"""Selectors of free points, tied to no tree."""
