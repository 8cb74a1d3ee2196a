"""Runs all tests, or those of the files that are named; with GTEST_OUTPUT=xml:FOLDER/ counts them for script/test."""

import os
import sys
import unittest
from pathlib import Path

here = Path(__file__).parent
patterns = [Path(name).name for name in sys.argv[1:]] or ["*_test.py"]
suite = unittest.TestSuite(unittest.defaultTestLoader.discover(str(here), pattern) for pattern in patterns)
result = unittest.TextTestRunner(verbosity=2).run(suite)
report = os.environ.get("GTEST_OUTPUT", "")
if report.startswith("xml:"):
    failed = {test.id().split(" ")[0] for test, _ in result.failures + result.errors}
    Path(report[4:], "python_tests.xml").write_text(
        f'<testsuite name="python" tests="{result.testsRun}" failures="{len(failed)}" disabled="0" '
        f'skipped="{len(result.skipped)}" errors="0">\n</testsuite>\n', encoding="utf-8")
sys.exit(0 if result.wasSuccessful() and result.testsRun > 0 else 1)
