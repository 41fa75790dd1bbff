// The way back from C#: NAME SECONDS. A tracker's dancer with the left arm lowered, who walks along the stage's +X, which is
// Unity's -X: said in Unity's axes.
using System;
using System.Globalization;
using System.Threading;
using DanceGraph;

public static unsafe class SendDancer
{
    public static int Main(string[] arguments)
    {
        double seconds = double.Parse(arguments[1], CultureInfo.InvariantCulture);
        int sent = 0;
        using (var sender = new DancePoseSender(arguments[0], DanceAxes.Unity))
        {
            DancePose pose = DancePose.Make();
            for (int bone = 0; bone < DanceNative.Bones; ++bone) pose.Rotation[4 * bone + 3] = 1;
            pose.Rotation[4 * DanceBones.LeftUpperArm + 2] = (float)Math.Sin(0.6);
            pose.Rotation[4 * DanceBones.LeftUpperArm + 3] = (float)Math.Cos(0.6);
            pose.Presence = (1u << DanceNative.Bones) - 1;
            pose.Confidence = 1;
            pose.HipsPosition[1] = 0.9f;
            long end = DanceAdapter.NowNs + (long)(seconds * 1e9);
            while (DanceAdapter.NowNs < end)
            {
                pose.HipsPosition[0] = -0.001f * (sent % 500);
                if (sender.Pose(ref pose) == DanceStatus.Ok) ++sent;
                Thread.Sleep(16);
            }
        }
        Console.WriteLine("sent " + sent);
        return 0;
    }
}
