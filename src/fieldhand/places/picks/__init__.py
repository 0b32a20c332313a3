"""Selectors that order, count and sample places."""
