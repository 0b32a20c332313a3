"""The Task of IEEE 1872.1-2024: frames, plan nodes, conditions and events as data, and their XML."""
