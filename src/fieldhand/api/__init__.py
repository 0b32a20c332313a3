"""REST API over the mission steps."""
