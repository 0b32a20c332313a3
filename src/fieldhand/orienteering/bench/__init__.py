"""The published experiment, run again: solvers against each other on graphs from files.

:func:`fieldhand.orienteering.bench.run.run` drives missions with each solver and says what they collected.
"""
