"""Requests with expected outcomes: planned, approved, simulated, and judged from their event logs.

cases       a request, the worlds in which it is simulated, and the outcome expected in each
case_form   pydantic models of a case file
case_file   reads cases from YAML and explains mistakes in them
case_site   trees and markers of a GeoJSON file, read by the judge itself
places      conditions on the tree at which an action was done
log         reads an event log: actions at trees, distance driven, the end
matching    compares expected steps with the actions done
judge       compares an event log with the expected outcome
trial       plans, approves, simulates and judges a case
published   the rows of a published experiment and the cases that reproduce them
builtin     cases on the built-in orchard, as YAML

The judge is independent of planning and of how Fieldhand reads sites: it uses only the file of the site, the event log
and the case. Errors in those parts of Fieldhand therefore cannot go unnoticed here.
"""
