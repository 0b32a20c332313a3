"""A Task as a behavior tree, its drivers, its events."""
