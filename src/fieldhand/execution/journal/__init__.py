"""Durable execution: what a mission needs to go on after a power cut at any instant (docs/execution.md, "Journal")."""
