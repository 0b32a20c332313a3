"""Requests in English with what each has to become, and small orchards to make them on."""
