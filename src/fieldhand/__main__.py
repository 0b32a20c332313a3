"""``python -m fieldhand``."""

from fieldhand.program import main

main()
