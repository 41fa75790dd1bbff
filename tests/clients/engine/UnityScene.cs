// A scene of Unity's components without Unity: NAME SECONDS. DanceStage shows the dancers of a real
// house on Humanoid avatars of their proportions, which stand in A-pose in the scene and whose bones
// lie any way, in a scene graph that does what Unity's is said to (UnityEngineStub.cs). Prints where
// the avatars' Transforms are after each LateUpdate, as `pose GUEST SEQUENCE` and 22 places. A third stage
// has a prefab that cannot be posed, and its avatars are destroyed by others.
using System;
using System.Collections.Generic;
using System.Globalization;
using System.Reflection;
using System.Text;
using System.Threading;
using DanceGraph;
using UnityEngine;

public static unsafe class UnityScene
{
    private static void Call(MonoBehaviour component, string message)
    {
        component.GetType().GetMethod(message, BindingFlags.Instance | BindingFlags.NonPublic).Invoke(component, null);
    }

    private static HumanBodyBones HumanBone(int bone)
    {
        string name = DanceNative.BoneName(bone);
        name = char.ToUpperInvariant(name[0]) + name.Substring(1);
        return (HumanBodyBones)Enum.Parse(typeof(HumanBodyBones), name);
    }

    // A prefab: an object with an Animator, below it a scaled node, below that the bones.
    private static GameObject PrefabOf(DanceSkeleton skeleton)
    {
        var prefab = new GameObject("avatar");
        Animator animator = prefab.AddComponent<Animator>();
        Transform armature = new GameObject("armature").transform;
        armature.parent = prefab.transform;
        armature.localScale = new Vector3(0.01f, 0.01f, 0.01f);
        var random = new Random(3);
        var bones = new Transform[DanceNative.Bones];
        var tPose = new List<SkeletonBone>();
        tPose.Add(Stored(armature));
        for (int bone = 0; bone < DanceNative.Bones; ++bone)
        {
            int parent = DanceBones.Parent[bone];
            bones[bone] = new GameObject(DanceNative.BoneName(bone)).transform;
            bones[bone].parent = parent < 0 ? armature : bones[parent];
            var offset = new Vector3(skeleton.Offset[3 * bone], skeleton.Offset[3 * bone + 1], skeleton.Offset[3 * bone + 2]);
            bones[bone].position = parent < 0 ? offset : bones[parent].position + offset;
            DanceRotation lies = new DanceRotation((float)random.NextDouble(), (float)random.NextDouble(),
                                                   (float)random.NextDouble(), (float)random.NextDouble()).Normalized();
            bones[bone].rotation = new Quaternion(lies.X, lies.Y, lies.Z, lies.W);
            animator.bones[HumanBone(bone)] = bones[bone];
            tPose.Add(Stored(bones[bone]));
        }
        animator.avatar = new Avatar { humanDescription = new HumanDescription { skeleton = tPose.ToArray() } };
        // In the scene it stands otherwise than it was configured.
        bones[DanceBones.LeftUpperArm].localRotation *= new Quaternion(0.3f, 0, 0, 0.954f);
        return prefab;
    }

    private static SkeletonBone Stored(Transform bone)
    {
        return new SkeletonBone
        {
            name = bone.name, position = bone.localPosition, rotation = bone.localRotation, scale = bone.localScale,
        };
    }

    private static DanceStage StageOf(string house, string guest, string other)
    {
        using (var adapter = new DanceAdapter(house, DanceAxes.Unity))
        {
            var guests = new DanceGuest[DanceNative.MaxGuests];
            DanceSkeleton skeleton = DanceSkeleton.Make();
            for (;;)
            {
                int count = adapter.Guests(guests);
                for (int g = 0; g < count; ++g)
                    if (guests[g].IsNamed(guest) && guests[g].HasSkeleton != 0 &&
                        adapter.Skeleton(guests[g].Slot, ref skeleton) == DanceStatus.Ok)
                    {
                        DanceStage stage = new GameObject("stage of " + guest).AddComponent<DanceStage>();
                        stage.houseName = house;
                        stage.avatars = new[] { PrefabOf(skeleton) };
                        stage.exceptGuest = other;
                        stage.displayLeadMs = -1;
                        Call(stage, "OnEnable");
                        return stage;
                    }
                Thread.Sleep(20);
            }
        }
    }

    // Both guests; alice gets a prefab that is Humanoid, but whose bones are no objects of the scene.
    private static DanceStage StageWithAnUnfitPrefab(string house, GameObject fit)
    {
        var unfit = new GameObject("optimized");
        unfit.AddComponent<Animator>().avatar = fit.GetComponent<Animator>().avatar;
        DanceStage stage = new GameObject("stage of both").AddComponent<DanceStage>();
        stage.houseName = house;
        int entries = 2;
        while (AvatarOf("alice") % entries == AvatarOf("bob") % entries) ++entries;
        stage.avatars = new GameObject[entries];
        for (int i = 0; i < entries; ++i) stage.avatars[i] = i == AvatarOf("alice") % entries ? unfit : fit;
        Call(stage, "OnEnable");
        return stage;
    }

    private static int AvatarOf(string id)
    {
        MethodInfo method = typeof(DanceStage).GetMethod("AvatarOf", BindingFlags.Static | BindingFlags.NonPublic);
        return (int)method.Invoke(null, new object[] { id });
    }

    // Other scripts destroy what they did not make, each time something else; false where it was not made anew.
    private static bool IsMadeAgain(DanceStage stage, int turn)
    {
        DanceFigure figure = stage.Figures[0];
        Transform hips = figure.gameObject.GetComponentInChildren<Animator>().GetBoneTransform(HumanBodyBones.Hips);
        UnityEngine.Object.Destroy(turn == 0 ? hips.gameObject : turn == 1 ? (UnityEngine.Object)figure : figure.gameObject);
        Call(stage, "LateUpdate");
        return stage.Figures.Count == 1 && stage.transform.children.Count == 1 && stage.Figures[0] != null &&
               !ReferenceEquals(stage.Figures[0], figure);
    }

    private static void Print(DanceFigure figure, Dictionary<string, uint> last)
    {
        uint before;
        if (figure.Status != DanceStatus.Ok) return;
        if (last.TryGetValue(figure.Guest, out before) && before == figure.Shown.Sequence) return;
        last[figure.Guest] = figure.Shown.Sequence;
        var line = new StringBuilder("pose " + figure.Guest + " " + figure.Shown.Sequence);
        Animator animator = figure.gameObject.GetComponentInChildren<Animator>();
        for (int bone = 0; bone < DanceNative.Bones; ++bone)
        {
            Vector3 at = animator.GetBoneTransform(HumanBone(bone)).position;
            line.AppendFormat(CultureInfo.InvariantCulture, " {0:F6} {1:F6} {2:F6}", at.x, at.y, at.z);
        }
        Console.WriteLine(line);
    }

    public static int Main(string[] arguments)
    {
        double seconds = double.Parse(arguments[1], CultureInfo.InvariantCulture);
        DanceStage[] stages =
        {
            StageOf(arguments[0], "alice", "bob"), StageOf(arguments[0], "bob", "alice"),
        };
        DanceStage mixed = StageWithAnUnfitPrefab(arguments[0], stages[0].avatars[0]);
        int destroyed = 0;
        bool bobWasShown = false;
        var last = new Dictionary<string, uint>();
        long end = DanceAdapter.NowNs + (long)(seconds * 1e9), turn = DanceAdapter.NowNs;
        int most = 0;
        while (turn < end)
        {
            foreach (DanceStage stage in stages)
            {
                Call(stage, "LateUpdate");
                most = Math.Max(most, stage.Figures.Count);
                // Without its own proportions yet, a dancer that came back is an average adult.
                foreach (DanceFigure figure in stage.Figures)
                    if (HasSkeleton(stage, figure)) Print(figure, last);
            }
            Call(mixed, "LateUpdate");
            if (mixed.Figures.Count > 1 || mixed.transform.children.Count != mixed.Figures.Count) return 5;
            if (mixed.Figures.Count == 1)
            {
                bobWasShown |= mixed.Figures[0].Guest == "bob" && mixed.Figures[0].Status == DanceStatus.Ok;
                if (destroyed < 3 && !IsMadeAgain(mixed, destroyed++)) return 6;
            }
            turn += 1000000000 / 60;
            long wait = turn - DanceAdapter.NowNs;
            if (wait > 0) Thread.Sleep((int)(wait / 1000000));
        }
        DanceCounters counters = DanceCounters.Make();
        stages[0].Adapter.Counters(ref counters);
        Console.WriteLine("counters {0} {1} {2} {3} {4}", counters.Reads, counters.Retries, counters.Busy,
                          counters.Damaged, counters.Attached);
        foreach (DanceStage stage in stages)
        {
            Call(stage, "OnDisable");
            if (stage.Figures.Count != 0 || stage.transform.children.Count != 0) return 3;
        }
        // The unfit prefab was named once.
        return most == 1 && bobWasShown && destroyed == 3 && Debug.Errors == 0 && Debug.Warnings == 1 ? 0 : 4;
    }

    private static readonly DanceGuest[] known = new DanceGuest[DanceNative.MaxGuests];

    private static bool HasSkeleton(DanceStage stage, DanceFigure figure)
    {
        int count = stage.Adapter.Guests(known);
        for (int g = 0; g < count; ++g)
            if (known[g].Slot == figure.Slot) return known[g].HasSkeleton != 0;
        return false;
    }
}
