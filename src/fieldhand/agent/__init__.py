"""The HTTP server of a robot's agent: it receives missions and commands, and sends state and events."""
