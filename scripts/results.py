"""Print hashes of plans and of simulated missions, to be compared between releases of Python.

python scripts/results.py
"""

from __future__ import annotations

import hashlib

import fieldhand as fh
from fieldhand.task.codec import encode
from fieldhand.task.event_lines import to_json

REQUESTS = (
    "Photograph every third tree of row 2.",
    "Measure CO2 at all four corners.",
    "Measure CO2 at the middle tree. If it is low, take 2 pictures of nearby trees, else one of tree 9.",
    "Take pictures of 5 random trees.",
    "Take a thermal picture of every other tree of row 3, starting with the second.",
    "Every Monday at 7 am, read CO2 at tree 4.",
)


def digest(text: str | bytes) -> str:
    """Return the first digits of the SHA-256 of a text."""
    return hashlib.sha256(text.encode() if isinstance(text, str) else text).hexdigest()[:16]


def main() -> None:
    """Plan each request, simulate its mission, and print the hashes of Task and events."""
    site, robot = fh.Site.demo(), fh.Robot.load("husky")
    for request in REQUESTS:
        task = fh.plan(request, site, robot).task
        mission = fh.authorize(fh.review(task, site, robot), by="Ada")
        events = fh.simulate(mission, seed=1).events
        print(digest(encode(task)), digest("\n".join(map(to_json, events))), request)


if __name__ == "__main__":
    main()
