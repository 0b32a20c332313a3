"""Robot profiles."""
