"""The nouns of IEEE 1872.1 as pure data, and their XML."""
