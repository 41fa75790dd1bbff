#!/bin/sh
# Compiles the C# of bindings with Mono, warnings as errors, and runs the tests of the retargeting maths. Unity's
# components are compiled against a stub of what they call of UnityEngine.
set -eu
cd "$(dirname "$0")/../../.."
command -v mcs mono >/dev/null || {
  echo "[  SKIPPED ] mono is not here: apt-get install mono-mcs mono-runtime"
  exit 0
}
scratch=$(mktemp -d)
trap 'rm -rf "$scratch"' EXIT
mcs -unsafe -warn:4 -warnaserror -target:library -out:"$scratch/DanceAdapter.dll" bindings/csharp/*.cs
mcs -unsafe -warn:4 -warnaserror -nowarn:0649 -target:library -out:"$scratch/Stage.dll" bindings/csharp/*.cs \
  bindings/unity/Runtime/*.cs tests/bindings/unity/UnityEngineStub.cs
mcs -unsafe -warn:4 -warnaserror -out:"$scratch/RetargetTest.exe" bindings/csharp/*.cs tests/bindings/csharp/RetargetTest.cs
mono "$scratch/RetargetTest.exe"
