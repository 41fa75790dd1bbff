// Writes files to damage: `make_mcap_corpus tests/formats/mcap/corpus` from the root of the tree.
#include <cstdio>
#include <filesystem>
#include <fstream>

#include "tests/formats/mcap/mcap_sample.h"

int main(int argc, char** argv) {
  const std::filesystem::path folder = argc > 1 ? argv[1] : ".";
  const auto write = [&](const char* name, const dance::McapBytes& bytes) {
    std::ofstream(folder / name, std::ios::binary)
        .write(reinterpret_cast<const char*>(bytes.data()),
               static_cast<std::streamsize>(bytes.size()));
    std::printf("%s: %zu bytes\n", name, bytes.size());
  };
  const dance::McapBytes packed = mcap_of(dance::recorded_night(2));
  write("finished.mcap", packed);
  write("killed.mcap", mcap_of(dance::recorded_night(1), false));
  write("plain_chunk.mcap", dance::plain_mcap_of(packed, true));
  write("no_chunk.mcap", dance::plain_mcap_of(mcap_of(dance::recorded_night(1)), false));
  return 0;
}
