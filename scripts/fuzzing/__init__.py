"""What ``scripts/fuzz.py`` feeds to the readers of Fieldhand: seeds, mutations, targets."""
