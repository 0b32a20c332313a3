"""Who may approve: keys of those who sign, and on a robot the keys that it trusts."""
