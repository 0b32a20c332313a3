"""Benchmarks of Fieldhand: its speed, the accuracy of its forecasts, and the reliability of its budget guard.

commands      ``fieldhand bench``, one command a file
site          time to load an orchard of a given size, to resolve selectors and to compute drives on it
planning      time that the English planner takes on an orchard of a given size
orienteering  the published experiment on stochastic orienteering: solvers compared on graphs from files
missions      requests with expected outcomes: planned, simulated and judged from their event logs

Experiments on random missions, which are approved, simulated and judged from their event logs:

scenes        a random orchard and a random robot
families      random plans of seven kinds
draw          the random mission of a seed: scene, plan, and limits relative to what the plan needs
follow        compares a plan with an event log; account: the result of that comparison
referee       judges a finished mission from its Task, its site and its event log alone
fly           approves, simulates and judges the mission of a seed
summary       statistics of many missions
repeated      one request simulated many times and compared with its forecast

The judges are independent of how the guard decides.
"""

__version__ = "0.1.0"
