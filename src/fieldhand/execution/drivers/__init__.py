"""What carries out drives and actions: a protocol and its simulated twin."""
