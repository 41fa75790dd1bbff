#include "tunnel/session/state_replicator.h"

#include <algorithm>

namespace dance {

void ReplicatedState::set(std::uint32_t new_version, wire::Bytes bytes) {
  DANCE_ASSERT(bytes.size() <= payload.size(), bytes.size());
  version = new_version;
  size = static_cast<std::uint16_t>(bytes.size());
  std::copy(bytes.begin(), bytes.end(), payload.begin());
}

bool ReplicatedState::change(wire::Bytes bytes) {
  if (version != 0 &&
      std::equal(bytes.begin(), bytes.end(), payload.begin(), payload.begin() + size))
    return false;
  set(next_version(version), bytes);
  return true;
}

}  // namespace dance
