"""Benchmarks of Fieldhand: how fast it is, and whether missions keep what their forecast and their guard promise.

commands      ``fieldhand bench``, one command a file
site          how long an orchard of a size takes to read, to resolve selectors on, to drive on
planning      how long the English planner takes on an orchard of a size
orienteering  the published experiment on stochastic orienteering: solvers on graphs from files
missions      requests with what they mean, planned, flown and judged from their logs

Experiments on random missions, approved, carried out in simulation and judged from their logs:

scenes        a random orchard and a random robot
families      random plans of seven kinds
draw          the mission of a seed: scene, plan, limits relative to what the plan needs
follow        a plan held against an event log; account: what the log shows of it
referee       a finished mission judged from its Task and its log alone
fly           the mission of a seed flown and judged
summary       many missions in figures
repeated      one request flown many times, against its forecast

The judges know nothing of how the guard decides.
"""

__version__ = "0.1.0"
