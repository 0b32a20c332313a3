"""Checks, read-back, map, and the authorization that only this room gives."""
