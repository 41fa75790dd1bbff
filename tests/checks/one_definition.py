#!/usr/bin/env python3
"""Checks that no two types have the same qualified name: the linker would keep one of them for a whole program.

Reads the C++ sources of the tree (or those given), follows their namespaces and prints each class,
struct, union or enum that two files define under one name. Types inside of types, functions and
anonymous namespaces do not count.
"""
import collections
import os
import re
import subprocess
import sys

TOKEN = re.compile(
    r"""//[^\n]*|/\*.*?\*/|R"(\w*)\(.*?\)\1"|"(?:\\.|[^"\\\n])*"|'(?:\\.|[^'\\\n])*'"""
    r"""|\#[^\n]*(?:\\\n[^\n]*)*|\w+|::|[{};:=()<>,]|\S""",
    re.S | re.X,
)
TYPES = {"class", "struct", "union", "enum"}


def definitions(text):
    """(qualified name) of each type that a file defines in a named namespace."""
    tokens = [t.group(0) for t in TOKEN.finditer(text)]
    tokens = [t for t in tokens if not t.startswith(("//", "/*", "#", '"', "'", 'R"'))]
    scopes = []  # a name, or None where what lies inside does not count
    head = []  # the tokens since the last ; { or }
    for token in tokens:
        if token == "{":
            scopes.append(scope_of(head, scopes, found := []))
            yield from found
            head = []
        elif token == "}":
            if scopes:
                scopes.pop()
            head = []
        elif token == ";":
            head = []
        else:
            head.append(token)


def without_alignas(head):
    """The tokens without alignas(…)."""
    while "alignas" in head:
        start = head.index("alignas")
        end, depth = start + 1, 0
        while end < len(head):
            depth += {"(": 1, ")": -1}.get(head[end], 0)
            end += 1
            if depth == 0:
                break
        head = head[:start] + head[end:]
    return head


def scope_of(head, scopes, found):
    """The scope that a { after these tokens opens."""
    head = without_alignas(head)
    if "namespace" in head and "using" not in head:
        name = "".join(head[head.index("namespace") + 1 :])
        return name or None
    is_inside = None in scopes
    kinds = [i for i, token in enumerate(head) if token in TYPES]
    if not kinds or is_inside or "(" in head or "=" in head:
        return None
    names = []
    for token in head[kinds[-1] + 1 :]:
        if token in (":", "<"):
            break
        if re.match(r"\w+$|::$", token) and token != "final":
            names.append(token)
    # A type inside of another, defined elsewhere, has the other's name; a specialisation has none.
    name = "".join(names)
    if name and "<" not in head[kinds[-1] + 1 :]:
        found.append("::".join(scopes + [name]))
    return None


def main():
    os.chdir(os.path.join(os.path.dirname(os.path.abspath(__file__)), "..", ".."))
    files = sys.argv[1:]
    if not files:
        listed = subprocess.run(["tests/checks/sources.sh", ".h", ".cpp"], capture_output=True, text=True, check=True)
        files = listed.stdout.split()
    places = collections.defaultdict(set)
    for file in files:
        # Examples and bindings are programs of their own, some of other projects' names.
        if file.startswith(("examples/", "bindings/", "tests/bindings/")):
            continue
        # x_absent.cpp takes the place of x.cpp in some builds.
        if file.endswith("_absent.cpp"):
            continue
        with open(file, encoding="utf-8", errors="replace") as source:
            for name in definitions(source.read()):
                places[name].add(file)
    failed = 0
    for name, where in sorted(places.items()):
        if len(where) > 1:
            print(f"{name}: defined in {' and '.join(sorted(where))}")
            failed = 1
    if not places:
        print("no type found: the check itself is broken")
        failed = 1
    print(f"{len(places)} types of {len(files)} files read")
    return failed


if __name__ == "__main__":
    sys.exit(main())
