"""``fieldhand bench``: one command a file, added to the command line by an entry point (``app``)."""
