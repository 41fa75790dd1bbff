#!/usr/bin/env bash
# timed.sh COMMAND…: runs the command of a test that is a script, and prints its user and system time for tests/report.py.
TIMEFORMAT='[      CPU ] script %U %S'
time "$@"
