"""Read untrusted YAML safely: plain values, unique keys, no aliases, and a single exception type."""

from __future__ import annotations

from collections.abc import Hashable
from functools import cache
from typing import TYPE_CHECKING, Any

from fieldhand.hidden_characters import find_hidden

if TYPE_CHECKING:
    import yaml

#: Maximum number of bits of an integer; larger ones cannot be converted to a float.
_MOST_BITS = 1000
#: Maximum nesting depth of mappings and lists; a world file has six levels.
_DEEPEST = 50
_LONGEST = 200


class YamlFault(Exception):
    """The reason why a YAML text was refused; callers convert it to an error of their own.

    Attributes:
        what: Description of the problem.
        line: Line number from 1; None if the problem concerns the whole text.
    """

    def __init__(self, what: str, line: int | None = None) -> None:
        self.what = what if len(what) <= _LONGEST else f"{what[: _LONGEST - 3]}..."
        self.line = line
        super().__init__(what)


def read_yaml(text: str, *, aliases: bool = False) -> Any:
    """Parse a YAML text into mappings, lists and plain values; return None for an empty text.

    Args:
        text: Untrusted text.
        aliases: Allow aliases (``*name`` for ``&name``). With them, a small text can expand to a huge one.

    Raises:
        YamlFault: The text is not YAML, or has duplicate or merged keys, an alias, a tag that does not fit its value, a
            number outside the range of floats, a hidden character, or too deep nesting.
    """
    import yaml

    try:
        return yaml.load(text, Loader=_loader(aliases))  # noqa: S506  a SafeLoader
    except yaml.MarkedYAMLError as error:
        mark = error.problem_mark or error.context_mark
        raise YamlFault(str(error.problem or error.context), mark.line + 1 if mark else None) from None
    except yaml.YAMLError as error:
        raise YamlFault(" ".join(str(error).split())) from None
    except (ValueError, ArithmeticError) as error:  # their words differ between releases of Python
        raise YamlFault(f"a character or a number is out of range ({' '.join(str(error).split())})") from None


@cache
def _loader(aliases: bool) -> type[yaml.SafeLoader]:
    import yaml

    class StrictLoader(yaml.SafeLoader):
        depth = 0

        def compose_node(self, parent: yaml.Node | None, index: int) -> yaml.Node | None:
            mark = self.peek_event().start_mark  # type: ignore[no-untyped-call]
            if not aliases and self.check_event(yaml.AliasEvent):
                raise yaml.composer.ComposerError(None, None, "aliases (*name) are not allowed", mark)
            if self.depth > _DEEPEST:
                raise yaml.composer.ComposerError(None, None, "it is nested too deeply", mark)
            self.depth += 1
            node = super().compose_node(parent, index)
            self.depth -= 1
            return node

        def construct_object(self, node: yaml.Node, deep: bool = False) -> Any:
            try:
                value = super().construct_object(node, deep)
                if isinstance(value, str):
                    value.encode()  # fails for a lone surrogate, which an escape sequence can produce
            except (ArithmeticError, AttributeError, LookupError, TypeError, ValueError):
                # The library does not check that a tag, explicit or resolved, fits its value.
                tag = str(node.tag).rpartition(":")[2]
                raise self._error(node, f"{str(node.value)[:40]!r} cannot be read as {tag}") from None
            hidden = find_hidden(value, lines=True) if isinstance(value, str) else None
            if hidden is not None:
                raise self._error(node, f"the text contains the invisible character {hidden.name}")
            if isinstance(value, int) and value.bit_length() > _MOST_BITS:
                raise self._error(node, "the number is too large")
            return value

        def construct_mapping(self, node: yaml.MappingNode, deep: bool = False) -> dict[Hashable, Any]:
            seen: set[str] = set()
            for key, _ in node.value if isinstance(node, yaml.MappingNode) else ():
                if key.tag == "tag:yaml.org,2002:merge":
                    raise self._error(key, "merged keys (<<) are not allowed")
                if isinstance(key, yaml.ScalarNode) and key.value in seen:
                    raise self._error(key, f"the key {key.value[:40]!r} is given twice")
                seen.add(str(key.value))
            return super().construct_mapping(node, deep)

        def _error(self, node: yaml.Node, what: str) -> yaml.constructor.ConstructorError:
            return yaml.constructor.ConstructorError(None, None, what, node.start_mark)

    return StrictLoader
