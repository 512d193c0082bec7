"""The report of a study: statistics, figures, tables, page."""
