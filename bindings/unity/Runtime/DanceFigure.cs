// DanceFigure: one dancer of the stage and the avatar that shows it. DanceStage adds it to each
// avatar that it makes; other scripts find the dancer's id and the pose shown here.
//
// Units/frames: Unity's, in the space of the stage's Transform.
// Ownership:    the rig of its own GameObject.
// Threads:      Unity's main thread.
// Failure:      without a new pose the avatar stays as it was. Begin throws where the rig cannot be
//               posed; IsWhole is false once a script has destroyed the avatar's hips.
using UnityEngine;

namespace DanceGraph
{
    [DisallowMultipleComponent]
    public sealed class DanceFigure : MonoBehaviour
    {
        public const long Newest = 0;  // instead of a time
        private HumanoidRig rig;
        private DanceSkeleton skeleton;
        private DanceHands hands;
        // A field, as a fixed buffer in it can be read without a copy.
        [System.NonSerialized] public DancePose Shown;

        public string Guest { get; private set; }
        public uint Slot { get; private set; }
        // Of the last read; the avatar is shown from the first Ok on.
        public DanceStatus Status { get; private set; }

        internal GameObject Avatar { get; private set; }
        internal bool IsWhole { get { return rig != null && rig.HasHips; } }

        public void Begin(string guest, uint slot, Animator animator)
        {
            Avatar = gameObject;
            Guest = guest;
            Slot = slot;
            Status = DanceStatus.NoData;
            rig = new HumanoidRig(animator);
            Shown = DancePose.Make();
            skeleton = DanceSkeleton.Make();
            hands = DanceHands.Make();
        }

        public void Show(DanceAdapter adapter, Transform stage, long timeNs)
        {
            Status = timeNs == Newest ? adapter.Newest(Slot, ref Shown) : adapter.At(Slot, timeNs, ref Shown);
            if (Status != DanceStatus.Ok) return;
            if (adapter.Skeleton(Slot, ref skeleton) == DanceStatus.Ok) rig.Retarget.SetSkeleton(ref skeleton);
            DanceStatus fingers = adapter.Hands(Slot, ref hands);
            if (fingers == DanceStatus.NoData) hands.Presence = 0;  // Busy: as they were
            rig.Retarget.Show(ref Shown, ref hands);
            rig.Apply(stage);
        }
    }
}
