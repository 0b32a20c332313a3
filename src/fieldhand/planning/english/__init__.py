"""English as a language of requests: its words, its names for a robot and a site, and its planner.

``planner`` reads a request with the grammar of :mod:`fieldhand.planning.grammar`, whose words come from ``lexicon``
(``vocabulary.toml``, inflected, and the names of the robot and the site). ``wishes`` are what no plan can express.
"""
