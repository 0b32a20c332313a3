"""Forecast of a Task: drives, time and energy as distributions, on every branch."""
