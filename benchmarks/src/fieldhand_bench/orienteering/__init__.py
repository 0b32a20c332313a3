"""The published experiment, run again: solvers against each other on graphs from files.

:func:`fieldhand_bench.orienteering.run.run` drives missions with each solver and says what they collected.
"""
