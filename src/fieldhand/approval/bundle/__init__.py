"""A mission as one signed file: a zip that any tool opens, and that nobody can change unseen."""
