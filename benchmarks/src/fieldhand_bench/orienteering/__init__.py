"""The published experiment on stochastic orienteering, repeated: solvers compared on graphs from files.

:func:`fieldhand_bench.orienteering.run.run` simulates missions with each solver and returns their statistics.
"""
