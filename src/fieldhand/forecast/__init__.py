"""Forecast of a Task on every branch: distributions of distance, time and energy."""
