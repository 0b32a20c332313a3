"""Stochastic orienteering: collect reward on a graph whose legs cost a random amount, within budgets.

This package is independent of farms and robots. :func:`solve` computes a fixed route, :class:`Policy` replans after
every leg, :func:`shortest_order` visits every vertex. docs/orienteering.md describes the methods.
"""
