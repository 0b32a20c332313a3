"""Replay of a mission from its event log (docs/exchange.md, "Replay")."""

from fieldhand.exchange.replay.film import film_of
from fieldhand.exchange.replay.moving import save_animation
from fieldhand.exchange.replay.page import page_of

__all__ = ["film_of", "page_of", "save_animation"]
