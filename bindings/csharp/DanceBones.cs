// The bones of dance_adapter.h by index: parents and the few that have a part of their own in
// retargeting. Body bones come first, then the 30 finger bones: 52 in all.
//
// Threads: constants only.
// Failure: none.
namespace DanceGraph
{
    public static class DanceBones
    {
        public const int Count = DanceNative.Bones + DanceNative.FingerBones;
        public const int Hips = 0, Spine = 1, Chest = 2, UpperChest = 3, Neck = 4, Head = 5;
        public const int LeftShoulder = 6, LeftUpperArm = 7, LeftLowerArm = 8, LeftHand = 9;
        public const int RightShoulder = 10, RightUpperArm = 11, RightLowerArm = 12, RightHand = 13;
        public const int LeftUpperLeg = 14, LeftLowerLeg = 15, LeftFoot = 16, LeftToes = 17;
        public const int RightUpperLeg = 18, RightLowerLeg = 19, RightFoot = 20, RightToes = 21;

        // -1 for the hips; of fingers, the finger's bone before, or that side's hand.
        public static readonly int[] Parent = MakeParents();

        // The bones whose ends the tips of a skeleton are, in their order.
        public static readonly int[] TipBone = { Head, LeftHand, RightHand, LeftToes, RightToes };

        private static int[] MakeParents()
        {
            int[] body = { -1, 0, 1, 2, 3, 4, 3, 6, 7, 8, 3, 10, 11, 12, 0, 14, 15, 16, 0, 18, 19, 20 };
            var all = new int[Count];
            body.CopyTo(all, 0);
            for (int finger = 0; finger < DanceNative.FingerBones; ++finger)
            {
                int hand = finger < DanceNative.FingerBones / 2 ? LeftHand : RightHand;
                all[body.Length + finger] = finger % 3 == 0 ? hand : body.Length + finger - 1;
            }
            return all;
        }
    }
}
