"""The parser's lexer. A module of its own: Lark keeps it by name with the tables, and is loaded only to parse."""

from __future__ import annotations

from collections.abc import Iterator
from typing import Any

from lark.lexer import Lexer


class TermLexer(Lexer):
    """Terms are tokens already."""

    def __init__(self, conf: Any) -> None:
        pass

    # Lark hands a lexer of this older form the data alone, whatever its base class declares.
    def lex(self, data: Any) -> Iterator[Any]:  # type: ignore[override]
        yield from data
