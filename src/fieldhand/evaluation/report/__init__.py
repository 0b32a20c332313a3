"""The report of a mission: one HTML page that stands alone, and its observations as CSV and GeoJSON."""
