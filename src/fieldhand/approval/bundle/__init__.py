"""A mission as one signed, tamper-evident file: a zip archive that any tool can open."""
