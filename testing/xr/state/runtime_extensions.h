// The extensions that the OpenXR test runtime offers, but those that the script takes away.
//
// Units/frames: none.
// Ownership:    works on runtime().
// Threads:      the caller holds the runtime's lock.
// Failure:      none.
#pragma once

#include <cstdint>
#include <string_view>
#include <vector>

namespace dance::test_xr {

struct OfferedExtension {
  const char* name;
  std::uint32_t version;
};
std::vector<OfferedExtension> offered_extensions();
bool is_offered(std::string_view name);

}  // namespace dance::test_xr
