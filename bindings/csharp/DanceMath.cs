// Vectors and rotations for DanceRetarget, so that it needs no engine and no package.
//
// Units/frames: as the caller's; the formulas hold in left-handed and in right-handed axes.
// Ownership:    plain values.
// Threads:      none inside.
// Failure:      Normalized() of what has no length is the identity (rotations) or zero (vectors).
using System;

namespace DanceGraph
{
    public struct DanceVector
    {
        public float X, Y, Z;

        public DanceVector(float x, float y, float z)
        {
            X = x;
            Y = y;
            Z = z;
        }

        public static DanceVector operator +(DanceVector a, DanceVector b)
        {
            return new DanceVector(a.X + b.X, a.Y + b.Y, a.Z + b.Z);
        }

        public static DanceVector operator -(DanceVector a, DanceVector b)
        {
            return new DanceVector(a.X - b.X, a.Y - b.Y, a.Z - b.Z);
        }

        public static DanceVector operator *(float s, DanceVector a)
        {
            return new DanceVector(s * a.X, s * a.Y, s * a.Z);
        }

        public static float Dot(DanceVector a, DanceVector b)
        {
            return a.X * b.X + a.Y * b.Y + a.Z * b.Z;
        }

        public static DanceVector Cross(DanceVector a, DanceVector b)
        {
            return new DanceVector(a.Y * b.Z - a.Z * b.Y, a.Z * b.X - a.X * b.Z, a.X * b.Y - a.Y * b.X);
        }

        public float Length { get { return (float)Math.Sqrt(Dot(this, this)); } }

        public DanceVector Normalized()
        {
            float length = Length;
            return length > 1e-6f ? (1 / length) * this : new DanceVector();
        }
    }

    public struct DanceRotation
    {
        public float X, Y, Z, W;

        public DanceRotation(float x, float y, float z, float w)
        {
            X = x;
            Y = y;
            Z = z;
            W = w;
        }

        public static readonly DanceRotation Identity = new DanceRotation(0, 0, 0, 1);

        // First b, then a.
        public static DanceRotation operator *(DanceRotation a, DanceRotation b)
        {
            return new DanceRotation(
                a.W * b.X + a.X * b.W + a.Y * b.Z - a.Z * b.Y,
                a.W * b.Y - a.X * b.Z + a.Y * b.W + a.Z * b.X,
                a.W * b.Z + a.X * b.Y - a.Y * b.X + a.Z * b.W,
                a.W * b.W - a.X * b.X - a.Y * b.Y - a.Z * b.Z);
        }

        public static DanceVector operator *(DanceRotation q, DanceVector v)
        {
            var u = new DanceVector(q.X, q.Y, q.Z);
            DanceVector t = 2 * DanceVector.Cross(u, v);
            return v + q.W * t + DanceVector.Cross(u, t);
        }

        public DanceRotation Inverse() { return new DanceRotation(-X, -Y, -Z, W); }

        public DanceRotation Normalized()
        {
            float length = (float)Math.Sqrt(X * X + Y * Y + Z * Z + W * W);
            if (!(length > 1e-6f)) return Identity;
            float s = 1 / length;
            return new DanceRotation(s * X, s * Y, s * Z, s * W);
        }

        // The shortest turn that brings one direction to another; none where either has no length.
        public static DanceRotation Between(DanceVector from, DanceVector to)
        {
            DanceVector a = from.Normalized(), b = to.Normalized();
            if (a.Length == 0 || b.Length == 0) return Identity;
            float cosine = DanceVector.Dot(a, b);
            if (cosine < -0.99999f)
            {
                // Half a turn: about any axis across.
                DanceVector across = DanceVector.Cross(a, Math.Abs(a.X) < 0.8f ? new DanceVector(1, 0, 0)
                                                                               : new DanceVector(0, 1, 0));
                across = across.Normalized();
                return new DanceRotation(across.X, across.Y, across.Z, 0);
            }
            DanceVector axis = DanceVector.Cross(a, b);
            return new DanceRotation(axis.X, axis.Y, axis.Z, 1 + cosine).Normalized();
        }
    }
}
