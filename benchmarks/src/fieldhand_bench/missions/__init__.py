"""Requests with what they mean: planned, approved, driven in simulation, and judged from their event logs.

cases       a request, the worlds that it is driven in, what must have happened in each
case_file   cases from YAML, every mistake in it in words
ground      trees and markers of a GeoJSON file, measured by the judge itself
places      what a case may demand of a place
log         what an event log shows: actions at trees, metres, the end
matching    steps that were asked for against actions that were done
judge       an event log held against what was expected
trial       a case planned, approved, driven in each of its worlds and judged
published   which cases stand for the rows of a published experiment
builtin     cases on the built-in orchard, as YAML

The judge knows nothing of planning, of plans, or of how the project reads sites: it has the file of the site, the log
and the case. So what is wrong there does not hide in it.
"""
