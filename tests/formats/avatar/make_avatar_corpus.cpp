// Writes the files of the fuzz target:
//   make_avatar_corpus tests/formats/avatar/corpus
#include <cstdio>
#include <string>

#include "tests/formats/avatar/rich_avatar.h"

int main(int argc, char** argv) {
  if (argc != 2) {
    std::fprintf(stderr, "%s: give the folder of the corpus\n", argv[0]);
    return 2;
  }
  const auto write = [&](const char* name, const dance::test::Bytes& bytes) {
    std::FILE* file = std::fopen((std::string(argv[1]) + "/" + name).c_str(), "wb");
    if (!file) return false;
    const bool written = std::fwrite(bytes.data(), 1, bytes.size(), file) == bytes.size();
    return std::fclose(file) == 0 && written;
  };
  using namespace dance::test;
  const bool written =
      write("vrm0.vrm", rich_vrm0().glb()) && write("vrm1.vrm", rich_vrm1().glb()) &&
      write("plain.glb", plain_glb().glb()) && write("text.gltf", plain_glb().gltf());
  return written ? 0 : 1;
}
