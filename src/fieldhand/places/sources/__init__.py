"""Selectors that name places outright."""
