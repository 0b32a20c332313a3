"""The robot's end of a delivery as HTTP: missions come in, orders are taken, state and events go out."""
