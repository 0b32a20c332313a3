"""A planner with any language model behind it."""
