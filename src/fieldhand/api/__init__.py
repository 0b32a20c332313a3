"""The REST API, one router a file; docs/api.md describes it."""
