"""Words about earlier missions: periods of the past, what was done in them, and what was read."""
