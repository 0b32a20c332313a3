"""The kinds of plan nodes, one file each with data, execution and wording."""
