// The part of UnityEngine that bindings/unity calls, as far as its documented behaviour goes:
// a tree of Transforms, GameObjects with components, a Humanoid Animator. Unity itself is not here;
// against this the components are compiled, and run on a rig of Transforms.
using System;
using System.Collections.Generic;

namespace UnityEngine
{
    [AttributeUsage(AttributeTargets.Class)]
    public sealed class AddComponentMenu : Attribute { public AddComponentMenu(string name) { } }
    [AttributeUsage(AttributeTargets.Class)]
    public sealed class DefaultExecutionOrder : Attribute { public DefaultExecutionOrder(int order) { } }
    [AttributeUsage(AttributeTargets.Class)]
    public sealed class DisallowMultipleComponent : Attribute { }
    [AttributeUsage(AttributeTargets.Class)]
    public sealed class RequireComponent : Attribute { public RequireComponent(Type type) { } }
    [AttributeUsage(AttributeTargets.Field)]
    public sealed class TooltipAttribute : Attribute { public TooltipAttribute(string text) { } }
    [AttributeUsage(AttributeTargets.Field)]
    public sealed class RangeAttribute : Attribute { public RangeAttribute(float low, float high) { } }

    [Flags]
    public enum HideFlags { None = 0, HideAndDontSave = 61 }

    public static class Debug
    {
        public static int Errors, Warnings;
        public static void LogError(object text, Object who) { ++Errors; Console.WriteLine("error: " + text); }
        public static void LogWarning(object text, Object who) { ++Warnings; Console.WriteLine("warning: " + text); }
    }

    public static class Time { public static float unscaledTime { get; set; } }

    public struct Vector3
    {
        public float x, y, z;
        public Vector3(float x, float y, float z) { this.x = x; this.y = y; this.z = z; }
        public static Vector3 zero { get { return new Vector3(); } }
        public static Vector3 one { get { return new Vector3(1, 1, 1); } }
        public static Vector3 operator +(Vector3 a, Vector3 b) { return new Vector3(a.x + b.x, a.y + b.y, a.z + b.z); }
        public static Vector3 operator -(Vector3 a, Vector3 b) { return new Vector3(a.x - b.x, a.y - b.y, a.z - b.z); }
        public static Vector3 Scale(Vector3 a, Vector3 b) { return new Vector3(a.x * b.x, a.y * b.y, a.z * b.z); }
    }

    public struct Quaternion
    {
        public float x, y, z, w;
        public Quaternion(float x, float y, float z, float w) { this.x = x; this.y = y; this.z = z; this.w = w; }
        public static Quaternion identity { get { return new Quaternion(0, 0, 0, 1); } }
        public static Quaternion Inverse(Quaternion q) { return new Quaternion(-q.x, -q.y, -q.z, q.w); }
        public static Quaternion operator *(Quaternion a, Quaternion b)
        {
            return new Quaternion(a.w * b.x + a.x * b.w + a.y * b.z - a.z * b.y,
                                  a.w * b.y + a.y * b.w + a.z * b.x - a.x * b.z,
                                  a.w * b.z + a.z * b.w + a.x * b.y - a.y * b.x,
                                  a.w * b.w - a.x * b.x - a.y * b.y - a.z * b.z);
        }
        public static Vector3 operator *(Quaternion q, Vector3 v)
        {
            Quaternion turned = q * new Quaternion(v.x, v.y, v.z, 0) * Inverse(q);
            return new Vector3(turned.x, turned.y, turned.z);
        }
    }

    public class Object
    {
        public string name = "";
        public HideFlags hideFlags;
        internal bool isDestroyed;

        // A destroyed object equals null, as in Unity.
        public static bool operator ==(Object a, Object b)
        {
            bool aIsNull = ReferenceEquals(a, null) || a.isDestroyed, bIsNull = ReferenceEquals(b, null) || b.isDestroyed;
            return aIsNull && bIsNull || !aIsNull && !bIsNull && ReferenceEquals(a, b);
        }
        public static bool operator !=(Object a, Object b) { return !(a == b); }
        public override bool Equals(object other) { return this == other as Object; }
        public override int GetHashCode() { return 0; }

        public static void Destroy(Object one)
        {
            var made = one as GameObject;
            if (made != null)
            {
                made.transform.parent = null;
                foreach (Component component in made.components) component.isDestroyed = true;
            }
            one.isDestroyed = true;
        }

        // Objects of Transforms and Animators only: what a prefab is here.
        public static GameObject Instantiate(GameObject prefab, Transform parent)
        {
            var copies = new Dictionary<Transform, Transform>();
            GameObject made = Copy(prefab.transform, parent, copies).gameObject;
            var animator = prefab.GetComponent<Animator>();
            if (animator != null) made.AddComponent<Animator>().CopyOf(animator, copies);
            return made;
        }

        private static Transform Copy(Transform from, Transform parent, Dictionary<Transform, Transform> copies)
        {
            Transform to = new GameObject(from.name).transform;
            to.parent = parent;
            to.localPosition = from.localPosition;
            to.localRotation = from.localRotation;
            to.localScale = from.localScale;
            copies[from] = to;
            foreach (Transform child in from.children) Copy(child, to, copies);
            return to;
        }
    }

    public class Component : Object
    {
        public GameObject gameObject { get; internal set; }
        public Transform transform { get { return gameObject.transform; } }
        public T GetComponent<T>() where T : Component { return gameObject.GetComponent<T>(); }
    }

    public class Behaviour : Component
    {
        public bool enabled { get; set; }
        public Behaviour() { enabled = true; }
    }

    public class MonoBehaviour : Behaviour { }

    public sealed class GameObject : Object
    {
        internal readonly List<Component> components = new List<Component>();
        public Transform transform { get; private set; }

        public GameObject(string name)
        {
            this.name = name;
            transform = AddComponent<Transform>();
            transform.name = name;
        }

        public T AddComponent<T>() where T : Component, new()
        {
            var made = new T();
            made.gameObject = this;
            made.name = name;
            components.Add(made);
            return made;
        }

        public T GetComponent<T>() where T : Component
        {
            foreach (Component one in components)
                if (one is T) return (T)one;
            return null;
        }

        public T GetComponentInChildren<T>() where T : Component
        {
            T found = GetComponent<T>();
            foreach (Transform child in transform.children)
                if (found == null) found = child.gameObject.GetComponentInChildren<T>();
            return found;
        }
    }

    public sealed class Transform : Component
    {
        internal readonly List<Transform> children = new List<Transform>();
        private Transform above;

        public Vector3 localPosition = Vector3.zero;
        public Quaternion localRotation = Quaternion.identity;
        public Vector3 localScale = Vector3.one;

        public Transform parent
        {
            get { return above; }
            set
            {
                if (!ReferenceEquals(above, null)) above.children.Remove(this);
                above = value;
                if (!ReferenceEquals(above, null)) above.children.Add(this);
            }
        }

        public Vector3 lossyScale
        {
            get { return above == null ? localScale : Vector3.Scale(above.lossyScale, localScale); }
        }

        public Quaternion rotation
        {
            get { return above == null ? localRotation : above.rotation * localRotation; }
            set { localRotation = above == null ? value : Quaternion.Inverse(above.rotation) * value; }
        }

        public Vector3 position
        {
            get
            {
                if (above == null) return localPosition;
                return above.position + above.rotation * Vector3.Scale(above.lossyScale, localPosition);
            }
            set
            {
                if (above == null)
                {
                    localPosition = value;
                    return;
                }
                Vector3 inParent = Quaternion.Inverse(above.rotation) * (value - above.position), s = above.lossyScale;
                localPosition = new Vector3(inParent.x / s.x, inParent.y / s.y, inParent.z / s.z);
            }
        }
    }

    public struct SkeletonBone
    {
        public string name;
        public Vector3 position;
        public Quaternion rotation;
        public Vector3 scale;
    }

    public struct HumanDescription { public SkeletonBone[] skeleton; }

    public sealed class Avatar : Object { public HumanDescription humanDescription; }

    public sealed class Animator : Behaviour
    {
        public Avatar avatar;
        public bool isHuman { get { return avatar != null; } }
        public readonly Dictionary<HumanBodyBones, Transform> bones = new Dictionary<HumanBodyBones, Transform>();

        public Transform GetBoneTransform(HumanBodyBones bone)
        {
            Transform found;
            return bones.TryGetValue(bone, out found) ? found : null;
        }

        internal void CopyOf(Animator other, Dictionary<Transform, Transform> copies)
        {
            avatar = other.avatar;
            foreach (var bone in other.bones) bones[bone.Key] = copies[bone.Value];
        }
    }

    public enum HumanBodyBones
    {
        Hips = 0, LeftUpperLeg, RightUpperLeg, LeftLowerLeg, RightLowerLeg, LeftFoot, RightFoot, Spine, Chest, Neck,
        Head, LeftShoulder, RightShoulder, LeftUpperArm, RightUpperArm, LeftLowerArm, RightLowerArm, LeftHand,
        RightHand, LeftToes, RightToes, LeftEye, RightEye, Jaw,
        LeftThumbProximal, LeftThumbIntermediate, LeftThumbDistal, LeftIndexProximal, LeftIndexIntermediate,
        LeftIndexDistal, LeftMiddleProximal, LeftMiddleIntermediate, LeftMiddleDistal, LeftRingProximal,
        LeftRingIntermediate, LeftRingDistal, LeftLittleProximal, LeftLittleIntermediate, LeftLittleDistal,
        RightThumbProximal, RightThumbIntermediate, RightThumbDistal, RightIndexProximal, RightIndexIntermediate,
        RightIndexDistal, RightMiddleProximal, RightMiddleIntermediate, RightMiddleDistal, RightRingProximal,
        RightRingIntermediate, RightRingDistal, RightLittleProximal, RightLittleIntermediate, RightLittleDistal,
        UpperChest, LastBone,
    }
}
