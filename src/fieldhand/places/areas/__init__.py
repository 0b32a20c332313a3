"""Selectors by where trees stand in the extent of a group: halves, edges, corners, middles."""
