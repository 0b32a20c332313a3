"""Site files in and out: GeoJSON, CSV, and what GDAL reads; each reader gives the same records."""
