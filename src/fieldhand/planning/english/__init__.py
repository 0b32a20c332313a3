"""Plans a request with a grammar and a lexicon: no model, no network, the same answer every time.

The way of a request: ``tokens`` (words with their places) → ``lexicon`` (what each means) → ``arrange`` (sentences;
what separates and what joins) → ``syntax`` (parts, by grammar.lark) → ``discourse`` (what refers to what, what nests in
what; ``places``, ``tested`` and ``counting`` read its phrases) → ``draft`` → Task. ``planner`` puts them together.
"""
