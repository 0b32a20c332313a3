"""The profile of the cart as an entry point of the group ``fieldhand.robots``."""

from importlib import resources

CART = resources.files("fieldhand_example") / "cart.yaml"
