"""Commands, servers, agents and callers of tests, and how long to wait for them."""
