"""Routes of a planned Task or a mission log, exported for maps, spreadsheets and ground stations."""
