"""Paths along which an implement works: beside rows, through aisles, over areas and along their edges."""
