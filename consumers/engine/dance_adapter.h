// dance_adapter.h: the dancers of a house for a game engine or any other program of this machine,
// through shared memory: newest poses, poses at a display's time, proportions, fingers, the beat;
// and the way back, an engine's own tracker as a dancer of the house. C declarations for every
// language that can call C; the library is libdance_adapter.so.
//
// Units/frames: metres, nanoseconds of CLOCK_MONOTONIC, beats. Axes are those that open() was
//               given: glTF's (right-handed, +Y up, a dancer in T-pose faces +Z), or an engine's.
//               Rotations are unit quaternions x, y, z, w: of each bone in its parent (hips: in the
//               stage), identity in T-pose.
// Ownership:    a handle is the caller's until close(); everything else is copied into the caller's
//               structs. No function but open() and close() allocates.
// Threads:      a handle belongs to one thread at a time; any number of handles, threads and
//               processes read one house. Memory is mapped read-only: a reader cannot stall or
//               damage the house, and never waits for it.
// Failure:      every function returns a dance_status (or a count) and never blocks. Without a
//               house the handle stays valid: it finds the house when it comes, and when it comes
//               back. A struct begins with its size as the caller knows it; fields are only ever
//               added at the end.
#ifndef DANCE_ADAPTER_H
#define DANCE_ADAPTER_H

#include <stddef.h>
#include <stdint.h>

#if defined(__GNUC__)
#define DANCE_API __attribute__((visibility("default")))
#else
#define DANCE_API
#endif

#ifdef __cplusplus
extern "C" {
#endif

#define DANCE_ADAPTER_ABI 1

#define DANCE_MAX_GUESTS 64
#define DANCE_BONES 22         // canonical order: hips, spine, … rightToes (dance_bone_name)
#define DANCE_FINGER_BONES 30  // left thumb to little, then right (dance_finger_bone_name)
#define DANCE_TIPS 5           // ends of head, left and right hand, left and right toes

typedef struct dance_adapter dance_adapter;    // a reader
typedef struct dance_producer dance_producer;  // the way back

typedef enum dance_status {
  DANCE_OK = 0,
  DANCE_NO_HOUSE = 1,       // nobody writes: not started yet, or ended
  DANCE_NO_GUEST = 2,       // this slot has no dancer
  DANCE_NO_DATA = 3,        // the dancer has none of this: no fingers, no music, no pose yet
  DANCE_BUSY = 4,           // overtaken by the writer in every try: use what you had
  DANCE_WRONG_VERSION = 5,  // the house has another version of the memory: update one of the two
  DANCE_DAMAGED = 6,        // the memory is not a house's
  DANCE_BAD_ARGUMENT = 7,   // NULL, a slot out of range, a wrong struct_size, an unfit name
  DANCE_INVALID = 8         // a pose to produce that is not finite, or not made of unit rotations
} dance_status;

typedef enum dance_axes {
  DANCE_AXES_GLTF = 0,    // glTF, VRM 1, OpenXR, Godot: right-handed, +Y up, faces +Z, metres
  DANCE_AXES_UNITY = 1,   // Unity: left-handed, +Y up, faces +Z, metres
  DANCE_AXES_UNREAL = 2,  // Unreal: left-handed, +Z up, faces +X, centimetres
  DANCE_AXES_BLENDER = 3  // Blender: right-handed, +Z up, faces -Y, metres
} dance_axes;

typedef struct dance_guest {
  uint32_t struct_size;
  uint32_t slot;          // the dancer's place in calls, kept while the dancer is there
  char id[32];            // a-z, 0-9 and '-', with a zero at the end
  int64_t newest_ns;      // when its newest pose came onto the stage
  uint32_t has_skeleton;  // its own proportions have come; else those of an average adult
  uint32_t has_hands;
  uint32_t generation;  // of the slot: another number is another dancer
  uint32_t reserved;
} dance_guest;

// How a pose was made.
typedef enum dance_pose_kind {
  DANCE_POSE_NEWEST = 0,        // as it came
  DANCE_POSE_INTERPOLATED = 1,  // between two that came
  DANCE_POSE_PREDICTED = 2,     // after the newest, at most DANCE_LONGEST_PREDICTION_NS
  DANCE_POSE_HELD = 3  // the time is too far from all there is: the oldest, or where the prediction
                       // came to rest
} dance_pose_kind;

#define DANCE_LONGEST_PREDICTION_NS 100000000  // 100 ms

typedef struct dance_pose {
  uint32_t struct_size;
  uint32_t kind;      // dance_pose_kind
  uint32_t sequence;  // of the captured pose that is nearest
  uint32_t presence;  // bit b: bone b was seen, else it is at its last or rest rotation
  float confidence;   // 0..1
  float hips_position[3];
  float rotation[DANCE_BONES][4];  // x, y, z, w in the parent
  // When the motion was captured, in this machine's clock; the stage's time where the pose has the
  // times of another clock. Predicted: as far after the newest as staged_ns.
  int64_t capture_ns;
  // When the pose came onto this house's stage; of a predicted one mostly in the future.
  int64_t staged_ns;
  int64_t time_ns;      // the stage's time that it shows: staged_ns, or the one asked for
  double music_beats;   // where the dancer's music stood; NaN without
  uint32_t generation;  // of the slot: another number is another dancer
  uint32_t reserved;
} dance_pose;

typedef struct dance_hands {
  uint32_t struct_size;
  uint32_t presence;
  float rotation[DANCE_FINGER_BONES][4];
  int64_t capture_ns;
} dance_hands;

typedef struct dance_skeleton {
  uint32_t struct_size;
  uint32_t version;              // grows with each change
  float offset[DANCE_BONES][3];  // from the parent's origin in T-pose; hips: above the floor
  float tip[DANCE_TIPS][3];
} dance_skeleton;

typedef struct dance_world {
  uint32_t struct_size;
  uint32_t reserved;
  float position[DANCE_BONES][3];
  float rotation[DANCE_BONES][4];
  float tip[DANCE_TIPS][3];
} dance_world;

typedef struct dance_beat {
  uint32_t struct_size;
  uint32_t beats_per_bar;  // 0 = unknown
  double position_beats;   // of the music that is heard here, at the time asked for
  double tempo_bpm;
  float confidence;  // 0..1
  uint32_t playing;
} dance_beat;

typedef struct dance_counters {
  uint32_t struct_size;
  uint32_t reserved;
  uint64_t reads;
  uint64_t retries;   // overtaken by the writer, and read again
  uint64_t busy;      // calls that returned DANCE_BUSY
  uint64_t damaged;   // contents that were not valid, and were ignored
  uint64_t attached;  // times that a house was found
} dance_counters;

// The version of the library; compare it with DANCE_ADAPTER_ABI.
DANCE_API uint32_t dance_adapter_abi(void);
// CLOCK_MONOTONIC: the clock of all times here.
DANCE_API int64_t dance_adapter_now_ns(void);
// "hips" … "rightToes"; NULL out of range. Parents: -1 for the hips; of fingers -1 for the side's
// hand.
DANCE_API const char* dance_bone_name(uint32_t bone);
DANCE_API int32_t dance_bone_parent(uint32_t bone);
DANCE_API const char* dance_finger_bone_name(uint32_t bone);
DANCE_API int32_t dance_finger_bone_parent(uint32_t bone);
DANCE_API const char* dance_status_text(dance_status status);

// A reader of the house with that name (NULL or "" = "stage", the usual one). NULL where the name
// is unfit (1 to 24 characters of a-z, 0-9 and '-') or memory is out. There need be no house yet.
DANCE_API dance_adapter* dance_adapter_open(const char* name, dance_axes axes);
DANCE_API void dance_adapter_close(dance_adapter* adapter);
// DANCE_OK while a house writes. Looks for one at most ten times a second; also done by all calls
// below.
DANCE_API dance_status dance_adapter_state(dance_adapter* adapter);
// Fills at most `capacity` guests (struct_size set in the first) and returns how many there are.
DANCE_API uint32_t dance_adapter_guests(dance_adapter* adapter, dance_guest* guests,
                                        uint32_t capacity);
// The slot of a guest by id.
DANCE_API dance_status dance_adapter_find(dance_adapter* adapter, const char* id, uint32_t* slot);
DANCE_API dance_status dance_adapter_newest(dance_adapter* adapter, uint32_t slot,
                                            dance_pose* pose);
// The pose to show at a time, such as that of the frame's display: interpolated, or predicted
// beyond the newest, for at most DANCE_LONGEST_PREDICTION_NS, at whose end the motion comes to
// rest. Times are the stage's: a dancer captured at c and shown since s is asked for with s.
DANCE_API dance_status dance_adapter_at(dance_adapter* adapter, uint32_t slot, int64_t time_ns,
                                        dance_pose* pose);
DANCE_API dance_status dance_adapter_skeleton(dance_adapter* adapter, uint32_t slot,
                                              dance_skeleton* skeleton);
DANCE_API dance_status dance_adapter_hands(dance_adapter* adapter, uint32_t slot,
                                           dance_hands* hands);
DANCE_API dance_status dance_adapter_beat(dance_adapter* adapter, int64_t time_ns,
                                          dance_beat* beat);
DANCE_API dance_status dance_adapter_counters(dance_adapter* adapter, dance_counters* counters);
// Where every bone is: forward kinematics of a pose and a skeleton in the same axes.
DANCE_API dance_status dance_world_of(const dance_skeleton* skeleton, const dance_pose* pose,
                                      dance_world* world);

// The way back: poses of an engine's own tracker become captures of a guest in the house whose
// receiver has that name (`dance receive --from engine`, or [[produce]] kind = "engine"). Each is
// one datagram to a socket of this user's alone; none waits, and without a house they are dropped
// (DANCE_NO_HOUSE).
DANCE_API dance_producer* dance_producer_open(const char* name, dance_axes axes);
DANCE_API void dance_producer_close(dance_producer* producer);
DANCE_API dance_status dance_producer_skeleton(dance_producer* producer,
                                               const dance_skeleton* skeleton);
// capture_ns = 0 is now. sequence, staged_ns, time_ns, kind and music_beats are ignored.
DANCE_API dance_status dance_producer_pose(dance_producer* producer, const dance_pose* pose);
DANCE_API dance_status dance_producer_hands(dance_producer* producer, const dance_hands* hands);

#ifdef __cplusplus
}
#endif

#endif
