"""Helpers for testing your own driver, planner or client; no other module of the package imports them.

driver_contract   tests that every driver must pass, as a base class
planner_contract  tests that every planner must pass, as a base class
solver_contract   tests that every orienteering solver must pass, as a base class
small_orchard     a small site and Tasks on it, built in memory
scripted_chat     a language model with prepared answers
fixed_clock       a date and time that a test sets
generated         Hypothesis strategies: orchards, Tasks, event logs (needs Hypothesis)

For mission time, use :class:`fieldhand.clock.SimulatedClock`, which never waits, and as the robot
:class:`fieldhand.execution.drivers.simulation.driver.SimulatedDriver`.
"""
