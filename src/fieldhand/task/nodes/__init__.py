"""The kinds of plan nodes: one file each with its data, its meaning and its words."""
