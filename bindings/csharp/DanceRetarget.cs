// Retargeting between a dancer of the stage and an avatar's rig, in both directions: what each bone
// of the avatar is turned to, so that the avatar's limbs point where the dancer's do, whatever way
// the rig's bones lie and whichever of the optional bones it lacks.
//
// Units/frames: Unity's axes (left-handed, +Y up, facing +Z, metres); rotations and places of the
//               avatar are in the space of its root, which stands on the floor below it.
// Ownership:    copies what it is given; nothing is allocated after construction.
// Threads:      none inside; one owner.
// Failure:      a bone that the rig lacks is turned by nobody and its turn reaches its children;
//               the constructor throws where there are no hips.
using System;

namespace DanceGraph
{
    public sealed unsafe class DanceRetarget
    {
        // In the avatar's root's space, after Show(): of the bones that Has.
        public readonly DanceRotation[] World = new DanceRotation[DanceBones.Count];
        public DanceVector HipsPosition;

        private readonly bool[] has;
        private readonly DanceVector[] restPosition;
        private readonly DanceRotation[] rest;
        private readonly DanceRotation[] tPose = new DanceRotation[DanceBones.Count];
        private readonly DanceRotation[] dance = new DanceRotation[DanceBones.Count];
        private readonly DanceVector[] direction = new DanceVector[DanceBones.Count];
        // Whose turn a bone of the spine takes: its own, or that of the last one missing above it.
        private readonly int[] turnOf = new int[DanceBones.Count];
        private readonly float avatarHips;
        private float dancerHips;
        private DanceSkeleton dancer;  // as known last

        // The rig as it stands now, T-pose or nearly (an A-pose is corrected): which of the 52 bones
        // it has, where they are and how they are turned in the root's space.
        public DanceRetarget(bool[] has, DanceVector[] position, DanceRotation[] rotation)
        {
            if (!has[DanceBones.Hips]) throw new ArgumentException("the rig has no hips", "has");
            this.has = (bool[])has.Clone();
            restPosition = (DanceVector[])position.Clone();
            rest = (DanceRotation[])rotation.Clone();
            avatarHips = Math.Max(position[DanceBones.Hips].Y, 0.05f);
            dancerHips = avatarHips;
            for (int bone = 0; bone < DanceBones.Count; ++bone)
            {
                turnOf[bone] = bone;
                dance[bone] = DanceRotation.Identity;
            }
            ShareSpine();
            var left = new DanceVector(-1, 0, 0);
            var down = new DanceVector(0, -1, 0);
            foreach (int bone in new[] { DanceBones.LeftUpperArm, DanceBones.LeftLowerArm }) direction[bone] = left;
            foreach (int bone in new[] { DanceBones.RightUpperArm, DanceBones.RightLowerArm })
                direction[bone] = -1 * left;
            foreach (int bone in new[] { DanceBones.LeftUpperLeg, DanceBones.LeftLowerLeg, DanceBones.RightUpperLeg,
                                         DanceBones.RightLowerLeg })
                direction[bone] = down;
            Straighten();
        }

        public bool Has(int bone) { return has[bone]; }

        // Vertical movement is scaled by this, so that the avatar's soles are on the floor when the
        // dancer's are; steps are not, so that a couple stays together.
        public float Scale { get { return avatarHips / dancerHips; } }

        // The dancer's own proportions: how high its hips are, and which way its limbs lie in T-pose.
        public void SetSkeleton(ref DanceSkeleton skeleton)
        {
            // By what is in it: a house that was started again counts its versions from 1 again.
            fixed (float* offset = skeleton.Offset, known = dancer.Offset)
            {
                bool isKnown = true;
                for (int i = 0; i < 3 * DanceNative.Bones; ++i) isKnown &= offset[i] == known[i];
                if (isKnown) return;
                dancer = skeleton;
                dancerHips = offset[1] > 0.05f ? offset[1] : avatarHips;
                for (int bone = 0; bone < DanceNative.Bones; ++bone)
                {
                    if (direction[bone].Length == 0) continue;
                    float* lower = offset + 3 * (bone + 1);  // limbs follow one another
                    var along = new DanceVector(lower[0], lower[1], lower[2]);
                    if (along.Length > 0.01f) direction[bone] = along.Normalized();
                }
            }
            Straighten();
        }

        // The avatar's bones for a dancer's pose. Fingers stay straight where hands.Presence is 0.
        public void Show(ref DancePose pose, ref DanceHands hands)
        {
            fixed (float* body = pose.Rotation, fingers = hands.Rotation)
            {
                for (int bone = 0; bone < DanceBones.Count; ++bone)
                {
                    int finger = bone - DanceNative.Bones;
                    float* q = finger < 0 ? body + 4 * bone : fingers + 4 * finger;
                    bool isSeen = finger < 0 || (hands.Presence >> finger & 1) != 0;
                    DanceRotation local = isSeen ? new DanceRotation(q[0], q[1], q[2], q[3]) : DanceRotation.Identity;
                    int parent = DanceBones.Parent[bone];
                    dance[bone] = parent < 0 ? local : dance[parent] * local;
                }
            }
            for (int bone = 0; bone < DanceBones.Count; ++bone)
                if (has[bone]) World[bone] = (dance[turnOf[bone]] * tPose[bone]).Normalized();
            fixed (float* hips = pose.HipsPosition)
                HipsPosition = new DanceVector(hips[0], Scale * hips[1], hips[2]);
        }

        // The way back: the pose and the fingers of an avatar whose bones are turned so, and whose
        // hips are there, in its root's space.
        public void Capture(DanceRotation[] world, DanceVector hips, ref DancePose pose, ref DanceHands hands)
        {
            pose.Presence = 0;
            hands.Presence = 0;
            fixed (float* body = pose.Rotation, fingers = hands.Rotation, at = pose.HipsPosition)
            {
                for (int bone = 0; bone < DanceBones.Count; ++bone)
                {
                    int parent = DanceBones.Parent[bone];
                    DanceRotation above = parent < 0 ? DanceRotation.Identity : dance[parent];
                    dance[bone] = has[bone] ? (world[bone] * tPose[bone].Inverse()).Normalized() : above;
                    DanceRotation local = (above.Inverse() * dance[bone]).Normalized();
                    int finger = bone - DanceNative.Bones;
                    float* q = finger < 0 ? body + 4 * bone : fingers + 4 * finger;
                    q[0] = local.X;
                    q[1] = local.Y;
                    q[2] = local.Z;
                    q[3] = local.W;
                    if (has[bone] && finger < 0) pose.Presence |= 1u << bone;
                    if (has[bone] && finger >= 0) hands.Presence |= 1u << finger;
                }
                at[0] = hips.X;
                at[1] = hips.Y;
                at[2] = hips.Z;
            }
        }

        // The avatar's proportions as a dancer's, for the way back. A bone that the rig lacks has no
        // length, but for the ends of the body, which get a usual one.
        public void Measure(ref DanceSkeleton skeleton)
        {
            fixed (float* offset = skeleton.Offset, tip = skeleton.Tip)
            {
                for (int bone = 0; bone < DanceNative.Bones; ++bone)
                {
                    int parent = DanceBones.Parent[bone];
                    DanceVector from = InTPose(bone);
                    offset[3 * bone] = parent < 0 ? 0 : from.X;
                    offset[3 * bone + 1] = from.Y;
                    offset[3 * bone + 2] = parent < 0 ? 0 : from.Z;
                }
                float size = avatarHips;  // of an adult 0.95 m
                for (int end = 0; end < DanceNative.Tips; ++end)
                {
                    int bone = DanceBones.TipBone[end];
                    DanceVector along = bone == DanceBones.Head ? new DanceVector(0, 0.2f * size, 0)
                        : bone == DanceBones.LeftHand ? new DanceVector(-0.19f * size, 0, 0)
                        : bone == DanceBones.RightHand ? new DanceVector(0.19f * size, 0, 0)
                        : new DanceVector(0, 0, 0.07f * size);
                    tip[3 * end] = along.X;
                    tip[3 * end + 1] = along.Y;
                    tip[3 * end + 2] = along.Z;
                }
            }
        }

        // From the parent's origin in T-pose: what is at rest, turned as its parent was straightened.
        private DanceVector InTPose(int bone)
        {
            int parent = DanceBones.Parent[bone];
            if (!has[bone]) return new DanceVector();
            while (parent >= 0 && !has[parent]) parent = DanceBones.Parent[parent];
            if (parent < 0) return restPosition[bone];
            DanceRotation straightened = tPose[parent] * rest[parent].Inverse();
            return straightened * (restPosition[bone] - restPosition[parent]);
        }

        // A rig without upper chest, or without both chests, carries shoulders and neck on the spine
        // that it has: that one takes the turn of all that is missing above it.
        private void ShareSpine()
        {
            int last = has[DanceBones.UpperChest] ? DanceBones.UpperChest
                : has[DanceBones.Chest] ? DanceBones.Chest
                : has[DanceBones.Spine] ? DanceBones.Spine : -1;
            if (last >= 0) turnOf[last] = DanceBones.UpperChest;
        }

        // tPose: each bone's rotation when the rig stands in the dancer's T-pose. Arms and legs are
        // turned to where the dancer's lie; hands and fingers go along; feet keep their soles on
        // the floor.
        private void Straighten()
        {
            for (int bone = 0; bone < DanceBones.Count; ++bone)
            {
                if (!has[bone]) continue;
                int parent = DanceBones.Parent[bone];
                while (parent >= 0 && !has[parent]) parent = DanceBones.Parent[parent];
                bool goesAlong = parent >= 0 && !IsFoot(bone);
                DanceRotation carry = goesAlong ? tPose[parent] * rest[parent].Inverse() : DanceRotation.Identity;
                DanceRotation turn = carry;
                if (direction[bone].Length > 0 && has[bone + 1])
                {
                    DanceVector lies = carry * (restPosition[bone + 1] - restPosition[bone]);
                    turn = DanceRotation.Between(lies, direction[bone]) * carry;
                }
                tPose[bone] = (turn * rest[bone]).Normalized();
            }
        }

        private static bool IsFoot(int bone)
        {
            return bone == DanceBones.LeftFoot || bone == DanceBones.LeftToes || bone == DanceBones.RightFoot ||
                   bone == DanceBones.RightToes;
        }
    }
}
