"""The REST API: thin, one router a file; what is served stands in docs/api.md."""
