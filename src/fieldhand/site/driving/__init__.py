"""Where a robot can drive: open ground, the aisles between rows, and the ways over both.

free      where a robot may be at all: boundary, keep-outs, fences and gates
ground    shortest ways over open ground (a visibility graph), with its corners and chords
access    how a place reaches open ground
rowlines  rows as lines in the frame of their block
outline   how far the rows of a block reach, as an outline with few corners
bodies    the blocks of a site, each with its rows, aisles and outline
aisles    moves within one aisle
spots     where a point lies, and what ways it reaches
layout    all of it together: from any spot to any other
stands    where the robot stands to be at a tree
roads     the ways between many places as a sparse graph
network   aisles, headlands and gates as lines with names
"""
