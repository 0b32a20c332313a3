"""The databases that these tests run on."""

from support.databases import database, servers, url

__all__ = ["database", "servers", "url"]
