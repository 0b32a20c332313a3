"""Drivable ground of a site, shortest paths over it, and the aisles between rows.

free_space        ground where a robot may be: boundary, keep-outs, fences and gates
rowlines          rows as lines in the frame of their block
aisles            groups of adjacent rows, the aisles between them, the headlands at their ends
row_obstacles     the polygon around each row that the robot's centre avoids
row_axes          the lines along rows that no path crosses, and which points they separate
visibility_graph  corners of the ground that see each other, and the corners that other points see
graph             shortest paths over a sparse graph
layout            shortest paths between any two points of a site
stands            positions from which the robot works on a tree
lane_choice       the side from which the trees of each row are worked on
roadmap           the paths between many places as a sparse graph
network           aisles, headlands and gates as named lines
reasons           explanations of unreachable places
"""
