"""Web pages over the API."""
