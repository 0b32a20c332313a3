"""The simulated robot, and the world in which it drives: its readings and its faults."""
