"""Selectors without a group: every tree, a named place, the current place, labelled places, unions."""
