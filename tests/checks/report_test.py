#!/usr/bin/env python3
"""Tests of tests/report.py: what it makes of CTest's log."""
import os
import subprocess
import sys
import tempfile

REPORT = os.path.join(os.path.dirname(os.path.abspath(__file__)), "..", "report.py")


def entry(name, output, verdict="Test Passed.", command='"program"'):
    """An entry as LastTest.log has it."""
    return f"""1/9 Testing: {name}
1/9 Test: {name}
Command: {command}
Directory: /build
"{name}" start time: Nov 29 05:00 UTC
Output:
----------------------------------------------------------
{output}
<end of output>
Test time =   1.25 sec
----------------------------------------------------------
{verdict}
"{name}" end time: Nov 29 05:00 UTC
"{name}" time elapsed: 00:00:01
----------------------------------------------------------

"""


def ran(test, result="       OK", more=""):
    return f"[ RUN      ] {test}\n{more}[{result} ] {test} (3 ms)"


FAILED = "  FAILED "
SKIPPED = "  SKIPPED"
CASES = [
    ("counts each test of a suite", entry("A", ran("A.One") + "\n" + ran("A.Two")), "2 0 0"),
    ("counts a failed test", entry("A", ran("A.One", FAILED) + "\n" + ran("A.Two"), "Test Failed."), "1 1 0"),
    (
        "counts a failed test with a parameter",
        entry("P/A", "[ RUN      ] P/A.B/0\n[  FAILED  ] P/A.B/0, where GetParam() = (1, 2) (3 ms)", "Test Failed."),
        "0 1 0",
    ),
    (
        "counts a skipped test and its reason",
        entry("A", ran("A.One", SKIPPED, "/x/a_test.cpp:3: Skipped\nno camera\n") + "\n" + ran("A.Two")),
        "1 0 1",
    ),
    ("counts a crash under the name of its test", entry("A", ran("A.One") + "\n[ RUN      ] A.Two", "Test Failed."), "1 1 0"),
    ("counts an end with an error behind good tests", entry("A", ran("A.One"), "Test Failed."), "1 1 0"),
    ("counts a test whose output has no last line break", entry("A", "[ RUN      ] A.One\nx[       OK ] A.One (3 ms)"), "1 0 0"),
    ("counts a script", entry("check.x", "fine"), "1 0 0"),
    ("counts a failed script", entry("check.x", "[  SKIPPED ] no network\nbroken", "Test Failed."), "0 1 0"),
    ("counts a skipped script", entry("check.x", "[  SKIPPED ] no network"), "0 0 1"),
    ("counts a program that cannot start as failed", entry("A", "Unable to find executable", command='""'), "0 1 0"),
    ("counts a filter that matches nothing as failed", entry("A", "[==========] 0 tests from 0 test suites ran. (0 ms total)"), "0 1 0"),
]


def main():
    failed = 0
    with tempfile.TemporaryDirectory() as folder:
        log = os.path.join(folder, "LastTest.log")
        for what, text, counts in CASES:
            with open(log, "w", encoding="utf-8") as file:
                file.write("Start testing: Nov 29 05:00 UTC\n" + text + "End testing: Nov 29 05:00 UTC\n")
            output = subprocess.run([sys.executable, REPORT, log], capture_output=True, text=True, check=False).stdout
            if f"counts: {counts}" not in output.splitlines():
                print(f"{what}: expected {counts}, printed:\n{output}")
                failed = 1
        with open(log, "w", encoding="utf-8") as file:
            file.write(entry("A", ran("A.One") + "\n[      CPU ] A.One 12.5 s") + entry("check.x", "[      CPU ] script 8,250 3,000"))
        over = subprocess.run([sys.executable, REPORT, log, "--over", "10"], capture_output=True, text=True, check=False).stdout
        if over != "A A.One 12.5\ncheck.x check.x 11.2\n":
            print(f"--over printed:\n{over}")
            failed = 1
    print(f"{len(CASES) + 1} cases")
    return failed


if __name__ == "__main__":
    sys.exit(main())
