"""Selectors by position in the extent of a group: halves, edges, corners, middles."""
