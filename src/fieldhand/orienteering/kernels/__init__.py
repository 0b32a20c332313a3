"""Compiled inner loops: arrays in, arrays out, nothing checked. Only :mod:`fieldhand.orienteering` calls them.

Vertices are 0 to n - 1; the end of a route is a node of its own with number n, so that a round trip has two ends.
"""
