"""Where a mission goes, for maps, spreadsheets and ground stations: planned from a Task, or driven from a log."""
