// Reads a house as a C# program or Unity does: NAME SECONDS. Prints each new pose of each dancer, as
// `pose GUEST SEQUENCE` and where the bones of an avatar of the dancer's proportions are, whose rig
// stands in A-pose and whose bones lie any way: through P/Invoke and DanceRetarget. At the end, what
// the adapter counted and how often the garbage collector ran while nothing was printed.
using System;
using System.Collections.Generic;
using System.Globalization;
using System.Text;
using System.Threading;
using DanceGraph;

public static unsafe class ReadDancers
{
    // An avatar with the skeleton that was read: where its bones are at rest, and how they lie.
    private sealed class Avatar
    {
        private readonly DanceVector[] position = new DanceVector[DanceBones.Count];
        private readonly DanceRotation[] rotation = new DanceRotation[DanceBones.Count];
        private readonly DanceVector[] at = new DanceVector[DanceNative.Bones];
        private readonly DanceRetarget retarget;

        public Avatar(DanceSkeleton skeleton)
        {
            var random = new Random(5);
            var has = new bool[DanceBones.Count];
            var stance = new DanceRotation[DanceBones.Count];
            for (int bone = 0; bone < DanceNative.Bones; ++bone)
            {
                has[bone] = true;
                int parent = DanceBones.Parent[bone];
                stance[bone] = parent < 0 ? DanceRotation.Identity : stance[parent];
                float lowered = bone == DanceBones.LeftUpperArm ? 0.4f : bone == DanceBones.RightUpperArm ? -0.4f : 0;
                stance[bone] = stance[bone] * new DanceRotation(0, 0, (float)Math.Sin(lowered), (float)Math.Cos(lowered));
                var offset = new DanceVector(skeleton.Offset[3 * bone], skeleton.Offset[3 * bone + 1],
                                             skeleton.Offset[3 * bone + 2]);
                position[bone] = parent < 0 ? offset : position[parent] + stance[parent] * offset;
                var lies = new DanceRotation((float)random.NextDouble(), (float)random.NextDouble(),
                                             (float)random.NextDouble(), (float)random.NextDouble()).Normalized();
                rotation[bone] = stance[bone] * lies;
            }
            retarget = new DanceRetarget(has, position, rotation);
            retarget.SetSkeleton(ref skeleton);
        }

        public DanceVector[] Pose(ref DancePose pose, ref DanceHands hands)
        {
            retarget.Show(ref pose, ref hands);
            for (int bone = 0; bone < DanceNative.Bones; ++bone)
            {
                int parent = DanceBones.Parent[bone];
                at[bone] = parent < 0 ? retarget.HipsPosition
                    : at[parent] + retarget.World[parent] * (rotation[parent].Inverse() * (position[bone] - position[parent]));
            }
            return at;
        }
    }

    private static void Read(DanceAdapter adapter, double seconds)
    {
        var guests = new DanceGuest[DanceNative.MaxGuests];
        var last = new Dictionary<string, uint>();
        var avatars = new Dictionary<string, Avatar>();
        var line = new StringBuilder();
        DancePose pose = DancePose.Make();
        DanceHands hands = DanceHands.Make();
        DanceSkeleton skeleton = DanceSkeleton.Make();
        long end = DanceAdapter.NowNs + (long)(seconds * 1e9), turn = DanceAdapter.NowNs;
        while (turn < end)
        {
            int count = adapter.Guests(guests);
            for (int g = 0; g < count; ++g)
            {
                string id = guests[g].Name;
                if (guests[g].HasSkeleton == 0) continue;
                if (adapter.Skeleton(guests[g].Slot, ref skeleton) != DanceStatus.Ok) continue;
                if (adapter.Newest(guests[g].Slot, ref pose) != DanceStatus.Ok) continue;
                uint before;
                if (last.TryGetValue(id, out before) && before == pose.Sequence) continue;
                last[id] = pose.Sequence;
                if (!avatars.ContainsKey(id)) avatars[id] = new Avatar(skeleton);
                line.Length = 0;
                line.Append("pose ").Append(id).Append(' ').Append(pose.Sequence);
                foreach (DanceVector at in avatars[id].Pose(ref pose, ref hands))
                    line.AppendFormat(CultureInfo.InvariantCulture, " {0:F6} {1:F6} {2:F6}", at.X, at.Y, at.Z);
                Console.WriteLine(line);
            }
            turn += 1000000000 / 60;
            long wait = turn - DanceAdapter.NowNs;
            if (wait > 0) Thread.Sleep((int)(wait / 1000000));
        }
    }

    // A second of frames without a word: reading makes no garbage.
    private static int CollectionsOf(DanceAdapter adapter)
    {
        var guests = new DanceGuest[DanceNative.MaxGuests];
        DancePose pose = DancePose.Make();
        DanceSkeleton skeleton = DanceSkeleton.Make();
        DanceHands hands = DanceHands.Make();
        DanceBeat beat = DanceBeat.Make();
        GC.Collect();
        int before = GC.CollectionCount(0);
        for (int frame = 0; frame < 20000; ++frame)
        {
            int count = adapter.Guests(guests);
            for (int g = 0; g < count; ++g)
            {
                adapter.At(guests[g].Slot, DanceAdapter.NowNs, ref pose);
                adapter.Skeleton(guests[g].Slot, ref skeleton);
                adapter.Hands(guests[g].Slot, ref hands);
            }
            adapter.Beat(DanceAdapter.NowNs, ref beat);
        }
        return GC.CollectionCount(0) - before;
    }

    public static int Main(string[] arguments)
    {
        using (var adapter = new DanceAdapter(arguments[0], DanceAxes.Unity))
        {
            Read(adapter, double.Parse(arguments[1], CultureInfo.InvariantCulture));
            DanceCounters counters = DanceCounters.Make();
            adapter.Counters(ref counters);
            Console.WriteLine("counters {0} {1} {2} {3} {4}", counters.Reads, counters.Retries, counters.Busy,
                              counters.Damaged, counters.Attached);
            Console.WriteLine("collections " + CollectionsOf(adapter));
        }
        return 0;
    }
}
