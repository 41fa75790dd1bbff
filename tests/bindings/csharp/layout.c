// Prints how the C compiler lays the structs of dance_adapter.h out, for LayoutTest.cs: the struct
// in C#, a field or `-` for the whole, its offset or the size.
#include <dance_adapter.h>
#include <stdio.h>

#define SIZE(name, type) printf(#name " - %zu\n", sizeof(type))
#define FIELD(name, type, field) printf(#name " " #field " %zu\n", offsetof(type, field))

int main(void) {
  SIZE(DanceGuest, dance_guest);
  FIELD(DanceGuest, dance_guest, struct_size);
  FIELD(DanceGuest, dance_guest, slot);
  FIELD(DanceGuest, dance_guest, id);
  FIELD(DanceGuest, dance_guest, newest_ns);
  FIELD(DanceGuest, dance_guest, has_skeleton);
  FIELD(DanceGuest, dance_guest, has_hands);
  FIELD(DanceGuest, dance_guest, generation);
  FIELD(DanceGuest, dance_guest, reserved);
  SIZE(DancePose, dance_pose);
  FIELD(DancePose, dance_pose, struct_size);
  FIELD(DancePose, dance_pose, kind);
  FIELD(DancePose, dance_pose, sequence);
  FIELD(DancePose, dance_pose, presence);
  FIELD(DancePose, dance_pose, confidence);
  FIELD(DancePose, dance_pose, hips_position);
  FIELD(DancePose, dance_pose, rotation);
  FIELD(DancePose, dance_pose, capture_ns);
  FIELD(DancePose, dance_pose, staged_ns);
  FIELD(DancePose, dance_pose, time_ns);
  FIELD(DancePose, dance_pose, music_beats);
  FIELD(DancePose, dance_pose, generation);
  FIELD(DancePose, dance_pose, reserved);
  SIZE(DanceHands, dance_hands);
  FIELD(DanceHands, dance_hands, struct_size);
  FIELD(DanceHands, dance_hands, presence);
  FIELD(DanceHands, dance_hands, rotation);
  FIELD(DanceHands, dance_hands, capture_ns);
  SIZE(DanceSkeleton, dance_skeleton);
  FIELD(DanceSkeleton, dance_skeleton, struct_size);
  FIELD(DanceSkeleton, dance_skeleton, version);
  FIELD(DanceSkeleton, dance_skeleton, offset);
  FIELD(DanceSkeleton, dance_skeleton, tip);
  SIZE(DanceWorld, dance_world);
  FIELD(DanceWorld, dance_world, struct_size);
  FIELD(DanceWorld, dance_world, reserved);
  FIELD(DanceWorld, dance_world, position);
  FIELD(DanceWorld, dance_world, rotation);
  FIELD(DanceWorld, dance_world, tip);
  SIZE(DanceBeat, dance_beat);
  FIELD(DanceBeat, dance_beat, struct_size);
  FIELD(DanceBeat, dance_beat, beats_per_bar);
  FIELD(DanceBeat, dance_beat, position_beats);
  FIELD(DanceBeat, dance_beat, tempo_bpm);
  FIELD(DanceBeat, dance_beat, confidence);
  FIELD(DanceBeat, dance_beat, playing);
  SIZE(DanceCounters, dance_counters);
  FIELD(DanceCounters, dance_counters, struct_size);
  FIELD(DanceCounters, dance_counters, reserved);
  FIELD(DanceCounters, dance_counters, reads);
  FIELD(DanceCounters, dance_counters, retries);
  FIELD(DanceCounters, dance_counters, busy);
  FIELD(DanceCounters, dance_counters, damaged);
  FIELD(DanceCounters, dance_counters, attached);
  return 0;
}
