// The dancers of a house for C#: every function of dance_adapter.h, and two classes that own their
// handles. Needs no package and no engine; compile it with unsafe code allowed.
//
// Units/frames: metres, nanoseconds of CLOCK_MONOTONIC, beats; axes as given when opened. Rotations
//               are x, y, z, w, of each bone in its parent, identity in T-pose.
// Ownership:    DanceAdapter and DancePoseSender close their handle in Dispose(). Structs are the caller's
//               and blittable: a call neither copies nor allocates.
// Threads:      a handle belongs to one thread at a time.
// Failure:      a call returns a DanceStatus; a constructor throws where the library is missing, of
//               another ABI, or the name unfit.
using System;
using System.Runtime.InteropServices;

namespace DanceGraph
{
    public enum DanceStatus
    {
        Ok = 0, NoHouse = 1, NoGuest = 2, NoData = 3, Busy = 4, WrongVersion = 5, Damaged = 6,
        BadArgument = 7, Invalid = 8,
    }

    public enum DanceAxes { Gltf = 0, Unity = 1, Unreal = 2, Blender = 3 }

    public enum DancePoseKind { Newest = 0, Interpolated = 1, Predicted = 2, Held = 3 }

    [StructLayout(LayoutKind.Sequential)]
    public unsafe struct DanceGuest
    {
        public uint StructSize;
        public uint Slot;
        public fixed byte Id[32];
        public long NewestNs;
        public uint HasSkeleton;
        public uint HasHands;
        public uint Generation;
        public uint Reserved;

        // Makes a string: for when a guest is new, not for every frame.
        public string Name
        {
            get
            {
                fixed (byte* id = Id)
                {
                    int length = 0;
                    while (length < 32 && id[length] != 0) ++length;
                    return new string((sbyte*)id, 0, length);
                }
            }
        }

        public bool IsNamed(string name)
        {
            if (name.Length >= 32) return false;
            fixed (byte* id = Id)
            {
                for (int i = 0; i < name.Length; ++i)
                    if (id[i] != name[i]) return false;
                return id[name.Length] == 0;
            }
        }
    }

    [StructLayout(LayoutKind.Sequential)]
    public unsafe struct DancePose
    {
        public uint StructSize;
        public uint Kind;
        public uint Sequence;
        public uint Presence;
        public float Confidence;
        public fixed float HipsPosition[3];
        public fixed float Rotation[DanceNative.Bones * 4];
        public long CaptureNs;
        public long StagedNs;
        public long TimeNs;
        public double MusicBeats;
        public uint Generation;
        public uint Reserved;

        public static DancePose Make()
        {
            return new DancePose { StructSize = (uint)sizeof(DancePose), MusicBeats = double.NaN };
        }
    }

    [StructLayout(LayoutKind.Sequential)]
    public unsafe struct DanceHands
    {
        public uint StructSize;
        public uint Presence;
        public fixed float Rotation[DanceNative.FingerBones * 4];
        public long CaptureNs;

        public static DanceHands Make()
        {
            return new DanceHands { StructSize = (uint)sizeof(DanceHands) };
        }
    }

    [StructLayout(LayoutKind.Sequential)]
    public unsafe struct DanceSkeleton
    {
        public uint StructSize;
        public uint Version;
        public fixed float Offset[DanceNative.Bones * 3];
        public fixed float Tip[DanceNative.Tips * 3];

        public static DanceSkeleton Make()
        {
            return new DanceSkeleton { StructSize = (uint)sizeof(DanceSkeleton) };
        }
    }

    [StructLayout(LayoutKind.Sequential)]
    public unsafe struct DanceWorld
    {
        public uint StructSize;
        public uint Reserved;
        public fixed float Position[DanceNative.Bones * 3];
        public fixed float Rotation[DanceNative.Bones * 4];
        public fixed float Tip[DanceNative.Tips * 3];

        public static DanceWorld Make()
        {
            return new DanceWorld { StructSize = (uint)sizeof(DanceWorld) };
        }
    }

    [StructLayout(LayoutKind.Sequential)]
    public struct DanceBeat
    {
        public uint StructSize;
        public uint BeatsPerBar;
        public double PositionBeats;
        public double TempoBpm;
        public float Confidence;
        public uint Playing;

        public static DanceBeat Make()
        {
            return new DanceBeat { StructSize = (uint)Marshal.SizeOf(typeof(DanceBeat)) };
        }
    }

    [StructLayout(LayoutKind.Sequential)]
    public struct DanceCounters
    {
        public uint StructSize;
        public uint Reserved;
        public ulong Reads;
        public ulong Retries;
        public ulong Busy;
        public ulong Damaged;
        public ulong Attached;

        public static DanceCounters Make()
        {
            return new DanceCounters { StructSize = (uint)Marshal.SizeOf(typeof(DanceCounters)) };
        }
    }

    // dance_adapter.h as it is. Unity completes a plug-in's name itself and knows no versions in it:
    // libdance_adapter.so in the package. Elsewhere the system finds the file of the package dancegraph.
    public static unsafe class DanceNative
    {
        public const uint Abi = 1;
        public const int MaxGuests = 64;
        public const int Bones = 22;
        public const int FingerBones = 30;
        public const int Tips = 5;
        public const long LongestPredictionNs = 100000000;
#if UNITY_5_3_OR_NEWER
        private const string Library = "dance_adapter";
        private const string Cure = "libdance_adapter.so cannot be loaded: put it into the package's Runtime/Plugins/x86_64";
#else
        private const string Library = "libdance_adapter.so.1";
        private const string Cure =
            "libdance_adapter.so.1 cannot be loaded: install dancegraph, or put its folder into LD_LIBRARY_PATH";
#endif
        private const CallingConvention C = CallingConvention.Cdecl;

        [DllImport(Library, CallingConvention = C)] public static extern uint dance_adapter_abi();
        [DllImport(Library, CallingConvention = C)] public static extern long dance_adapter_now_ns();
        [DllImport(Library, CallingConvention = C)] public static extern IntPtr dance_bone_name(uint bone);
        [DllImport(Library, CallingConvention = C)] public static extern int dance_bone_parent(uint bone);
        [DllImport(Library, CallingConvention = C)] public static extern IntPtr dance_finger_bone_name(uint bone);
        [DllImport(Library, CallingConvention = C)] public static extern int dance_finger_bone_parent(uint bone);
        [DllImport(Library, CallingConvention = C)] public static extern IntPtr dance_status_text(DanceStatus status);

        [DllImport(Library, CallingConvention = C)]
        public static extern IntPtr dance_adapter_open([MarshalAs(UnmanagedType.LPStr)] string name, DanceAxes axes);
        [DllImport(Library, CallingConvention = C)] public static extern void dance_adapter_close(IntPtr adapter);
        [DllImport(Library, CallingConvention = C)]
        public static extern DanceStatus dance_adapter_state(IntPtr adapter);
        [DllImport(Library, CallingConvention = C)]
        public static extern uint dance_adapter_guests(IntPtr adapter, DanceGuest* guests, uint capacity);
        [DllImport(Library, CallingConvention = C)]
        public static extern DanceStatus dance_adapter_find(IntPtr adapter,
            [MarshalAs(UnmanagedType.LPStr)] string id, out uint slot);
        [DllImport(Library, CallingConvention = C)]
        public static extern DanceStatus dance_adapter_newest(IntPtr adapter, uint slot, ref DancePose pose);
        [DllImport(Library, CallingConvention = C)]
        public static extern DanceStatus dance_adapter_at(IntPtr adapter, uint slot, long timeNs, ref DancePose pose);
        [DllImport(Library, CallingConvention = C)]
        public static extern DanceStatus dance_adapter_skeleton(IntPtr adapter, uint slot, ref DanceSkeleton skeleton);
        [DllImport(Library, CallingConvention = C)]
        public static extern DanceStatus dance_adapter_hands(IntPtr adapter, uint slot, ref DanceHands hands);
        [DllImport(Library, CallingConvention = C)]
        public static extern DanceStatus dance_adapter_beat(IntPtr adapter, long timeNs, ref DanceBeat beat);
        [DllImport(Library, CallingConvention = C)]
        public static extern DanceStatus dance_adapter_counters(IntPtr adapter, ref DanceCounters counters);
        [DllImport(Library, CallingConvention = C)]
        public static extern DanceStatus dance_world_of(ref DanceSkeleton skeleton, ref DancePose pose, ref DanceWorld world);

        [DllImport(Library, CallingConvention = C)]
        public static extern IntPtr dance_producer_open([MarshalAs(UnmanagedType.LPStr)] string name, DanceAxes axes);
        [DllImport(Library, CallingConvention = C)] public static extern void dance_producer_close(IntPtr producer);
        [DllImport(Library, CallingConvention = C)]
        public static extern DanceStatus dance_producer_skeleton(IntPtr producer, ref DanceSkeleton skeleton);
        [DllImport(Library, CallingConvention = C)]
        public static extern DanceStatus dance_producer_pose(IntPtr producer, ref DancePose pose);
        [DllImport(Library, CallingConvention = C)]
        public static extern DanceStatus dance_producer_hands(IntPtr producer, ref DanceHands hands);

        // Throws where the library cannot be loaded, or is not the one that this file was written for.
        public static void Check()
        {
            uint abi;
            try
            {
                abi = dance_adapter_abi();
            }
            catch (DllNotFoundException)
            {
                throw new InvalidOperationException(Cure);
            }
            if (abi != Abi)
                throw new InvalidOperationException(
                    "libdance_adapter.so has ABI " + abi + " and DanceAdapter.cs " + Abi + ": take both from one version");
        }

        public static string StatusText(DanceStatus status)
        {
            return Marshal.PtrToStringAnsi(dance_status_text(status));
        }

        public static string BoneName(int bone)
        {
            return Marshal.PtrToStringAnsi(dance_bone_name((uint)bone));
        }

        public static string FingerBoneName(int bone)
        {
            return Marshal.PtrToStringAnsi(dance_finger_bone_name((uint)bone));
        }
    }

    // A reader of the house with that name (null = the usual one). There need be no house yet.
    public sealed unsafe class DanceAdapter : IDisposable
    {
        private IntPtr handle;

        public DanceAdapter(string name, DanceAxes axes)
        {
            DanceNative.Check();
            handle = DanceNative.dance_adapter_open(name, axes);
            if (handle == IntPtr.Zero)
                throw new ArgumentException("a name is 1 to 24 characters of a-z, 0-9 and '-'", "name");
        }

        ~DanceAdapter() { Close(); }

        public void Dispose()
        {
            Close();
            GC.SuppressFinalize(this);
        }

        private void Close()
        {
            if (handle != IntPtr.Zero) DanceNative.dance_adapter_close(handle);
            handle = IntPtr.Zero;
        }

        public static long NowNs { get { return DanceNative.dance_adapter_now_ns(); } }

        public DanceStatus State { get { return DanceNative.dance_adapter_state(handle); } }

        // Fills the list with whom there is, and returns how many of its entries are filled.
        public int Guests(DanceGuest[] list)
        {
            if (list.Length == 0) return 0;
            list[0].StructSize = (uint)sizeof(DanceGuest);
            fixed (DanceGuest* first = list)
            {
                uint count = DanceNative.dance_adapter_guests(handle, first, (uint)list.Length);
                return (int)Math.Min(count, (uint)list.Length);
            }
        }

        public DanceStatus Find(string id, out uint slot)
        {
            return DanceNative.dance_adapter_find(handle, id, out slot);
        }

        public DanceStatus Newest(uint slot, ref DancePose pose)
        {
            return DanceNative.dance_adapter_newest(handle, slot, ref pose);
        }

        // The pose to show at a time: interpolated, or predicted beyond the newest.
        public DanceStatus At(uint slot, long timeNs, ref DancePose pose)
        {
            return DanceNative.dance_adapter_at(handle, slot, timeNs, ref pose);
        }

        public DanceStatus Skeleton(uint slot, ref DanceSkeleton skeleton)
        {
            return DanceNative.dance_adapter_skeleton(handle, slot, ref skeleton);
        }

        public DanceStatus Hands(uint slot, ref DanceHands hands)
        {
            return DanceNative.dance_adapter_hands(handle, slot, ref hands);
        }

        public DanceStatus Beat(long timeNs, ref DanceBeat beat)
        {
            return DanceNative.dance_adapter_beat(handle, timeNs, ref beat);
        }

        public DanceStatus Counters(ref DanceCounters counters)
        {
            return DanceNative.dance_adapter_counters(handle, ref counters);
        }

        public static DanceStatus WorldOf(ref DanceSkeleton skeleton, ref DancePose pose, ref DanceWorld world)
        {
            return DanceNative.dance_world_of(ref skeleton, ref pose, ref world);
        }
    }

    // The way back: a tracker's poses become captures of a guest in the house whose receiver has
    // that name. None waits; without a house they are dropped, and the status is NoHouse.
    public sealed class DancePoseSender : IDisposable
    {
        private IntPtr handle;

        public DancePoseSender(string name, DanceAxes axes)
        {
            DanceNative.Check();
            handle = DanceNative.dance_producer_open(name, axes);
            if (handle == IntPtr.Zero)
                throw new ArgumentException("a name is 1 to 24 characters of a-z, 0-9 and '-'", "name");
        }

        ~DancePoseSender() { Close(); }

        public void Dispose()
        {
            Close();
            GC.SuppressFinalize(this);
        }

        private void Close()
        {
            if (handle != IntPtr.Zero) DanceNative.dance_producer_close(handle);
            handle = IntPtr.Zero;
        }

        public DanceStatus Skeleton(ref DanceSkeleton skeleton)
        {
            return DanceNative.dance_producer_skeleton(handle, ref skeleton);
        }

        public DanceStatus Pose(ref DancePose pose)
        {
            return DanceNative.dance_producer_pose(handle, ref pose);
        }

        public DanceStatus Hands(ref DanceHands hands)
        {
            return DanceNative.dance_producer_hands(handle, ref hands);
        }
    }
}
