// The retargeting maths of bindings/csharp, run for real: rigs with bones that lie any way, in
// A-pose, taller, with bones missing. Seeds are fixed; each test is a sentence.
using System;
using System.Collections.Generic;
using DanceGraph;

public static unsafe class RetargetTest
{
    private static int failures;
    private static string test = "";
    private static readonly Random random = new Random(7);

    private static void Expect(bool holds, string what)
    {
        if (holds) return;
        ++failures;
        if (failures < 20) Console.WriteLine("FAILED: " + test + ": " + what);
    }

    private static void ExpectNear(double got, double wanted, double bound, string what)
    {
        Expect(Math.Abs(got - wanted) <= bound, what + " is " + got + " and not " + wanted);
    }

    private static float Uniform(double low, double high)
    {
        return (float)(low + (high - low) * random.NextDouble());
    }

    private static DanceRotation RandomRotation(double largest)
    {
        var axis = new DanceVector(Uniform(-1, 1), Uniform(-1, 1), Uniform(-1, 1)).Normalized();
        double half = Uniform(-largest, largest) / 2;
        float s = (float)Math.Sin(half);
        return new DanceRotation(s * axis.X, s * axis.Y, s * axis.Z, (float)Math.Cos(half));
    }

    // An adult in Unity's axes: the left is at -X.
    private static DanceVector[] Offsets(float size)
    {
        var o = new DanceVector[DanceBones.Count];
        Action<int, double, double, double> set = (bone, x, y, z) =>
            o[bone] = size * new DanceVector((float)x, (float)y, (float)z);
        set(DanceBones.Hips, 0, 0.95, 0);
        set(DanceBones.Spine, 0, 0.1, -0.01);
        set(DanceBones.Chest, 0, 0.12, 0);
        set(DanceBones.UpperChest, 0, 0.13, 0.01);
        set(DanceBones.Neck, 0, 0.15, 0);
        set(DanceBones.Head, 0, 0.1, 0.02);
        for (int side = 0; side < 2; ++side)
        {
            double left = side == 0 ? -1 : 1;
            int arm = side == 0 ? DanceBones.LeftShoulder : DanceBones.RightShoulder;
            int leg = side == 0 ? DanceBones.LeftUpperLeg : DanceBones.RightUpperLeg;
            int fingers = DanceNative.Bones + 15 * side;
            set(arm, left * 0.03, 0.1, 0);
            set(arm + 1, left * 0.13, 0, 0);
            set(arm + 2, left * 0.28, 0, 0);
            set(arm + 3, left * 0.26, 0, 0);
            set(leg, left * 0.09, -0.05, 0);
            set(leg + 1, 0, -0.42, 0);
            set(leg + 2, 0, -0.4, 0);
            set(leg + 3, 0, -0.06, 0.14);
            for (int finger = 0; finger < 15; ++finger)
                set(fingers + finger, left * (finger % 3 == 0 ? 0.08 : 0.03), 0,
                    finger % 3 == 0 ? 0.04 - 0.02 * (finger / 3) : 0);
        }
        return o;
    }

    private static DanceSkeleton SkeletonOf(DanceVector[] offsets, uint version)
    {
        DanceSkeleton skeleton = DanceSkeleton.Make();
        skeleton.Version = version;
        for (int bone = 0; bone < DanceNative.Bones; ++bone)
        {
            skeleton.Offset[3 * bone] = offsets[bone].X;
            skeleton.Offset[3 * bone + 1] = offsets[bone].Y;
            skeleton.Offset[3 * bone + 2] = offsets[bone].Z;
        }
        return skeleton;
    }

    // A rig: where its bones are and how they lie, standing as it does.
    private sealed class Rig
    {
        public readonly bool[] Has = new bool[DanceBones.Count];
        public readonly DanceVector[] Position = new DanceVector[DanceBones.Count];
        public readonly DanceRotation[] Rotation = new DanceRotation[DanceBones.Count];

        // Arms lowered and legs spread by so many radians; bones lie at random where `anyWay`.
        public Rig(DanceVector[] offsets, double armsDown, double legsOut, bool anyWay, params int[] missing)
        {
            var stance = new DanceRotation[DanceBones.Count];
            for (int bone = 0; bone < DanceBones.Count; ++bone)
            {
                int parent = DanceBones.Parent[bone];
                Has[bone] = Array.IndexOf(missing, bone) < 0;
                DanceRotation turn = parent < 0 ? DanceRotation.Identity : stance[parent];
                if (bone == DanceBones.LeftUpperArm) turn = turn * AboutZ(armsDown);
                if (bone == DanceBones.RightUpperArm) turn = turn * AboutZ(-armsDown);
                if (bone == DanceBones.LeftUpperLeg) turn = turn * AboutZ(-legsOut);
                if (bone == DanceBones.RightUpperLeg) turn = turn * AboutZ(legsOut);
                if (bone == DanceBones.LeftFoot || bone == DanceBones.RightFoot) turn = DanceRotation.Identity;
                stance[bone] = turn;
                Position[bone] = parent < 0 ? offsets[bone] : Position[parent] + stance[parent] * offsets[bone];
                Rotation[bone] = stance[bone] * (anyWay ? RandomRotation(3) : DanceRotation.Identity);
            }
        }

        private static DanceRotation AboutZ(double angle)
        {
            return new DanceRotation(0, 0, (float)Math.Sin(angle / 2), (float)Math.Cos(angle / 2));
        }

        // Where the bones are when each is turned so: each is fixed in the nearest that the rig has.
        public DanceVector[] Placed(DanceRotation[] world, DanceVector hips)
        {
            var at = new DanceVector[DanceBones.Count];
            for (int bone = 0; bone < DanceBones.Count; ++bone)
            {
                int parent = DanceBones.Parent[bone];
                while (parent >= 0 && !Has[parent]) parent = DanceBones.Parent[parent];
                if (!Has[bone]) continue;
                at[bone] = parent < 0 ? hips
                    : at[parent] + world[parent] * (Rotation[parent].Inverse() * (Position[bone] - Position[parent]));
            }
            return at;
        }
    }

    private static DancePose RandomPose()
    {
        DancePose pose = DancePose.Make();
        for (int bone = 0; bone < DanceNative.Bones; ++bone)
        {
            DanceRotation q = RandomRotation(bone == 0 ? 3 : 1.2);
            pose.Rotation[4 * bone] = q.X;
            pose.Rotation[4 * bone + 1] = q.Y;
            pose.Rotation[4 * bone + 2] = q.Z;
            pose.Rotation[4 * bone + 3] = q.W;
        }
        pose.HipsPosition[0] = Uniform(-2, 2);
        pose.HipsPosition[1] = Uniform(0.5, 1.1);
        pose.HipsPosition[2] = Uniform(-2, 2);
        return pose;
    }

    private static DanceHands RandomHands()
    {
        DanceHands hands = DanceHands.Make();
        hands.Presence = (1u << DanceNative.FingerBones) - 1;
        for (int bone = 0; bone < DanceNative.FingerBones; ++bone)
        {
            DanceRotation q = RandomRotation(1);
            hands.Rotation[4 * bone] = q.X;
            hands.Rotation[4 * bone + 1] = q.Y;
            hands.Rotation[4 * bone + 2] = q.Z;
            hands.Rotation[4 * bone + 3] = q.W;
        }
        return hands;
    }

    private static DanceRotation LocalOf(ref DancePose pose, ref DanceHands hands, int bone)
    {
        fixed (float* body = pose.Rotation, fingers = hands.Rotation)
        {
            float* q = bone < DanceNative.Bones ? body + 4 * bone : fingers + 4 * (bone - DanceNative.Bones);
            return new DanceRotation(q[0], q[1], q[2], q[3]);
        }
    }

    private static DanceVector HipsOf(ref DancePose pose)
    {
        fixed (float* hips = pose.HipsPosition) return new DanceVector(hips[0], hips[1], hips[2]);
    }

    // The dancer's own bones: forward kinematics.
    private static DanceVector[] Dancer(DanceVector[] offsets, ref DancePose pose, ref DanceHands hands,
                                        out DanceRotation[] world)
    {
        var at = new DanceVector[DanceBones.Count];
        world = new DanceRotation[DanceBones.Count];
        for (int bone = 0; bone < DanceBones.Count; ++bone)
        {
            int parent = DanceBones.Parent[bone];
            DanceRotation local = LocalOf(ref pose, ref hands, bone);
            world[bone] = parent < 0 ? local : world[parent] * local;
            at[bone] = parent < 0 ? HipsOf(ref pose) : at[parent] + world[parent] * offsets[bone];
        }
        return at;
    }

    private static double AngleBetween(DanceVector a, DanceVector b)
    {
        return Math.Atan2(DanceVector.Cross(a, b).Length, DanceVector.Dot(a, b)) * 180 / Math.PI;
    }

    private static double AngleBetween(DanceRotation a, DanceRotation b)
    {
        DanceRotation turn = a.Inverse() * b;
        double sine = new DanceVector(turn.X, turn.Y, turn.Z).Length;
        return 2 * Math.Atan2(sine, Math.Abs(turn.W)) * 180 / Math.PI;
    }

    private static readonly int[] limbs =
    {
        DanceBones.LeftUpperArm, DanceBones.LeftLowerArm, DanceBones.RightUpperArm, DanceBones.RightLowerArm,
        DanceBones.LeftUpperLeg, DanceBones.LeftLowerLeg, DanceBones.RightUpperLeg, DanceBones.RightLowerLeg,
    };

    private static void ExpectLimbsAlike(Rig rig, string what)
    {
        DanceVector[] dancer = Offsets(1);
        DanceSkeleton skeleton = SkeletonOf(dancer, 1);
        var retarget = new DanceRetarget(rig.Has, rig.Position, rig.Rotation);
        retarget.SetSkeleton(ref skeleton);
        for (int i = 0; i < 50; ++i)
        {
            DancePose pose = RandomPose();
            DanceHands hands = RandomHands();
            DanceRotation[] world;
            DanceVector[] wanted = Dancer(dancer, ref pose, ref hands, out world);
            retarget.Show(ref pose, ref hands);
            DanceVector[] got = rig.Placed(retarget.World, retarget.HipsPosition);
            foreach (int bone in limbs)
                ExpectNear(AngleBetween(got[bone + 1] - got[bone], wanted[bone + 1] - wanted[bone]), 0, 0.1,
                           what + ", bone " + bone);
            foreach (int bone in new[] { DanceBones.Head, DanceBones.RightFoot })
                ExpectNear(AngleBetween(retarget.World[bone] * rig.Rotation[bone].Inverse(), world[bone]), 0, 0.1,
                           what + ", turn of " + bone);
        }
    }

    private static void SameRigStandsWhereTheDancerDoes()
    {
        test = "A rig of the dancer's own proportions has every bone and finger where the dancer has it";
        foreach (bool anyWay in new[] { false, true })
        {
            DanceVector[] offsets = Offsets(1);
            var rig = new Rig(offsets, 0, 0, anyWay);
            DanceSkeleton skeleton = SkeletonOf(offsets, 1);
            var retarget = new DanceRetarget(rig.Has, rig.Position, rig.Rotation);
            retarget.SetSkeleton(ref skeleton);
            for (int i = 0; i < 200; ++i)
            {
                DancePose pose = RandomPose();
                DanceHands hands = RandomHands();
                DanceRotation[] world;
                DanceVector[] wanted = Dancer(offsets, ref pose, ref hands, out world);
                retarget.Show(ref pose, ref hands);
                DanceVector[] got = rig.Placed(retarget.World, retarget.HipsPosition);
                for (int bone = 0; bone < DanceBones.Count; ++bone)
                    ExpectNear((got[bone] - wanted[bone]).Length, 0, 1e-5, "distance of bone " + bone);
            }
        }
    }

    private static void LimbsPointAsTheDancersDo()
    {
        test = "Limbs point where the dancer's do on rigs of any size, in A-pose, with bones lying any way";
        ExpectLimbsAlike(new Rig(Offsets(1.3f), 0, 0, true), "tall");
        ExpectLimbsAlike(new Rig(Offsets(0.8f), 0.8, 0.1, false), "A-pose");
        ExpectLimbsAlike(new Rig(Offsets(0.8f), 0.8, 0.1, true), "A-pose, any way");
        test = "Limbs, head and feet keep their turn on rigs that lack optional bones";
        int[] spine = { DanceBones.Chest, DanceBones.UpperChest };
        int[] all =
        {
            DanceBones.Chest, DanceBones.UpperChest, DanceBones.Neck, DanceBones.LeftShoulder, DanceBones.RightShoulder,
            DanceBones.LeftToes, DanceBones.RightToes,
        };
        ExpectLimbsAlike(new Rig(Offsets(1), 0, 0, true, spine), "no chests");
        ExpectLimbsAlike(new Rig(Offsets(1.1f), 0.7, 0.05, true, all), "no optional bones");
        ExpectLimbsAlike(new Rig(Offsets(1.1f), 0.7, 0.05, true, DanceBones.UpperChest), "no upper chest");
    }

    private static void AHandInAPoseTurnsAboutItsForearm()
    {
        test = "A hand of a rig in A-pose lies along its forearm when the dancer's does";
        var rig = new Rig(Offsets(1), 0.8, 0, true);
        var retarget = new DanceRetarget(rig.Has, rig.Position, rig.Rotation);
        DancePose pose = RandomPose();
        for (int bone = 0; bone < DanceNative.Bones; ++bone)
            for (int i = 0; i < 4; ++i) pose.Rotation[4 * bone + i] = i == 3 ? 1 : 0;
        DanceHands hands = DanceHands.Make();
        retarget.Show(ref pose, ref hands);
        DanceVector[] at = rig.Placed(retarget.World, retarget.HipsPosition);
        int middle = DanceNative.Bones + 6;
        ExpectNear(AngleBetween(at[middle] - at[DanceBones.LeftHand], new DanceVector(-1, 0, 0)), 0, 0.1, "the hand");
        ExpectNear(AngleBetween(at[DanceBones.LeftHand] - at[DanceBones.LeftLowerArm], new DanceVector(-1, 0, 0)), 0,
                   0.1, "the forearm");
    }

    private static void AChestCarriesTheShouldersOfAMissingUpperChest()
    {
        test = "Without an upper chest the chest carries the shoulders as far as the dancer's turn";
        var rig = new Rig(Offsets(1), 0, 0, true, DanceBones.UpperChest);
        var retarget = new DanceRetarget(rig.Has, rig.Position, rig.Rotation);
        DancePose pose = RandomPose();
        DanceHands hands = DanceHands.Make();
        DanceRotation[] world;
        Dancer(Offsets(1), ref pose, ref hands, out world);
        retarget.Show(ref pose, ref hands);
        ExpectNear(AngleBetween(retarget.World[DanceBones.Chest] * rig.Rotation[DanceBones.Chest].Inverse(),
                                world[DanceBones.UpperChest]), 0, 0.1, "the chest's turn");
    }

    private static void SolesStayOnTheFloor()
    {
        test = "An avatar of another size stands on the floor where the dancer does, at the dancer's place";
        foreach (float size in new[] { 0.6f, 1.4f })
        {
            var rig = new Rig(Offsets(size), 0.6, 0, true);
            var retarget = new DanceRetarget(rig.Has, rig.Position, rig.Rotation);
            DanceSkeleton skeleton = SkeletonOf(Offsets(1), 1);
            retarget.SetSkeleton(ref skeleton);
            DancePose pose = RandomPose();
            for (int bone = 0; bone < DanceNative.Bones; ++bone)
                for (int i = 0; i < 4; ++i) pose.Rotation[4 * bone + i] = i == 3 ? 1 : 0;
            pose.HipsPosition[1] = 0.95f;
            DanceHands hands = DanceHands.Make();
            retarget.Show(ref pose, ref hands);
            DanceVector[] at = rig.Placed(retarget.World, retarget.HipsPosition);
            ExpectNear(at[DanceBones.LeftFoot].Y, rig.Position[DanceBones.LeftFoot].Y, 1e-4, "the ankle's height");
            ExpectNear(retarget.HipsPosition.X, pose.HipsPosition[0], 1e-6, "the place");
        }
    }

    private static void CaptureIsTheWayBack()
    {
        test = "What a rig shows is captured as the pose and the fingers that it was given";
        var rig = new Rig(Offsets(1), 0.7, 0.05, true);
        var retarget = new DanceRetarget(rig.Has, rig.Position, rig.Rotation);
        for (int i = 0; i < 100; ++i)
        {
            DancePose pose = RandomPose(), back = DancePose.Make();
            DanceHands hands = RandomHands(), fingers = DanceHands.Make();
            retarget.Show(ref pose, ref hands);
            retarget.Capture(retarget.World, retarget.HipsPosition, ref back, ref fingers);
            for (int bone = 0; bone < DanceBones.Count; ++bone)
                ExpectNear(AngleBetween(LocalOf(ref pose, ref hands, bone), LocalOf(ref back, ref fingers, bone)), 0,
                           0.1, "bone " + bone);
            ExpectNear(back.HipsPosition[1], pose.HipsPosition[1], 1e-5, "the hips");
            Expect(back.Presence == (1u << DanceNative.Bones) - 1, "a bone was not seen");
            Expect(fingers.Presence == (1u << DanceNative.FingerBones) - 1, "a finger was not seen");
        }
        test = "A bone that the rig lacks is captured as not seen, and unturned";
        var without = new Rig(Offsets(1), 0, 0, true, DanceBones.Neck);
        var other = new DanceRetarget(without.Has, without.Position, without.Rotation);
        DancePose given = RandomPose(), got = DancePose.Make();
        DanceHands none = DanceHands.Make();
        other.Show(ref given, ref none);
        other.Capture(other.World, other.HipsPosition, ref got, ref none);
        Expect((got.Presence >> DanceBones.Neck & 1) == 0, "the neck was seen");
        ExpectNear(got.Rotation[4 * DanceBones.Neck + 3], 1, 1e-5, "the neck's turn");
    }

    private static void AnAPoseIsMeasuredAsAT()
    {
        test = "A rig in A-pose is measured with its own proportions, arms out";
        DanceVector[] offsets = Offsets(1.2f);
        var rig = new Rig(offsets, 0.8, 0.1, true);
        var retarget = new DanceRetarget(rig.Has, rig.Position, rig.Rotation);
        DanceSkeleton skeleton = DanceSkeleton.Make();
        retarget.Measure(ref skeleton);
        for (int bone = 0; bone < DanceNative.Bones; ++bone)
        {
            var got = new DanceVector(skeleton.Offset[3 * bone], skeleton.Offset[3 * bone + 1], skeleton.Offset[3 * bone + 2]);
            ExpectNear((got - offsets[bone]).Length, 0, 1e-4, "offset of bone " + bone);
        }
    }

    private static void ShowingMakesNoGarbage()
    {
        test = "Showing and capturing make no garbage";
        var rig = new Rig(Offsets(1), 0.7, 0.05, true);
        var retarget = new DanceRetarget(rig.Has, rig.Position, rig.Rotation);
        DancePose pose = RandomPose();
        DanceHands hands = RandomHands();
        DanceSkeleton skeleton = SkeletonOf(Offsets(1), 1);
        retarget.Show(ref pose, ref hands);
        retarget.Capture(retarget.World, retarget.HipsPosition, ref pose, ref hands);
        GC.Collect();
        int collections = GC.CollectionCount(0);
        for (int i = 0; i < 30000; ++i)
        {
            skeleton.Offset[3] = 0.001f * (i % 7);
            retarget.SetSkeleton(ref skeleton);
            retarget.Show(ref pose, ref hands);
            retarget.Capture(retarget.World, retarget.HipsPosition, ref pose, ref hands);
            retarget.Measure(ref skeleton);
        }
        Expect(GC.CollectionCount(0) == collections, "the collector ran " + (GC.CollectionCount(0) - collections) + " times");
    }

    public static int Main()
    {
        var tests = new List<Action>
        {
            SameRigStandsWhereTheDancerDoes, LimbsPointAsTheDancersDo, AHandInAPoseTurnsAboutItsForearm,
            AChestCarriesTheShouldersOfAMissingUpperChest, SolesStayOnTheFloor, CaptureIsTheWayBack,
            AnAPoseIsMeasuredAsAT, ShowingMakesNoGarbage,
        };
        foreach (Action one in tests)
        {
            int before = failures;
            one();
            Console.WriteLine((failures == before ? "passed: " : "FAILED: ") + one.Method.Name);
        }
        return failures == 0 ? 0 : 1;
    }
}
