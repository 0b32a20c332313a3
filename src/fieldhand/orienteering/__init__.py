"""Stochastic orienteering: a graph, rewards, random leg costs, a budget. Knows no farm."""
