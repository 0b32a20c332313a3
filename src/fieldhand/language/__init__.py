"""Translatable messages: catalogues of translations, numbers, and the wording of nouns and lists.

A message is its English text together with its template and placeholder values. Only the edges of the program choose
a language; code that prints asks a :class:`Language` for the translated text.
"""

from fieldhand.language.catalogue import ENGLISH, Language, languages, open_language, spoken
from fieldhand.language.message import (
    LOG,
    Message,
    Number,
    counted,
    joined,
    kept_in_log,
    labelled,
    message,
    named,
    recalled,
    shaped,
)
from fieldhand.language.request_language import RequestLanguage, language_of_request

__all__ = [
    "ENGLISH",
    "LOG",
    "Language",
    "Message",
    "Number",
    "RequestLanguage",
    "counted",
    "joined",
    "kept_in_log",
    "labelled",
    "language_of_request",
    "languages",
    "message",
    "named",
    "open_language",
    "recalled",
    "shaped",
    "spoken",
]
