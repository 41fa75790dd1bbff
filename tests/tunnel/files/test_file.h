// A file for tests of transfers: bytes that tell their place, and a hash that stands for it.
//
// Ownership: plain values.
// Threads:   none inside.
// Failure:   none.
#pragma once

#include "core/base/random.h"
#include "tests/tunnel/simulated_tunnel.h"

namespace dance {

struct TestFile {
  FileHash hash;
  std::vector<std::uint8_t> bytes;

  std::uint32_t size() const { return static_cast<std::uint32_t>(bytes.size()); }
  FileBytes shared() const { return std::make_shared<const std::vector<std::uint8_t>>(bytes); }
  AvatarFile state() const {
    AvatarFile file;
    file.hash = hash;
    file.size_bytes = static_cast<std::int32_t>(bytes.size());
    return file;
  }
  wire::Bytes chunk(std::size_t index) const {
    // A receiver that was given another size may ask for chunks behind the end.
    if (index * wire::kFileChunk >= bytes.size()) return {};
    return wire::Bytes(bytes).subspan(index * wire::kFileChunk, wire::chunk_bytes(size(), index));
  }
};

inline TestFile test_file(std::size_t size_bytes, std::uint8_t number = 1) {
  TestFile file;
  Random random(number);
  for (std::uint8_t& byte : file.hash.bytes) byte = static_cast<std::uint8_t>(random.below(256));
  file.hash.bytes[0] = static_cast<std::uint8_t>(number | 1);
  for (std::size_t i = 0; i < size_bytes; ++i)
    file.bytes.push_back(static_cast<std::uint8_t>(random.below(256)));
  return file;
}

// As a house does it: the bytes first, then the state.
inline void choose(SimulatedTunnel& tunnel, SimulatedTunnel::House& house, const char* who,
                   const TestFile& file) {
  house.link->files().offer(guest(who), file.hash, file.shared());
  house.link->send(guest(who), file.state(), tunnel.time_in(house));
}

inline void fetch(SimulatedTunnel& tunnel, SimulatedTunnel::House& house, const char* whose,
                  const TestFile& file) {
  house.link->files().fetch(guest(whose), file.hash, ChunkedFile(file.size()),
                            tunnel.time_in(house));
}

}  // namespace dance
