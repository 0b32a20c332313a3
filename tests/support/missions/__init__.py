"""Missions for tests: carried out, kept in folders, signed, driven on paper, with faults or mistakes planted."""
