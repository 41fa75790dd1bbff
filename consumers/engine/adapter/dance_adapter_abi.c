/* That dance_adapter.h is C99, and that its structs are what other languages declare: their sizes
 * are the ABI. */
#include "consumers/engine/dance_adapter.h"

#define DANCE_HAS_SIZE(type, bytes) typedef char size_of_##type[sizeof(type) == (bytes) ? 1 : -1]
DANCE_HAS_SIZE(dance_guest, 64);
DANCE_HAS_SIZE(dance_pose, 424);
DANCE_HAS_SIZE(dance_hands, 496);
DANCE_HAS_SIZE(dance_skeleton, 332);
DANCE_HAS_SIZE(dance_world, 684);
DANCE_HAS_SIZE(dance_beat, 32);
DANCE_HAS_SIZE(dance_counters, 48);
