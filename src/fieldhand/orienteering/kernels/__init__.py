"""Compiled inner loops on arrays, without validation of arguments; called only by :mod:`fieldhand.orienteering`.

Vertices are numbered 0 to n - 1. The end of a route is a separate node n, so that a round trip has two ends.
"""
