#!/bin/sh
# csharp_test.sh LIBRARY: compiles the C# of bindings with Mono, warnings as errors, and runs the tests of the retargeting
# maths and of how structs lie in memory. Unity's components are compiled against a stub of what they call of UnityEngine.
set -eu
library=$1
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
# A folder with the library as the package without headers has it: by its versioned name alone.
mkdir "$scratch/lib"
ln -s "$library" "$scratch/lib/libdance_adapter.so.1"
mcs -unsafe -warn:4 -warnaserror -out:"$scratch/LayoutTest.exe" bindings/csharp/*.cs tests/bindings/csharp/LayoutTest.cs
${CC:-cc} -Iconsumers/engine tests/bindings/csharp/layout.c -o "$scratch/layout"
"$scratch/layout" >"$scratch/layout.txt"
LD_LIBRARY_PATH=$scratch/lib mono "$scratch/LayoutTest.exe" <"$scratch/layout.txt"
# Unity's own name, and its cure, compile too.
mcs -unsafe -warn:4 -warnaserror -define:UNITY_5_3_OR_NEWER -target:library -out:"$scratch/Unity.dll" bindings/csharp/*.cs
