// DanceProducer: the way back. Put it beside a Humanoid Animator that a tracker moves, such as a VR
// player's body: each frame its pose becomes a capture of the guest whose house runs
// `dance receive --from engine --guest <guest>` or has [[produce]] kind = "engine".
//
// Units/frames: Unity's; the dancer's place is taken in the space of `stage`.
// Ownership:    its connection, while enabled.
// Threads:      Unity's main thread; sending never waits.
// Failure:      no library, an unfit name or no Humanoid: one error in the console, and the component
//               is disabled. Without a house poses are dropped, and Status says so.
using System;
using UnityEngine;

namespace DanceGraph
{
    [AddComponentMenu("DanceGraph/Dance Producer")]
    [DefaultExecutionOrder(10001)]
    [RequireComponent(typeof(Animator))]
    public sealed class DanceProducer : MonoBehaviour
    {
        [Tooltip("Name of the house's receiver. Empty is the usual one.")]
        public string receiverName = "";
        [Tooltip("The middle of the dance floor, usually the DanceStage; empty is the scene's origin.")]
        public Transform stage;
        [Range(0f, 1f)]
        public float confidence = 1f;

        private const float SkeletonEverySeconds = 1f;
        private DancePoseSender sender;
        private HumanoidRig rig;
        private DancePose pose;
        private DanceHands hands;
        private DanceSkeleton skeleton;
        private float nextSkeleton;
        private Transform origin;

        public DanceStatus Status { get; private set; }

        private void OnEnable()
        {
            try
            {
                rig = new HumanoidRig(GetComponent<Animator>());
                sender = new DancePoseSender(receiverName, DanceAxes.Unity);
            }
            catch (Exception problem)
            {
                Debug.LogError("DanceGraph: " + problem.Message, this);
                enabled = false;
                return;
            }
            pose = DancePose.Make();
            hands = DanceHands.Make();
            skeleton = DanceSkeleton.Make();
            rig.Retarget.Measure(ref skeleton);
            skeleton.Version = 1;
            nextSkeleton = 0;
            if (origin == null)
            {
                origin = new GameObject("DanceGraph origin").transform;
                origin.gameObject.hideFlags = HideFlags.HideAndDontSave;
            }
        }

        private void OnDisable()
        {
            if (sender != null) sender.Dispose();
            sender = null;
            if (origin != null) Destroy(origin.gameObject);
            origin = null;
        }

        private void LateUpdate()
        {
            if (sender == null) return;
            if (!rig.HasHips)
            {
                Debug.LogError("DanceGraph: the avatar's hips were destroyed", this);
                enabled = false;
                return;
            }
            rig.Capture(stage != null ? stage : origin, ref pose, ref hands);
            pose.Confidence = confidence;
            pose.CaptureNs = 0;  // now
            if (Time.unscaledTime >= nextSkeleton)
            {
                nextSkeleton = Time.unscaledTime + SkeletonEverySeconds;
                sender.Skeleton(ref skeleton);
            }
            Status = sender.Pose(ref pose);
            if (hands.Presence != 0) sender.Hands(ref hands);
        }
    }
}
