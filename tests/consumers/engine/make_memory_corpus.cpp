// Writes places and words of a house's memory into the folder that is named: what adapter_fuzz
// reads. Each file touches another part of the layout.

#include <cstddef>
#include <cstring>
#include <fstream>
#include <string>
#include <vector>

#include "formats/engine/segment.h"

namespace {

using dance::engine::GuestSlot;
using dance::engine::Segment;

struct Patches {
  std::vector<char> bytes;
  void put(std::size_t place_bytes, std::uint64_t word) {
    const auto place = static_cast<std::uint32_t>(place_bytes / 8);
    bytes.insert(bytes.end(), reinterpret_cast<const char*>(&place),
                 reinterpret_cast<const char*>(&place) + 4);
    bytes.insert(bytes.end(), reinterpret_cast<const char*>(&word),
                 reinterpret_cast<const char*>(&word) + 8);
  }
  void write(const std::string& path) const {
    std::ofstream(path, std::ios::binary)
        .write(bytes.data(), static_cast<std::streamsize>(bytes.size()));
  }
};

}  // namespace

int main(int argc, char** argv) {
  const std::string folder = argc > 1 ? argv[1] : ".";
  const auto everywhere = [&](const std::string& name, std::size_t place, std::size_t words) {
    Patches patches;
    for (std::size_t i = 0; i < words && i < 64; ++i)
      for (const std::uint64_t word : {~std::uint64_t{0}, std::uint64_t{1}})
        patches.put(place + 8 * i, word);
    patches.write(folder + "/" + name);
  };
  constexpr std::size_t kSlot = offsetof(Segment, guests);
  everywhere("header", 0, sizeof(dance::engine::SegmentHeader) / 8);
  everywhere("beats", offsetof(Segment, beats), 24);
  everywhere("slot", kSlot, 8);
  everywhere("poses", kSlot + offsetof(GuestSlot, poses), 4);
  everywhere("pose", kSlot + offsetof(GuestSlot, poses) + 64, 54);
  everywhere("skeleton", kSlot + offsetof(GuestSlot, skeletons), 24);
  everywhere("hands", kSlot + offsetof(GuestSlot, hands), 24);
  return 0;
}
