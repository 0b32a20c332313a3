"""From words to a Task."""
