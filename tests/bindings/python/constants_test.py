"""What the bindings have written out of dance_adapter.h is what the library and the header say: bones, parents, sizes of
structs. LIBRARY is the argument."""

import os
import re
import subprocess
import sys
import tempfile

try:
    import ctypes
except ImportError:
    print("[  SKIPPED ] Python's ctypes is not here: apt-get install python3")
    sys.exit(0)

here = os.path.dirname(os.path.abspath(__file__))
root = os.path.normpath(os.path.join(here, "..", "..", ".."))
sys.dont_write_bytecode = True
sys.path.insert(0, os.path.join(root, "bindings", "python"))
import dance_adapter as da  # noqa: E402

library = da.load(sys.argv[1])
failures = 0


def expect(holds, what):
    global failures
    if not holds:
        print("FAILED:", what)
        failures += 1


for function in ("dance_bone_name", "dance_finger_bone_name"):
    getattr(library, function).restype = ctypes.c_char_p
bones = tuple(library.dance_bone_name(i).decode() for i in range(22))
parents = tuple(library.dance_bone_parent(i) for i in range(22))
fingers = tuple(library.dance_finger_bone_name(i).decode() for i in range(30))
finger_parents = tuple(library.dance_finger_bone_parent(i) for i in range(30))
expect(da.BONES == bones, "bones in Python")
expect(da.PARENTS == parents, "parents in Python")
expect(da.FINGER_BONES == fingers, "finger bones in Python")
expect(da.FINGER_PARENTS == finger_parents, "parents of fingers in Python")

script = open(os.path.join(root, "bindings", "godot", "dance_adapter.gd")).read()
expect(tuple(re.findall(r'"(\w+)"', re.search(r"const BONES = \[(.*?)\]", script, re.S)[1])) == bones, "bones in Godot")
expect(
    tuple(int(one) for one in re.search(r"const PARENTS = \[(.*?)\]", script)[1].split(",")) == parents,
    "parents in Godot",
)
code = open(os.path.join(root, "bindings", "csharp", "DanceBones.cs")).read()
expect(
    tuple(int(one) for one in re.search(r"body = \{(.*?)\};", code)[1].split(",")) == parents, "parents in C#"
)
for name, index in re.findall(r"(\w+) = (\d+)[,;]", "\n".join(re.findall(r"const int Hips.*?(?=\n\n)", code, re.S))):
    expect(name[0].lower() + name[1:] == bones[int(index)], f"{name} in C#")

# Sizes, as the C compiler has them.
structs = ("guest", "pose", "hands", "skeleton", "world", "beat", "counters")
if subprocess.run(["sh", "-c", "command -v cc"], stdout=subprocess.DEVNULL).returncode == 0:
    with tempfile.TemporaryDirectory() as folder:
        source = os.path.join(folder, "sizes.c")
        with open(source, "w") as file:
            file.write(f'#include "{root}/consumers/engine/dance_adapter.h"\n#include <stdio.h>\nint main(void) {{\n')
            file.writelines(f'  printf("%zu ", sizeof(dance_{one}));\n' for one in structs)
            file.write("}\n")
        subprocess.run(["cc", source, "-o", os.path.join(folder, "sizes")], check=True)
        sizes = subprocess.run([os.path.join(folder, "sizes")], check=True, stdout=subprocess.PIPE, text=True).stdout
        for one, size in zip(structs, sizes.split()):
            mine = ctypes.sizeof(getattr(da, one.capitalize()))
            expect(mine == int(size), f"dance_{one} has {size} bytes and {mine} in Python")

# The system's library is found by the name that its package gives it, which is not that of a build.
with tempfile.TemporaryDirectory() as folder:
    os.symlink(os.path.abspath(sys.argv[1]), os.path.join(folder, da.LIBRARY_NAMES[0]))
    environment = {**os.environ, "LD_LIBRARY_PATH": folder, "PYTHONPATH": sys.path[0], "PYTHONDONTWRITEBYTECODE": "1"}
    environment.pop("DANCE_ADAPTER_LIBRARY", None)
    found = subprocess.run([sys.executable, "-c", "import dance_adapter; dance_adapter.load()"], env=environment)
    expect(found.returncode == 0, "the library of the package is found")

# Without a house, and wrong use.
with da.Adapter("no-house-here") as adapter:
    expect(adapter.state() == da.Status.NO_HOUSE, "a house that is not there")
    expect(adapter.guests() == [] and adapter.newest(0) is None, "dancers of no house")
    try:
        adapter.newest(64)
        expect(False, "slot 64 is refused")
    except ValueError:
        pass
try:
    adapter.state()
    expect(False, "a closed adapter is refused")
except ValueError:
    pass
for name in ("No Name!", "x" * 25, "caf\u00e9"):
    try:
        da.Adapter(name)
        expect(False, f"the name {name!a} is refused")
    except da.DanceError:
        pass
with da.Producer("no-house-here") as producer:
    pose = da.t_pose()
    expect(not producer.pose(pose) and producer.status == da.Status.NO_HOUSE, "a pose for no house")
    pose.rotation[4][0] = float("nan")
    try:
        producer.pose(pose)
        expect(False, "a pose that is not finite is refused")
    except ValueError:
        pass
print("the bindings and the library agree" if failures == 0 else f"{failures} failures")
sys.exit(1 if failures else 0)
