// Writes the files of the fuzz target:
//   make_index_corpus tests/formats/replay/corpus
#include <cstdio>
#include <string>

#include "tests/formats/replay/some_index.h"

int main(int argc, char** argv) {
  if (argc != 2) {
    std::fprintf(stderr, "%s: give the folder of the corpus\n", argv[0]);
    return 2;
  }
  const auto write = [&](const char* name, const dance::ReplayIndex& index) {
    const auto bytes = dance::write_index(index);
    std::FILE* file = std::fopen((std::string(argv[1]) + "/" + name).c_str(), "wb");
    if (!file) return false;
    const bool written = std::fwrite(bytes.data(), 1, bytes.size(), file) == bytes.size();
    return std::fclose(file) == 0 && written;
  };
  dance::ReplayIndex nobody;
  nobody.checkpoints.push_back({});
  dance::ReplayIndex silent = dance::test::some_index();
  silent.beats.clear();
  silent.stage_only = true;
  const bool written = write("couple.index", dance::test::some_index()) &&
                       write("nobody.index", nobody) && write("silent.index", silent);
  return written ? 0 : 1;
}
