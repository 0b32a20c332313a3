"""Selectors along and across rows."""
