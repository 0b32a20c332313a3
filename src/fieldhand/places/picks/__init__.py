"""Selectors that order, count and draw."""
