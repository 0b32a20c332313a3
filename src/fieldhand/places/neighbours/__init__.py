"""Selectors by distance from places."""
