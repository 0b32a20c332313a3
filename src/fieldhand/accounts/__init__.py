"""Accounts of the server: people with a password and a role, their sessions and tokens, and the audit log."""
