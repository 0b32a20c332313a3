"""Describe a site: in figures for programs, in words for people, and in a few lines for a planner."""

from fieldhand.site.describe.aisles import AisleSummary, aisle_table
from fieldhand.site.describe.driving import DrivingSummary, Unreachable, describe_driving
from fieldhand.site.describe.figures import AttributeSummary, SiteSummary, ZoneSummary, describe
from fieldhand.site.describe.lines import report_lines, report_record
from fieldhand.site.describe.rows import BlockSummary, RowSummary, row_table
from fieldhand.site.describe.summary import summary_lines

__all__ = [
    "AisleSummary",
    "AttributeSummary",
    "BlockSummary",
    "DrivingSummary",
    "RowSummary",
    "SiteSummary",
    "Unreachable",
    "ZoneSummary",
    "aisle_table",
    "describe",
    "describe_driving",
    "report_lines",
    "report_record",
    "row_table",
    "summary_lines",
]
