// The plug-in for Godot 3: the functions of dance_adapter.h for GDScript, called through
// GDNative.call_native("standard_varcall", …). dance_adapter.gd wraps them.
//
// Handles are small numbers and are checked, as a script can pass anything. Results are lists that
// begin with the dance_status.
#include <dance_adapter.h>
#include <math.h>

#include "bindings/godot/godot_values.h"

#define HANDLES 16
#define FN __attribute__((visibility("default")))

const godot_api* godot;
static dance_adapter* adapters[HANDLES];
static dance_producer* producers[HANDLES];

FN void godot_gdnative_init(const godot_init_options* options);
FN void godot_gdnative_terminate(const void* options);
void godot_gdnative_init(const godot_init_options* options) { godot = options->api; }
void godot_gdnative_terminate(const void* options) {
  (void)options;
  for (int i = 0; i < HANDLES; ++i) {
    if (adapters[i]) dance_adapter_close(adapters[i]);
    if (producers[i]) dance_producer_close(producers[i]);
    adapters[i] = NULL;
    producers[i] = NULL;
  }
}

static bool is_handle(int64_t handle) { return handle >= 0 && handle < HANDLES; }

static dance_adapter* adapter_of(const godot_array* arguments) {
  const int64_t handle = int_argument(arguments, 0);
  return is_handle(handle) ? adapters[handle] : NULL;
}

static dance_producer* producer_of(const godot_array* arguments) {
  const int64_t handle = int_argument(arguments, 0);
  return is_handle(handle) ? producers[handle] : NULL;
}

static uint32_t slot_of(const godot_array* arguments) {
  const int64_t slot = int_argument(arguments, 1);
  return slot >= 0 && slot < DANCE_MAX_GUESTS ? (uint32_t)slot : DANCE_MAX_GUESTS;
}

#define FUNCTION(name)                           \
  FN godot_variant name(godot_array* arguments); \
  godot_variant name(godot_array* arguments)

// () -> nanoseconds of CLOCK_MONOTONIC
FUNCTION(dance_now) {
  (void)arguments;
  return result_of_int(dance_adapter_now_ns());
}

// (status) -> text
FUNCTION(dance_text) {
  return result_of_text(dance_status_text((dance_status)int_argument(arguments, 0)));
}

// (name) -> handle, or -1 where the name is unfit, the library of another version, or 16 are open
FUNCTION(dance_open) {
  char name[64];
  text_argument(arguments, 0, name, sizeof name);
  if (dance_adapter_abi() != DANCE_ADAPTER_ABI) return result_of_int(-1);
  for (int i = 0; i < HANDLES; ++i) {
    if (adapters[i]) continue;
    adapters[i] = dance_adapter_open(name, DANCE_AXES_GLTF);
    return result_of_int(adapters[i] ? i : -1);
  }
  return result_of_int(-1);
}

// (handle)
FUNCTION(dance_close) {
  const int64_t handle = int_argument(arguments, 0);
  if (is_handle(handle) && adapters[handle]) {
    dance_adapter_close(adapters[handle]);
    adapters[handle] = NULL;
  }
  return result_of_int(0);
}

// (handle) -> status
FUNCTION(dance_state) {
  dance_adapter* adapter = adapter_of(arguments);
  return result_of_int(adapter ? dance_adapter_state(adapter) : DANCE_BAD_ARGUMENT);
}

// (handle) -> [id, slot, has_skeleton, has_hands, generation, id, …]
FUNCTION(dance_guests) {
  static dance_guest guests[DANCE_MAX_GUESTS];
  dance_adapter* adapter = adapter_of(arguments);
  godot_array list = make_list();
  guests[0].struct_size = sizeof(dance_guest);
  uint32_t count = adapter ? dance_adapter_guests(adapter, guests, DANCE_MAX_GUESTS) : 0;
  if (count > DANCE_MAX_GUESTS) count = DANCE_MAX_GUESTS;
  for (uint32_t i = 0; i < count; ++i) {
    append_text(&list, guests[i].id);
    append_int(&list, guests[i].slot);
    append_int(&list, guests[i].has_skeleton);
    append_int(&list, guests[i].has_hands);
    append_int(&list, guests[i].generation);
  }
  return result_of_list(&list);
}

// (handle, slot, time_ns; before 1 = the newest) -> [status, sequence, kind, presence, confidence,
// music_beats, time_ns, 3 of the hips' position and 4 of each bone's rotation]
FUNCTION(dance_pose_at) {
  dance_adapter* adapter = adapter_of(arguments);
  const int64_t time_ns = int_argument(arguments, 2);
  dance_pose pose = {.struct_size = sizeof pose};
  const uint32_t slot = slot_of(arguments);
  const dance_status status = !adapter      ? DANCE_BAD_ARGUMENT
                              : time_ns > 0 ? dance_adapter_at(adapter, slot, time_ns, &pose)
                                            : dance_adapter_newest(adapter, slot, &pose);
  godot_array list = make_list();
  append_int(&list, status);
  if (status == DANCE_OK) {
    append_int(&list, pose.sequence);
    append_int(&list, pose.kind);
    append_int(&list, pose.presence);
    append_real(&list, pose.confidence);
    append_real(&list, pose.music_beats);
    append_int(&list, pose.time_ns);
    float numbers[3 + 4 * DANCE_BONES];
    memcpy(numbers, pose.hips_position, sizeof pose.hips_position);
    memcpy(numbers + 3, pose.rotation, sizeof pose.rotation);
    append_numbers(&list, numbers, 3 + 4 * DANCE_BONES);
  }
  return result_of_list(&list);
}

// (handle, slot) -> [status, version, 3 of each bone's offset and of the five tips]
FUNCTION(dance_skeleton_of) {
  dance_adapter* adapter = adapter_of(arguments);
  dance_skeleton skeleton = {.struct_size = sizeof skeleton};
  const dance_status status =
      adapter ? dance_adapter_skeleton(adapter, slot_of(arguments), &skeleton) : DANCE_BAD_ARGUMENT;
  godot_array list = make_list();
  append_int(&list, status);
  if (status == DANCE_OK) {
    append_int(&list, skeleton.version);
    float numbers[3 * (DANCE_BONES + DANCE_TIPS)];
    memcpy(numbers, skeleton.offset, sizeof skeleton.offset);
    memcpy(numbers + 3 * DANCE_BONES, skeleton.tip, sizeof skeleton.tip);
    append_numbers(&list, numbers, 3 * (DANCE_BONES + DANCE_TIPS));
  }
  return result_of_list(&list);
}

// (handle, slot) -> [status, presence, 4 of each finger bone's rotation]
FUNCTION(dance_hands_of) {
  dance_adapter* adapter = adapter_of(arguments);
  dance_hands hands = {.struct_size = sizeof hands};
  const dance_status status =
      adapter ? dance_adapter_hands(adapter, slot_of(arguments), &hands) : DANCE_BAD_ARGUMENT;
  godot_array list = make_list();
  append_int(&list, status);
  if (status == DANCE_OK) {
    append_int(&list, hands.presence);
    append_numbers(&list, &hands.rotation[0][0], 4 * DANCE_FINGER_BONES);
  }
  return result_of_list(&list);
}

// (handle, time_ns) -> [status, position in beats, tempo, beats per bar, confidence, playing]
FUNCTION(dance_beat_at) {
  dance_adapter* adapter = adapter_of(arguments);
  dance_beat beat = {.struct_size = sizeof beat};
  const dance_status status =
      adapter ? dance_adapter_beat(adapter, int_argument(arguments, 1), &beat) : DANCE_BAD_ARGUMENT;
  godot_array list = make_list();
  append_int(&list, status);
  if (status == DANCE_OK) {
    append_real(&list, beat.position_beats);
    append_real(&list, beat.tempo_bpm);
    append_int(&list, beat.beats_per_bar);
    append_real(&list, beat.confidence);
    append_int(&list, beat.playing);
  }
  return result_of_list(&list);
}

// (handle) -> [status, reads, retries, busy, damaged, attached]
FUNCTION(dance_counted) {
  dance_adapter* adapter = adapter_of(arguments);
  dance_counters counters = {.struct_size = sizeof counters};
  const dance_status status =
      adapter ? dance_adapter_counters(adapter, &counters) : DANCE_BAD_ARGUMENT;
  godot_array list = make_list();
  append_int(&list, status);
  append_int(&list, (int64_t)counters.reads);
  append_int(&list, (int64_t)counters.retries);
  append_int(&list, (int64_t)counters.busy);
  append_int(&list, (int64_t)counters.damaged);
  append_int(&list, (int64_t)counters.attached);
  return result_of_list(&list);
}

// (name) -> handle or -1
FUNCTION(dance_send_open) {
  char name[64];
  text_argument(arguments, 0, name, sizeof name);
  if (dance_adapter_abi() != DANCE_ADAPTER_ABI) return result_of_int(-1);
  for (int i = 0; i < HANDLES; ++i) {
    if (producers[i]) continue;
    producers[i] = dance_producer_open(name, DANCE_AXES_GLTF);
    return result_of_int(producers[i] ? i : -1);
  }
  return result_of_int(-1);
}

// (handle)
FUNCTION(dance_send_close) {
  const int64_t handle = int_argument(arguments, 0);
  if (is_handle(handle) && producers[handle]) {
    dance_producer_close(producers[handle]);
    producers[handle] = NULL;
  }
  return result_of_int(0);
}

// (handle, numbers as dance_pose_at gives them, presence, confidence in thousandths) -> status
FUNCTION(dance_send_pose) {
  dance_producer* producer = producer_of(arguments);
  float numbers[3 + 4 * DANCE_BONES];
  if (!producer || !numbers_argument(arguments, 1, numbers, 3 + 4 * DANCE_BONES))
    return result_of_int(DANCE_BAD_ARGUMENT);
  dance_pose pose = {.struct_size = sizeof pose, .music_beats = NAN};
  memcpy(pose.hips_position, numbers, sizeof pose.hips_position);
  memcpy(pose.rotation, numbers + 3, sizeof pose.rotation);
  pose.presence = (uint32_t)int_argument(arguments, 2);
  pose.confidence = (float)int_argument(arguments, 3) / 1000.0f;
  return result_of_int(dance_producer_pose(producer, &pose));
}

// (handle, numbers as dance_skeleton_of gives them, version) -> status
FUNCTION(dance_send_skeleton) {
  dance_producer* producer = producer_of(arguments);
  float numbers[3 * (DANCE_BONES + DANCE_TIPS)];
  if (!producer || !numbers_argument(arguments, 1, numbers, 3 * (DANCE_BONES + DANCE_TIPS)))
    return result_of_int(DANCE_BAD_ARGUMENT);
  dance_skeleton skeleton = {.struct_size = sizeof skeleton};
  memcpy(skeleton.offset, numbers, sizeof skeleton.offset);
  memcpy(skeleton.tip, numbers + 3 * DANCE_BONES, sizeof skeleton.tip);
  skeleton.version = (uint32_t)int_argument(arguments, 2);
  return result_of_int(dance_producer_skeleton(producer, &skeleton));
}

// (handle, numbers as dance_hands_of gives them, presence) -> status
FUNCTION(dance_send_hands) {
  dance_producer* producer = producer_of(arguments);
  float numbers[4 * DANCE_FINGER_BONES];
  if (!producer || !numbers_argument(arguments, 1, numbers, 4 * DANCE_FINGER_BONES))
    return result_of_int(DANCE_BAD_ARGUMENT);
  dance_hands hands = {.struct_size = sizeof hands};
  memcpy(hands.rotation, numbers, sizeof hands.rotation);
  hands.presence = (uint32_t)int_argument(arguments, 2);
  return result_of_int(dance_producer_hands(producer, &hands));
}
