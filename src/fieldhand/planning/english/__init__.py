"""A planner with a grammar and a lexicon: no model, no network."""
