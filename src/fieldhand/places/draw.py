"""Drawing at random, so that preview, approval, robot and replay draw the same trees."""

from __future__ import annotations

import hashlib

from fieldhand.language import message
from fieldhand.places.spots import Spots
from fieldhand.places.tell import Tell


def drawn(spots: Spots, count: int, seed: int, tell: Tell) -> Spots:
    """Return ``count`` of the places, each as likely as any other, in the order of the file.

    Each place gets a number from the SHA-256 of the seed and its id, and the lowest are drawn (bottom-k sampling, Cohen
    and Kelley 2007). So the draw depends on no program's generator and not on the order of the file.
    """
    lots = [hashlib.sha256(f"{seed}\n{place.id}".encode()).digest() for place in spots.places]
    taken = sorted(range(len(lots)), key=lambda k: lots[k])[:count]
    tell.rule = message("drawn by seed {seed}", seed=seed)
    return spots.keep(sorted(taken, key=lambda k: int(spots.file_order[k])))
