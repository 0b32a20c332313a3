"""Drivers, which carry out drives and actions: the protocol and its implementations."""
