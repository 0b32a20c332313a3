"""Keys for approval: a person's signing keys and the keys that a robot trusts."""
