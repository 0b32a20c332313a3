"""Import and export formats: logs as MCAP; plans as GeoJSON, KML, CSV and QGroundControl; trees; replays."""
