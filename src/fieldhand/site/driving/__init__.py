"""Where a robot can drive: ground without obstacles, the shortest ways over it, and the aisles between rows.

free        where a robot may be at all: boundary, keep-outs, fences and gates
rowlines    rows as lines in the frame of their block
aisles      rows side by side in groups, the aisles between them, the headlands at their ends
row_obstacles  the ground around each row that a robot keeps off, as a polygon with few corners
row_axes    the lines along rows that no way crosses, and which points they part
visibility  the corners of a ground that see each other, and what other points see
graph       shortest ways over a sparse graph
layout      all of it together: from any point to any other
standing    where the robot stands to be at a tree
sides       from which side the trees of a visit list are worked on
roads       the ways between many places as a sparse graph
network     aisles, headlands and gates as lines with names
reasons     why a place cannot be driven to
"""
