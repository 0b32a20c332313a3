"""Measured costs of driving, waiting and capturing: kept from missions, and fitted to the robot's profile."""
