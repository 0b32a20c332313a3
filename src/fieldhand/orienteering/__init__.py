"""Stochastic orienteering: collect reward on a graph whose legs cost a random amount, within budgets.

This room knows no farm. :func:`solve` gives a fixed route, :class:`Policy` decides anew after every leg,
:func:`shortest_order` visits everything. docs/orienteering.md says how.
"""
