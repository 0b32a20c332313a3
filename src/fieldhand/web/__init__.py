"""The web page: static files of this package, no framework, nothing loaded from elsewhere."""
