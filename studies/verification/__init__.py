"""Stage verification: the solver against exact solutions, published numbers and another code.

`checks.CHECKS` lists every check in the order in which the report shows them; `runner.run_checks`
measures them one by one and keeps what it measured, `report.write_report` turns that into
docs/verification.md.
"""
