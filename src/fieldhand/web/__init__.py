"""The web page: static files of this package, without a framework or external resources."""
