#!/usr/bin/env python3
"""Counts the tests of a CTest run and finds the slow ones.

report.py LAST_TEST_LOG [--slowest N] [--over SECONDS]

Reads CTest's LastTest.log. A GoogleTest entry counts each of its tests; any other entry counts as
one test. Prints failed tests and reasons of skipped ones, then a line "counts: PASSED FAILED
SKIPPED". --slowest prints the N tests with the most processor time. --over prints nothing but the
entries that hold a test with more than SECONDS of processor time.
"""
import argparse
import collections
import re
import sys

ENTRY = re.compile(r"^\d+/\d+ Testing: (.*)$")
RAN = re.compile(r"\[ RUN      \] (\S+)$")
ENDED = re.compile(r"\[ +(OK|FAILED|SKIPPED) +\] (\S+?),? .*\(\d+ ms\)$")
CPU = re.compile(r"^\[      CPU \] (\S+) ([\d.]+) s$")
SCRIPT_CPU = re.compile(r"^\[      CPU \] script (\d+)[.,](\d+) (\d+)[.,](\d+)$")
TIME = re.compile(r"^Test time = +([\d.]+) sec$")
SKIPPED_SCRIPT = re.compile(r"^\[  SKIPPED \] (?!\d+ tests?, listed below)(.*)$")


class Entry:
    """One entry of CTest: a suite, a test or a script."""

    def __init__(self, name):
        self.name = name
        self.results = {}
        self.cpu_s = {}
        self.wall_s = 0.0
        self.reasons = collections.Counter()
        self.started = True
        self.ok = False
        self.verdict = ""

    def finish(self):
        """Turns what was printed into a result per test."""
        if any(result == "running" for result in self.results.values()):
            self.results = {
                name: "failed" if result == "running" else result for name, result in self.results.items()
            }
        elif not (self.ok and self.started) and "failed" not in self.results.values():
            self.results[self.name] = "failed"
        elif not self.results:
            self.results[self.name] = "skipped" if self.reasons else "passed"


def read_entries(lines):
    """All entries of a log, each finished."""
    entry, entries, last_line, skip_reason = None, [], "", False
    for line in lines:
        line = line.rstrip("\n")
        if match := ENTRY.match(line):
            entry = Entry(match[1])
            entries.append(entry)
            in_output = False
            continue
        if entry is None:
            continue
        if line == "Output:":
            in_output = True
        elif line == "<end of output>":
            in_output = False
        elif not in_output:
            if line == 'Command: ""':
                entry.started = False
            elif match := TIME.match(line):
                entry.wall_s = float(match[1])
            elif line.startswith("Test "):
                entry.verdict = line
                entry.ok = line == "Test Passed."
        elif skip_reason:
            entry.reasons[line.strip() or "no reason given"] += 1
            skip_reason = False
        elif line.startswith("[==========] 0 tests from 0 test suites ran"):
            entry.started = False
        elif match := RAN.search(line):
            entry.results[match[1]] = "running"
        elif match := ENDED.search(line):
            entry.results[match[2]] = {"OK": "passed", "FAILED": "failed", "SKIPPED": "skipped"}[match[1]]
        elif match := CPU.match(line):
            entry.cpu_s[match[1]] = float(match[2])
        elif match := SCRIPT_CPU.match(line):
            entry.cpu_s[entry.name] = float(f"{match[1]}.{match[2]}") + float(f"{match[3]}.{match[4]}")
        elif re.search(r"\.(cpp|h):\d+: Skipped$", line):
            skip_reason = True
        elif match := SKIPPED_SCRIPT.match(line):
            if not re.match(r"^\S+\.\S+( \(\d+ ms\))?$", match[1]):
                entry.reasons[match[1]] += 1
    for entry in entries:
        entry.finish()
    return entries


def main():
    parser = argparse.ArgumentParser()
    parser.add_argument("log")
    parser.add_argument("--slowest", type=int, default=0)
    parser.add_argument("--over", type=float)
    arguments = parser.parse_args()
    with open(arguments.log, encoding="utf-8", errors="replace") as log:
        entries = read_entries(log)
    if arguments.over is not None:
        for entry in entries:
            for name, cpu_s in sorted(entry.cpu_s.items()):
                if cpu_s > arguments.over:
                    print(f"{entry.name} {name} {cpu_s:.1f}")
        return
    counts, reasons = collections.Counter(), collections.Counter()
    for entry in entries:
        reasons += entry.reasons
        for name, result in entry.results.items():
            counts[result] += 1
            if result == "failed":
                print(f"FAILED {name}" + ("" if entry.verdict == "Test Failed." else f" ({entry.verdict})"))
    if reasons:
        print(f"skipped, by reason ({counts['skipped']} tests):")
        for reason, number in reasons.most_common(40):
            print(f"  {number:4} {reason[:160]}")
    if arguments.slowest:
        print(f"the {arguments.slowest} tests with the most processor time, and their entries' time by the clock:")
        slowest = sorted(((s, name, e.wall_s) for e in entries for name, s in e.cpu_s.items()), reverse=True)
        for cpu_s, name, wall_s in slowest[: arguments.slowest]:
            print(f"  {cpu_s:7.1f} s {wall_s:7.1f} s  {name}")
    print(f"counts: {counts['passed']} {counts['failed']} {counts['skipped']}")


if __name__ == "__main__":
    sys.exit(main())
