"""Journal of a mission, from which it resumes after a power cut at any instant (docs/execution.md, "Journal")."""
