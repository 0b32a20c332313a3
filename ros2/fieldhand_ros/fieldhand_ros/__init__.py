"""Fieldhand inside ROS 2."""
