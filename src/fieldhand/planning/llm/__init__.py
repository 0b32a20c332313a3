"""Planner that uses a language model of any provider."""
