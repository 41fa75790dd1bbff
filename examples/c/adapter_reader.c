/* adapter_reader: what a game engine does in each frame: reads every dancer of the stage for the
 * time at which the frame will be seen, and prints where head and hips are then. Beside a house
 * that shows its stage to engines (`dance listen --to engine`, or [[listen]] to = "engine" in its
 * session file). Without CMake:
 *   cc adapter_reader.c $(pkg-config --cflags --libs dance-adapter) -o adapter_reader
 * usage: adapter_reader [NAME [SECONDS]]
 *   NAME is the house's name for engines, stage unless given */
#include <dance_adapter.h>
#include <stdio.h>
#include <stdlib.h>
#include <time.h>

#define FRAMES_HZ 60
#define FRAME_NS (1000000000 / FRAMES_HZ)

static const char* const kinds[] = {"newest", "interpolated", "predicted", "held"};

static void show(dance_adapter* stage, const dance_guest* guest, int64_t seen_ns) {
  dance_pose pose = {.struct_size = sizeof pose};
  dance_skeleton skeleton = {.struct_size = sizeof skeleton};
  dance_world world = {.struct_size = sizeof world};
  if (dance_adapter_at(stage, guest->slot, seen_ns, &pose) != DANCE_OK) return;
  if (dance_adapter_skeleton(stage, guest->slot, &skeleton) != DANCE_OK) return;
  if (dance_world_of(&skeleton, &pose, &world) != DANCE_OK) return;
  /* Bone 0 is the hips, bone 5 the head: dance_bone_name(5). Metres, y up. */
  printf("%s %s %.3f %.3f %.3f %.3f\n", guest->id, kinds[pose.kind & 3], world.position[0][0],
         world.position[0][1], world.position[0][2], world.position[5][1]);
}

int main(int argc, char** argv) {
  const char* name = argc > 1 ? argv[1] : "stage";
  const double seconds = argc > 2 ? atof(argv[2]) : 1e9;
  if (dance_adapter_abi() != DANCE_ADAPTER_ABI) {
    fprintf(stderr, "adapter_reader: libdance_adapter is of another version than its header\n");
    return 1;
  }
  dance_adapter* stage = dance_adapter_open(name, DANCE_AXES_GLTF);
  if (!stage) {
    fprintf(stderr, "adapter_reader: '%s' is no name: 1 to 24 characters of a-z, 0-9 and '-'\n",
            name);
    return 2;
  }
  const int64_t begin = dance_adapter_now_ns();
  dance_status said = DANCE_OK;
  for (int64_t frame = begin; (double)(frame - begin) < seconds * 1e9; frame += FRAME_NS) {
    const struct timespec at = {frame / 1000000000, frame % 1000000000};
    while (clock_nanosleep(CLOCK_MONOTONIC, TIMER_ABSTIME, &at, NULL) != 0) continue;
    const dance_status status = dance_adapter_state(stage);
    if (status != said) fprintf(stderr, "adapter_reader: %s\n", dance_status_text(status));
    said = status;
    dance_guest guests[DANCE_MAX_GUESTS];
    guests[0].struct_size = sizeof guests[0];
    const uint32_t count = dance_adapter_guests(stage, guests, DANCE_MAX_GUESTS);
    for (uint32_t i = 0; i < count && i < DANCE_MAX_GUESTS; ++i)
      show(stage, &guests[i], frame + FRAME_NS);
  }
  dance_counters counters = {.struct_size = sizeof counters};
  dance_adapter_counters(stage, &counters);
  fprintf(stderr, "adapter_reader: %llu reads, %llu damaged\n", (unsigned long long)counters.reads,
          (unsigned long long)counters.damaged);
  dance_adapter_close(stage);
  return 0;
}
