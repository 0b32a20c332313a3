"""Plan nodes as py_trees behaviours, grouped by idea: leaves that work, loops, choices between branches."""
