"""Coverage of generated blocks: what a plan covers, how far it drives, and the same blocks with Fields2Cover.

blocks        the generated blocks: convex, concave, with holes, with curved edges, planted
fields2cover  the plans of Fields2Cover, if its Python module is installed
measure       the figures of both for each block
plot          a picture of the plans
"""
