"""What a Task will take: drives, time and energy, as a distribution."""
