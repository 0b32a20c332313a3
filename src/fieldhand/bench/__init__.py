"""Experiments on whole missions: approved, carried out in simulation, judged from their logs.

scenes      a random orchard and a random robot
families    random plans of seven kinds
draw        a mission of a seed: scene, plan, limits that are drawn relative to what the plan needs
follow      a plan held against an event log; account: what the log shows of it
referee     a finished mission judged from its Task and its log alone
fly         a mission of a seed flown and judged
summary     many missions in figures
repeated    one request flown many times, against its forecast
missions    requests with what they mean, planned, flown and judged from their logs
planning    how long the English planner takes on an orchard of a size

Nothing in it knows how the guard decides. It stands above ``mission``, which puts guard, simulation and
runtime together.
"""
