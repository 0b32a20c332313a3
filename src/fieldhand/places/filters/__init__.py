"""Selectors that keep trees by what they are, by zones and by what was visited."""
