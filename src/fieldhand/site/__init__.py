"""The orchard: trees, markers, zones, places, drives."""
