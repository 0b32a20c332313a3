"""Images of captures: saved beside the journal with position, time and names, and referenced by the event log."""
