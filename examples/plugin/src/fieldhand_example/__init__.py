"""A driver, a planner and a robot of its own for Fieldhand."""
