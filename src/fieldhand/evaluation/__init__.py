"""The budget guard, the outcome of each goal, the report."""
