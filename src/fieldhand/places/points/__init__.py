"""Selectors of free points, independent of trees."""
