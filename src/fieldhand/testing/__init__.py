"""Helpers for tests of a driver, a planner or a client of your own; nothing else in the package imports them.

driver_contract   what every driver does, as a base class of tests
planner_contract  what every planner does, as a base class of tests
small_orchard     a small site, and Tasks on it, made in memory
scripted_chat     a language model that gives prepared answers
fixed_clock       a time of day that passes only when a test lets it
generated         Hypothesis strategies: orchards, Tasks, event logs (needs Hypothesis)

The clock of a mission is an argument as well: :class:`fieldhand.clock.SimulatedClock` jumps instead of waiting, and
:class:`fieldhand.execution.drivers.simulation.driver.SimulatedDriver` is the robot that goes with it.
"""
