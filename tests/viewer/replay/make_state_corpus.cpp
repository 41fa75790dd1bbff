// Writes the states of the fuzz target, out of the index of a recorded night:
//   make_state_corpus tests/viewer/replay/state_corpus
#include <cstdio>
#include <filesystem>
#include <string>

#include "tests/test_folder.h"
#include "tests/viewer/replay/recorded_night.h"
#include "viewer/replay/index_builder.h"

int main(int argc, char** argv) {
  if (argc != 2) {
    std::fprintf(stderr, "%s: give the folder of the corpus\n", argv[0]);
    return 2;
  }
  const dance::TestFolder folder("state-corpus");
  const std::string log = folder.path("night.lcm");
  dance::write_recorded_night(log, 45.0, true);
  const auto index = dance::build_index(log, false, {});
  if (!index) return 1;
  int number = 0;
  for (const auto& checkpoint : index->checkpoints) {
    if (checkpoint.state.empty() || ++number > 3) continue;
    const std::string path = std::string(argv[1]) + "/night-" + std::to_string(number) + ".state";
    std::FILE* file = std::fopen(path.c_str(), "wb");
    if (!file) return 1;
    const auto& state = checkpoint.state;
    const bool written = std::fwrite(state.data(), 1, state.size(), file) == state.size();
    if (std::fclose(file) != 0 || !written) return 1;
  }
  return number > 0 ? 0 : 1;
}
