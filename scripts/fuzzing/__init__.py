"""Seeds, mutations and targets of ``scripts/fuzz.py``."""
