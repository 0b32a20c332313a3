"""Readers and writers of site files: GeoJSON, CSV, and the formats that GDAL reads; all readers return the same
records."""
