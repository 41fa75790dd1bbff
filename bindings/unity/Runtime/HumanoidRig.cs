// HumanoidRig: the bones of a Humanoid Animator as DanceRetarget wants them, and turned as it says.
//
// Units/frames: Unity's; what is given and taken is in the space of a stage's Transform.
// Ownership:    refers to the Animator's Transforms; nothing is allocated after construction.
// Threads:      Unity's main thread.
// Failure:      the constructor throws where the Animator is not Humanoid, or its bones are not in the scene.
//               Apply and Capture may be called while HasHips.
using System;
using System.Collections.Generic;
using UnityEngine;

namespace DanceGraph
{
    public sealed class HumanoidRig
    {
        public readonly DanceRetarget Retarget;
        private readonly Transform[] bones = new Transform[DanceBones.Count];
        private readonly DanceRotation[] captured = new DanceRotation[DanceBones.Count];

        private struct Rest
        {
            public Vector3 Position;
            public Quaternion Rotation;
            public Vector3 Scale;
        }

        public HumanoidRig(Animator animator)
        {
            if (animator == null || animator.avatar == null || !animator.isHuman)
                throw new ArgumentException("an avatar needs an Animator whose Rig is Humanoid");
            if (animator.GetBoneTransform(HumanBodyBones.Hips) == null)
                throw new ArgumentException(
                    "the avatar's bones are no objects of the scene: switch Optimize Game Objects off in its import settings");
            var has = new bool[DanceBones.Count];
            var position = new DanceVector[DanceBones.Count];
            var rotation = new DanceRotation[DanceBones.Count];
            // The T-pose that the avatar was configured with, and not how it happens to stand now.
            var tPose = new Dictionary<string, SkeletonBone>();
            foreach (SkeletonBone bone in animator.avatar.humanDescription.skeleton) tPose[bone.name] = bone;
            for (int bone = 0; bone < DanceBones.Count; ++bone)
            {
                bones[bone] = animator.GetBoneTransform(HumanBones[bone]);
                has[bone] = bones[bone] != null;
                if (!has[bone]) continue;
                Rest rest = RestOf(bones[bone], animator.transform, tPose);
                position[bone] = new DanceVector(rest.Position.x, rest.Position.y, rest.Position.z);
                rotation[bone] = From(rest.Rotation);
            }
            Retarget = new DanceRetarget(has, position, rotation);
        }

        // False once another script has destroyed them.
        public bool HasHips { get { return bones[DanceBones.Hips] != null; } }

        // Turns the avatar's bones to what Retarget says, and puts its hips there.
        public void Apply(Transform stage)
        {
            DanceVector hips = Retarget.HipsPosition;
            bones[DanceBones.Hips].position = stage.position + stage.rotation * new Vector3(hips.X, hips.Y, hips.Z);
            for (int bone = 0; bone < DanceBones.Count; ++bone)  // parents come first
                if (bones[bone] != null) bones[bone].rotation = stage.rotation * To(Retarget.World[bone]);
        }

        // How the avatar stands now, as a pose and fingers of a dancer.
        public void Capture(Transform stage, ref DancePose pose, ref DanceHands hands)
        {
            Quaternion toStage = Quaternion.Inverse(stage.rotation);
            for (int bone = 0; bone < DanceBones.Count; ++bone)
                if (bones[bone] != null) captured[bone] = From(toStage * bones[bone].rotation);
            Vector3 hips = toStage * (bones[DanceBones.Hips].position - stage.position);
            Retarget.Capture(captured, new DanceVector(hips.x, hips.y, hips.z), ref pose, ref hands);
        }

        private static Rest RestOf(Transform bone, Transform root, Dictionary<string, SkeletonBone> tPose)
        {
            if (bone == root || bone == null)
                return new Rest { Rotation = Quaternion.identity, Scale = root.lossyScale };
            Rest above = RestOf(bone.parent, root, tPose);
            Vector3 position = bone.localPosition, scale = bone.localScale;
            Quaternion rotation = bone.localRotation;
            SkeletonBone known;
            if (tPose.TryGetValue(bone.name, out known))
            {
                position = known.position;
                rotation = known.rotation;
                scale = known.scale;
            }
            return new Rest
            {
                Position = above.Position + above.Rotation * Vector3.Scale(above.Scale, position),
                Rotation = above.Rotation * rotation,
                Scale = Vector3.Scale(above.Scale, scale),
            };
        }

        private static DanceRotation From(Quaternion q) { return new DanceRotation(q.x, q.y, q.z, q.w); }
        private static Quaternion To(DanceRotation q) { return new Quaternion(q.X, q.Y, q.Z, q.W); }

        // In the order of dance_bone_name() and dance_finger_bone_name(). Unity calls a thumb's bones
        // proximal to distal where VRM 1 says metacarpal to distal.
        private static readonly HumanBodyBones[] HumanBones =
        {
            HumanBodyBones.Hips, HumanBodyBones.Spine, HumanBodyBones.Chest, HumanBodyBones.UpperChest,
            HumanBodyBones.Neck, HumanBodyBones.Head,
            HumanBodyBones.LeftShoulder, HumanBodyBones.LeftUpperArm, HumanBodyBones.LeftLowerArm,
            HumanBodyBones.LeftHand,
            HumanBodyBones.RightShoulder, HumanBodyBones.RightUpperArm, HumanBodyBones.RightLowerArm,
            HumanBodyBones.RightHand,
            HumanBodyBones.LeftUpperLeg, HumanBodyBones.LeftLowerLeg, HumanBodyBones.LeftFoot,
            HumanBodyBones.LeftToes,
            HumanBodyBones.RightUpperLeg, HumanBodyBones.RightLowerLeg, HumanBodyBones.RightFoot,
            HumanBodyBones.RightToes,
            HumanBodyBones.LeftThumbProximal, HumanBodyBones.LeftThumbIntermediate, HumanBodyBones.LeftThumbDistal,
            HumanBodyBones.LeftIndexProximal, HumanBodyBones.LeftIndexIntermediate, HumanBodyBones.LeftIndexDistal,
            HumanBodyBones.LeftMiddleProximal, HumanBodyBones.LeftMiddleIntermediate, HumanBodyBones.LeftMiddleDistal,
            HumanBodyBones.LeftRingProximal, HumanBodyBones.LeftRingIntermediate, HumanBodyBones.LeftRingDistal,
            HumanBodyBones.LeftLittleProximal, HumanBodyBones.LeftLittleIntermediate, HumanBodyBones.LeftLittleDistal,
            HumanBodyBones.RightThumbProximal, HumanBodyBones.RightThumbIntermediate, HumanBodyBones.RightThumbDistal,
            HumanBodyBones.RightIndexProximal, HumanBodyBones.RightIndexIntermediate, HumanBodyBones.RightIndexDistal,
            HumanBodyBones.RightMiddleProximal, HumanBodyBones.RightMiddleIntermediate,
            HumanBodyBones.RightMiddleDistal,
            HumanBodyBones.RightRingProximal, HumanBodyBones.RightRingIntermediate, HumanBodyBones.RightRingDistal,
            HumanBodyBones.RightLittleProximal, HumanBodyBones.RightLittleIntermediate,
            HumanBodyBones.RightLittleDistal,
        };
    }
}
