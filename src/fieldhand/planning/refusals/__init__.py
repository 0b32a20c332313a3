"""Refusals that help: what a request asks for in vain, what of it was understood, and a request that can be planned."""
