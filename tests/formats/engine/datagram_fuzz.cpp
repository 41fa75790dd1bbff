// Any bytes are a fault, or a value that may be used; never a crash.

#include <cstddef>
#include <cstdint>
#include <cstdlib>

#include "formats/engine/datagram.h"
#include "tests/fuzz_target.h"

DANCE_FUZZ_TARGET(engine_datagram) {
  const dance::engine::Received received = dance::engine::decode({data, size});
  if (const auto* pose = std::get_if<dance::Pose>(&received.what)) {
    if (!is_valid(*pose) || pose->capture_time <= dance::MonoTime()) std::abort();
  } else if (const auto* hands = std::get_if<dance::Hands>(&received.what)) {
    if (!is_valid(*hands)) std::abort();
  } else if (const auto* skeleton = std::get_if<dance::Skeleton>(&received.what)) {
    if (!is_valid(*skeleton)) std::abort();
  }
  return 0;
}
