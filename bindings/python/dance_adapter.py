#!/usr/bin/env python3
"""The dancers of a house for Python, through libdance_adapter.so: newest poses, poses at a
display's time, proportions, fingers, the beat; and the way back, a tracker of one's own as a
dancer of the house. Only the standard library is needed; arrays become numpy's where asked for.

    with Adapter() as adapter:
        for guest in adapter.guests():
            pose = adapter.newest(guest.slot)
            skeleton = adapter.skeleton(guest.slot)
            if pose and skeleton:
                print(guest.name, world_of(skeleton, pose).position[BONES.index("head")][:])

Units/frames: metres, nanoseconds of CLOCK_MONOTONIC, beats; axes as given to Adapter.
              Rotations are x, y, z, w, of each bone in its parent, identity in T-pose.
Ownership:    structs returned belong to the caller. `into=` fills one again and makes no garbage.
Threads:      an Adapter or a Producer belongs to one thread at a time.
Failure:      without house, dancer or data a call returns None (its cause is in .status); wrong
              use raises ValueError; a library that is missing or of another ABI raises DanceError.
Run as a program it prints who dances.
"""

import ctypes
import enum
import os
import sys

ABI = 1
MAX_GUESTS = 64
LONGEST_PREDICTION_NS = 100_000_000

BONES = (
    "hips", "spine", "chest", "upperChest", "neck", "head",
    "leftShoulder", "leftUpperArm", "leftLowerArm", "leftHand",
    "rightShoulder", "rightUpperArm", "rightLowerArm", "rightHand",
    "leftUpperLeg", "leftLowerLeg", "leftFoot", "leftToes",
    "rightUpperLeg", "rightLowerLeg", "rightFoot", "rightToes",
)  # fmt: skip
PARENTS = (-1, 0, 1, 2, 3, 4, 3, 6, 7, 8, 3, 10, 11, 12, 0, 14, 15, 16, 0, 18, 19, 20)
TIP_BONES = (5, 9, 13, 17, 21)  # the bones whose ends the tips are
FINGER_BONES = tuple(
    side + finger + joint
    for side in ("left", "right")
    for finger, joints in (
        ("Thumb", ("Metacarpal", "Proximal", "Distal")),
        *((one, ("Proximal", "Intermediate", "Distal")) for one in ("Index", "Middle", "Ring", "Little")),
    )
    for joint in joints
)
FINGER_PARENTS = tuple(-1 if bone % 3 == 0 else bone - 1 for bone in range(30))


class Status(enum.IntEnum):
    OK = 0
    NO_HOUSE = 1
    NO_GUEST = 2
    NO_DATA = 3
    BUSY = 4
    WRONG_VERSION = 5
    DAMAGED = 6
    BAD_ARGUMENT = 7
    INVALID = 8


class Axes(enum.IntEnum):
    GLTF = 0
    UNITY = 1
    UNREAL = 2
    BLENDER = 3


class PoseKind(enum.IntEnum):
    NEWEST = 0
    INTERPOLATED = 1
    PREDICTED = 2
    HELD = 3


class DanceError(RuntimeError):
    """The library cannot be used, or a name is unfit."""


class _Sized(ctypes.Structure):
    def __init__(self, **fields):
        super().__init__(**fields)
        self.struct_size = ctypes.sizeof(self)


class Guest(_Sized):
    _fields_ = [
        ("struct_size", ctypes.c_uint32),
        ("slot", ctypes.c_uint32),
        ("id", ctypes.c_char * 32),
        ("newest_ns", ctypes.c_int64),
        ("has_skeleton", ctypes.c_uint32),
        ("has_hands", ctypes.c_uint32),
        ("generation", ctypes.c_uint32),
        ("reserved", ctypes.c_uint32),
    ]

    @property
    def name(self):
        return self.id.decode("ascii", "replace")


class Pose(_Sized):
    _fields_ = [
        ("struct_size", ctypes.c_uint32),
        ("kind", ctypes.c_uint32),
        ("sequence", ctypes.c_uint32),
        ("presence", ctypes.c_uint32),
        ("confidence", ctypes.c_float),
        ("hips_position", ctypes.c_float * 3),
        ("rotation", (ctypes.c_float * 4) * 22),
        ("capture_ns", ctypes.c_int64),
        ("staged_ns", ctypes.c_int64),
        ("time_ns", ctypes.c_int64),
        ("music_beats", ctypes.c_double),
        ("generation", ctypes.c_uint32),
        ("reserved", ctypes.c_uint32),
    ]


class Hands(_Sized):
    _fields_ = [
        ("struct_size", ctypes.c_uint32),
        ("presence", ctypes.c_uint32),
        ("rotation", (ctypes.c_float * 4) * 30),
        ("capture_ns", ctypes.c_int64),
    ]


class Skeleton(_Sized):
    _fields_ = [
        ("struct_size", ctypes.c_uint32),
        ("version", ctypes.c_uint32),
        ("offset", (ctypes.c_float * 3) * 22),
        ("tip", (ctypes.c_float * 3) * 5),
    ]


class World(_Sized):
    _fields_ = [
        ("struct_size", ctypes.c_uint32),
        ("reserved", ctypes.c_uint32),
        ("position", (ctypes.c_float * 3) * 22),
        ("rotation", (ctypes.c_float * 4) * 22),
        ("tip", (ctypes.c_float * 3) * 5),
    ]


class Beat(_Sized):
    _fields_ = [
        ("struct_size", ctypes.c_uint32),
        ("beats_per_bar", ctypes.c_uint32),
        ("position_beats", ctypes.c_double),
        ("tempo_bpm", ctypes.c_double),
        ("confidence", ctypes.c_float),
        ("playing", ctypes.c_uint32),
    ]


class Counters(_Sized):
    _fields_ = [
        ("struct_size", ctypes.c_uint32),
        ("reserved", ctypes.c_uint32),
        ("reads", ctypes.c_uint64),
        ("retries", ctypes.c_uint64),
        ("busy", ctypes.c_uint64),
        ("damaged", ctypes.c_uint64),
        ("attached", ctypes.c_uint64),
    ]


# Of the package dancegraph, and of a build or of dancegraph-dev.
LIBRARY_NAMES = ("libdance_adapter.so.1", "libdance_adapter.so")
_HANDLE = ctypes.c_void_p
_U32 = ctypes.c_uint32
_I64 = ctypes.c_int64


def _prototypes():
    def pointer(kind):
        return ctypes.POINTER(kind)

    status = ctypes.c_int
    return {
        "dance_adapter_abi": (_U32, []),
        "dance_adapter_now_ns": (_I64, []),
        "dance_status_text": (ctypes.c_char_p, [ctypes.c_int]),
        "dance_adapter_open": (_HANDLE, [ctypes.c_char_p, ctypes.c_int]),
        "dance_adapter_close": (None, [_HANDLE]),
        "dance_adapter_state": (status, [_HANDLE]),
        "dance_adapter_guests": (_U32, [_HANDLE, pointer(Guest), _U32]),
        "dance_adapter_find": (status, [_HANDLE, ctypes.c_char_p, pointer(_U32)]),
        "dance_adapter_newest": (status, [_HANDLE, _U32, pointer(Pose)]),
        "dance_adapter_at": (status, [_HANDLE, _U32, _I64, pointer(Pose)]),
        "dance_adapter_skeleton": (status, [_HANDLE, _U32, pointer(Skeleton)]),
        "dance_adapter_hands": (status, [_HANDLE, _U32, pointer(Hands)]),
        "dance_adapter_beat": (status, [_HANDLE, _I64, pointer(Beat)]),
        "dance_adapter_counters": (status, [_HANDLE, pointer(Counters)]),
        "dance_world_of": (status, [pointer(Skeleton), pointer(Pose), pointer(World)]),
        "dance_producer_open": (_HANDLE, [ctypes.c_char_p, ctypes.c_int]),
        "dance_producer_close": (None, [_HANDLE]),
        "dance_producer_skeleton": (status, [_HANDLE, pointer(Skeleton)]),
        "dance_producer_pose": (status, [_HANDLE, pointer(Pose)]),
        "dance_producer_hands": (status, [_HANDLE, pointer(Hands)]),
    }


_library = None


def _of_the_system():
    try:
        return ctypes.CDLL(LIBRARY_NAMES[0])
    except OSError as problem:
        try:
            return ctypes.CDLL(LIBRARY_NAMES[1])
        except OSError:
            raise problem from None


def load(path=None):
    """Loads the library: `path`, else DANCE_ADAPTER_LIBRARY of the environment, else what the
    system finds. All later calls use it."""
    global _library
    if _library is not None and path is None:
        return _library
    given = path or os.environ.get("DANCE_ADAPTER_LIBRARY")
    name = str(given or LIBRARY_NAMES[0])
    try:
        library = ctypes.CDLL(name) if given else _of_the_system()
        for function, (result, arguments) in _prototypes().items():
            getattr(library, function).restype = result
            getattr(library, function).argtypes = arguments
    except (OSError, AttributeError) as error:
        raise DanceError(
            f"{name} cannot be loaded ({error}): install dancegraph, "
            f"or set DANCE_ADAPTER_LIBRARY to the file"
        ) from None
    if library.dance_adapter_abi() != ABI:
        raise DanceError(
            f"{name} has ABI {library.dance_adapter_abi()} and this file {ABI}: "
            f"take both from one version"
        )
    _library = library
    return library


def now_ns():
    """The clock of all times here: CLOCK_MONOTONIC, as time.monotonic_ns()."""
    return load().dance_adapter_now_ns()


def _name_bytes(name):
    if name is None:
        return None
    try:
        return name.encode("ascii")
    except UnicodeEncodeError:
        return b"?"  # the library refuses it as it does any unfit name


class _Handle:
    """What Adapter and Producer share: a handle of the library, closed once."""

    def __init__(self, kind, name, axes, library):
        self._library = load(library)
        self._kind = kind
        self.axes = Axes(axes)
        self.status = Status.OK
        self._handle = getattr(self._library, f"dance_{kind}_open")(_name_bytes(name), int(axes))
        if not self._handle:
            raise DanceError("a name is 1 to 24 characters of a-z, 0-9 and '-'")

    def close(self):
        if getattr(self, "_handle", None):
            getattr(self._library, f"dance_{self._kind}_close")(self._handle)
            self._handle = None

    def __enter__(self):
        return self

    def __exit__(self, *_):
        self.close()

    def __del__(self):
        self.close()

    def _call(self, function, *arguments):
        if not self._handle:
            raise ValueError(f"this {self._kind} is closed")
        self.status = Status(getattr(self._library, function)(self._handle, *arguments))
        if self.status == Status.BAD_ARGUMENT:
            raise ValueError(f"{function}: {self.status_text()}")
        return self.status == Status.OK

    def status_text(self):
        """What the last call's status means."""
        return self._library.dance_status_text(int(self.status)).decode("ascii", "replace")


class Adapter(_Handle):
    """A reader of the house with that name (None = the usual one). There need be no house yet."""

    def __init__(self, name=None, axes=Axes.GLTF, library=None):
        super().__init__("adapter", name, axes, library)
        self._guests = (Guest * MAX_GUESTS)()
        self._slot = _U32()

    def state(self):
        self._call("dance_adapter_state")
        return self.status

    def guests(self):
        """The dancers that are there now. The list's structs are filled again by the next call."""
        if not self._handle:
            raise ValueError("this adapter is closed")
        self._guests[0].struct_size = ctypes.sizeof(Guest)
        count = self._library.dance_adapter_guests(self._handle, self._guests, MAX_GUESTS)
        return self._guests[: min(count, MAX_GUESTS)]

    def __iter__(self):
        return iter(self.guests())

    def find(self, name):
        """The slot of a guest by id, or None."""
        found = self._call("dance_adapter_find", _name_bytes(name), ctypes.byref(self._slot))
        return self._slot.value if found else None

    def _read(self, function, struct, into, *arguments):
        into = struct() if into is None else into
        return into if self._call(function, *arguments, ctypes.byref(into)) else None

    def newest(self, slot, into=None):
        return self._read("dance_adapter_newest", Pose, into, slot)

    def at(self, slot, time_ns, into=None):
        """The pose to show at a time: interpolated, or predicted beyond the newest."""
        return self._read("dance_adapter_at", Pose, into, slot, time_ns)

    def skeleton(self, slot, into=None):
        return self._read("dance_adapter_skeleton", Skeleton, into, slot)

    def hands(self, slot, into=None):
        return self._read("dance_adapter_hands", Hands, into, slot)

    def beat(self, time_ns, into=None):
        return self._read("dance_adapter_beat", Beat, into, time_ns)

    def counters(self, into=None):
        return self._read("dance_adapter_counters", Counters, into)

    def world(self, slot, time_ns=None, into=None):
        """Where every bone of a dancer is, now or at a time; None where there is no dancer."""
        skeleton = self.skeleton(slot)
        pose = self.newest(slot) if time_ns is None else self.at(slot, time_ns)
        return world_of(skeleton, pose, into) if skeleton and pose else None


class Producer(_Handle):
    """The way back: a tracker's poses become captures of a guest in the house whose receiver has
    that name (`dance receive --from engine`). Each call returns whether the house took it; without
    a house it is dropped."""

    def __init__(self, name=None, axes=Axes.GLTF, library=None):
        super().__init__("producer", name, axes, library)

    def skeleton(self, skeleton):
        return self._call("dance_producer_skeleton", ctypes.byref(skeleton))

    def pose(self, pose):
        """capture_ns = 0 is now. Raises ValueError where it is not finite or not of unit rotations."""
        sent = self._call("dance_producer_pose", ctypes.byref(pose))
        if self.status == Status.INVALID:
            raise ValueError(self.status_text())
        return sent

    def hands(self, hands):
        sent = self._call("dance_producer_hands", ctypes.byref(hands))
        if self.status == Status.INVALID:
            raise ValueError(self.status_text())
        return sent


def t_pose(hips_height=0.95, axes=Axes.GLTF):
    """A pose to fill in and produce: standing, seen with certainty, captured now."""
    pose = Pose(presence=(1 << len(BONES)) - 1, confidence=1.0, music_beats=float("nan"))
    for rotation in pose.rotation:
        rotation[3] = 1.0
    up = 1 if axes in (Axes.GLTF, Axes.UNITY) else 2
    pose.hips_position[up] = hips_height * (100.0 if axes == Axes.UNREAL else 1.0)
    return pose


def world_of(skeleton, pose, into=None):
    """Where every bone is: forward kinematics of a pose and a skeleton in the same axes."""
    into = World() if into is None else into
    status = Status(
        load().dance_world_of(ctypes.byref(skeleton), ctypes.byref(pose), ctypes.byref(into))
    )
    if status != Status.OK:
        raise ValueError(f"dance_world_of: {load().dance_status_text(int(status)).decode()}")
    return into


def as_array(field):
    """A numpy array that shares a struct's memory: as_array(pose.rotation) is 22 x 4."""
    import numpy

    return numpy.ctypeslib.as_array(field)


def _main(arguments):
    import argparse
    import time

    parser = argparse.ArgumentParser(description="prints who dances, once a second")
    parser.add_argument("--name", help="of the house's memory; the usual one without")
    parser.add_argument("--seconds", type=float, default=0.0, help="how long; 0 = until Ctrl-C")
    options = parser.parse_args(arguments)
    try:
        adapter = Adapter(options.name)
    except DanceError as error:
        print(f"dance_adapter: {error}", file=sys.stderr)
        return 1
    seen = False
    said = None
    end = time.monotonic() + options.seconds
    with adapter:
        while True:
            guests = adapter.guests()
            for guest in guests:
                # As dance_adapter_newest() has them, so that this shows what an engine would show.
                world = adapter.world(guest.slot)
                if world is None:
                    continue
                seen = True
                age_ms = (now_ns() - guest.newest_ns) / 1e6
                at = " ".join(f"{value:6.2f}" for value in world.position[0])
                head = max(tip[1] for tip in world.tip)
                print(f"{guest.name:24}  hips {at}  top {head:5.2f} m  age {age_ms:5.1f} ms", flush=True)
            if not guests:
                state = adapter.state()
                text = "nobody dances" if state == Status.OK else adapter.status_text()
                if text != said:
                    print(f"dance_adapter: {text}", file=sys.stderr, flush=True)
                said = text
            if options.seconds and time.monotonic() >= end:
                return 0 if seen else 1
            time.sleep(1.0 if not options.seconds else min(1.0, max(0.05, end - time.monotonic())))


if __name__ == "__main__":
    try:
        sys.exit(_main(sys.argv[1:]))
    except (KeyboardInterrupt, BrokenPipeError):
        sys.exit(0)
