"""``fieldhand outbox``: list the missions that were sent, or wait for their robot."""

from __future__ import annotations

import os

from fieldhand.cli.options import JsonOption


def outbox(json: JsonOption = False) -> None:
    """List the missions that were sent, and those that wait for their robot."""
    from fieldhand.cli import show
    from fieldhand.cli.send import line, record
    from fieldhand.delivery.outbox import Outbox, outbox_folder

    entries = Outbox(outbox_folder(os.environ)).entries()
    if json:
        show.print_json([record(entry) for entry in entries])
        return
    if not entries:
        show.out.print("Nothing was sent from here.")
    for entry in entries:
        show.out.print(line(entry))
