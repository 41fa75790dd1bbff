/* hips_consumer: prints where each dancer's hips are, for every pose that LCM hands over. Needs the
 * messages' C bindings alone, which `lcm-gen --c` made; without CMake:
 *   cc hips_consumer.c -I/usr/include/dancegraph -ldance_lcmtypes_c -llcm -o hips_consumer
 * usage: hips_consumer [CHANNELS [SECONDS]]
 *   CHANNELS is a regular expression, POSE/stage/.* unless given */
#include <lcm/lcm.h>
#include <stdio.h>
#include <stdlib.h>
#include <time.h>

#include "dancelcm_pose_t.h"

static void on_pose(const lcm_recv_buf_t* buffer, const char* channel, const dancelcm_pose_t* pose,
                    void* user) {
  (void)buffer;
  (void)user;
  /* Metres on the stage: x to the left of a dancer who faces +z, y up. */
  printf("%s %d %.3f %.3f %.3f\n", channel, pose->sequence, pose->hips_m[0], pose->hips_m[1],
         pose->hips_m[2]);
}

int main(int argc, char** argv) {
  const char* channels = argc > 1 ? argv[1] : "POSE/stage/.*";
  const double seconds = argc > 2 ? atof(argv[2]) : 1e9;
  /* The bus of the house: what stays on this machine has ttl=0. */
  const char* url = getenv("DANCE_BUS_URL");
  lcm_t* lcm = lcm_create(url ? url : "udpm://239.255.76.67:7667?ttl=0");
  if (!lcm) {
    fprintf(stderr, "hips_consumer: the bus cannot be opened; `dance doctor` says why\n");
    return 1;
  }
  dancelcm_pose_t_subscribe(lcm, channels, on_pose, NULL);
  const time_t end = time(NULL) + (time_t)seconds;
  while (time(NULL) < end)
    if (lcm_handle_timeout(lcm, 200) < 0) return 1;
  lcm_destroy(lcm);
  return 0;
}
