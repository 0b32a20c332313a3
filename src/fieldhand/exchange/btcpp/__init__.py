"""Tasks as trees of BehaviorTree.CPP v4, and back (docs/exchange.md, "BehaviorTree.CPP")."""

from fieldhand.exchange.btcpp.reading import read_tree
from fieldhand.exchange.btcpp.writing import write_tree

__all__ = ["read_tree", "write_tree"]
