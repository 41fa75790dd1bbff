// The JSON of a GLB file, for tests that look at what a writer put there.
//
// Ownership: values.
// Threads:   none inside.
// Failure:   bytes that hold none give a discarded value.
#pragma once

#include <cstdint>
#include <cstring>
#include <nlohmann/json.hpp>
#include <vector>

namespace dance::test {

inline nlohmann::json glb_json(const std::vector<std::uint8_t>& file) {
  constexpr std::size_t kHeaders_bytes = 20;
  if (file.size() < kHeaders_bytes) return nlohmann::json::parse("", nullptr, false);
  std::uint32_t size = 0;
  std::memcpy(&size, file.data() + 12, sizeof size);
  if (size > file.size() - kHeaders_bytes) return nlohmann::json::parse("", nullptr, false);
  const auto begin = file.begin() + kHeaders_bytes;
  return nlohmann::json::parse(begin, begin + size, nullptr, false);
}

}  // namespace dance::test
