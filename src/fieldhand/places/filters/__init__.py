"""Selectors that filter trees by attributes, zones, distance and previous visits."""
