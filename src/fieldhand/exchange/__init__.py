"""What other programs read and write: logs as MCAP, plans as GeoJSON, KML, CSV and QGroundControl, trees, replays."""
