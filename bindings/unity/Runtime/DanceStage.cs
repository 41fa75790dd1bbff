// DanceStage: the dancers of a DanceGraph house in this scene. Avatars are made when guests come and
// destroyed when they leave; each frame they are posed as late as Unity allows, for the time at
// which the frame will be seen. Put it on an empty GameObject: that is the middle of the dance floor.
//
// Units/frames: Unity's; dancers move in the space of this Transform (its scale is not used).
// Ownership:    the avatars that it made.
// Threads:      Unity's main thread. Reading never waits for the house.
// Failure:      no library or an unfit name: one error in the console, and the component is disabled.
//               No house: no avatars, until one comes. A prefab that cannot be posed is named once
//               in the console and not tried again until the component is enabled again; its guests
//               are not shown, the others are. An avatar that another script destroys is made anew.
using System;
using System.Collections.Generic;
using UnityEngine;

namespace DanceGraph
{
    [AddComponentMenu("DanceGraph/Dance Stage")]
    [DefaultExecutionOrder(10000)]
    public sealed class DanceStage : MonoBehaviour
    {
        [Tooltip("Name of the house's memory: [[listen]] to = \"engine\", name = … Empty is the usual one.")]
        public string houseName = "";
        [Tooltip("Humanoid prefabs. A guest gets one of them by its id, the same each time.")]
        public GameObject[] avatars = new GameObject[0];
        [Tooltip("This guest is not shown: the dancer whose own body is in the scene already.")]
        public string exceptGuest = "";
        [Tooltip("How long after LateUpdate a frame is seen, in milliseconds: about one and a half frames. " +
                 "Below 0 the newest poses are shown as they came.")]
        [Range(-1f, 100f)]
        public float displayLeadMs = 25f;

        private DanceAdapter adapter;
        private readonly DanceGuest[] guests = new DanceGuest[DanceNative.MaxGuests];
        private readonly List<DanceFigure> figures = new List<DanceFigure>(DanceNative.MaxGuests);
        private readonly bool[] isHere = new bool[2 * DanceNative.MaxGuests];  // who leaves and who comes
        private string refused = "";
        private readonly List<GameObject> unfit = new List<GameObject>();  // prefabs that cannot be posed

        public IList<DanceFigure> Figures { get { return figures; } }
        public DanceAdapter Adapter { get { return adapter; } }

        private void OnEnable()
        {
            unfit.Clear();
            refused = "";
            try
            {
                adapter = new DanceAdapter(houseName, DanceAxes.Unity);
            }
            catch (Exception problem)
            {
                Debug.LogError("DanceGraph: " + problem.Message, this);
                enabled = false;
            }
        }

        private void OnDisable()
        {
            for (int i = figures.Count - 1; i >= 0; --i) Remove(i);
            if (adapter != null) adapter.Dispose();
            adapter = null;
        }

        // After animation and scripts, before rendering.
        private void LateUpdate()
        {
            if (adapter == null) return;
            MeetGuests(adapter.Guests(guests));
            long seenAt = displayLeadMs < 0 ? DanceFigure.Newest : DanceAdapter.NowNs + (long)(displayLeadMs * 1e6f);
            for (int i = 0; i < figures.Count; ++i) figures[i].Show(adapter, transform, seenAt);
        }

        private void MeetGuests(int count)
        {
            Array.Clear(isHere, 0, isHere.Length);
            for (int g = 0; g < count; ++g)
            {
                int figure = FigureOf(ref guests[g]);
                if (figure < 0) figure = Add(ref guests[g]);
                if (figure >= 0) isHere[figure] = true;
            }
            for (int i = figures.Count - 1; i >= 0; --i)
                if (!isHere[i]) Remove(i);
        }

        private int FigureOf(ref DanceGuest guest)
        {
            for (int i = 0; i < figures.Count; ++i)
                if (figures[i] != null && figures[i].IsWhole && figures[i].Slot == guest.Slot &&
                    guest.IsNamed(figures[i].Guest))
                    return i;
            return -1;
        }

        private int Add(ref DanceGuest guest)
        {
            if (exceptGuest.Length > 0 && guest.IsNamed(exceptGuest)) return -1;
            if (avatars.Length == 0) return Refuse("no avatar: put a Humanoid prefab into DanceStage's Avatars");
            string id = guest.Name;
            GameObject prefab = avatars[AvatarOf(id) % avatars.Length];
            if (prefab == null) return Refuse("an entry of DanceStage's Avatars is empty");
            if (unfit.Contains(prefab)) return -1;
            Animator rig = prefab.GetComponentInChildren<Animator>();
            if (rig == null || !rig.isHuman) return Refuse(prefab.name + " has no Animator whose Rig is Humanoid");
            GameObject made = Instantiate(prefab, transform);
            made.name = "dancer " + id;
            made.transform.localPosition = Vector3.zero;
            made.transform.localRotation = Quaternion.identity;
            var figure = made.AddComponent<DanceFigure>();
            try
            {
                figure.Begin(id, guest.Slot, made.GetComponentInChildren<Animator>());
            }
            catch (Exception problem)
            {
                Destroy(made);
                unfit.Add(prefab);
                return Refuse(prefab.name + ": " + problem.Message);
            }
            figures.Add(figure);
            return figures.Count - 1;
        }

        private void Remove(int figure)
        {
            GameObject made = figures[figure].Avatar;
            if (made != null) Destroy(made);  // also where only its DanceFigure was destroyed
            figures.RemoveAt(figure);
        }

        // Says it once, and not in every frame.
        private int Refuse(string why)
        {
            if (refused != why) Debug.LogWarning("DanceGraph: " + why, this);
            refused = why;
            return -1;
        }

        // FNV-1a: the same for an id on every machine, which string.GetHashCode is not.
        private static int AvatarOf(string id)
        {
            uint hash = 2166136261;
            foreach (char letter in id) hash = unchecked((hash ^ letter) * 16777619);
            return (int)(hash & 0x7fffffff);
        }
    }
}
