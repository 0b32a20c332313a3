"""What driving, waiting and capturing really cost a robot: kept from its missions, and fitted to its profile."""
