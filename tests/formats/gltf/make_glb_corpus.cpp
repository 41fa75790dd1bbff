// Writes the files of the fuzz target, GLBs without bodies:
//   make_glb_corpus tests/formats/gltf/corpus
#include <cstdio>
#include <string>

#include "tests/formats/gltf/glb_clips.h"

int main(int argc, char** argv) {
  if (argc != 2) {
    std::fprintf(stderr, "%s: give the folder of the corpus\n", argv[0]);
    return 2;
  }
  dance::GlbOptions options;
  options.has_bodies = false;
  const auto write = [&](const char* name, const std::vector<dance::NamedClip>& clips) {
    const auto bytes = dance::write_glb(clips, options);
    std::FILE* file = std::fopen((std::string(argv[1]) + "/" + name).c_str(), "wb");
    if (!bytes || !file) return false;
    const bool written = std::fwrite(bytes->data(), 1, bytes->size(), file) == bytes->size();
    return std::fclose(file) == 0 && written;
  };
  using dance::test::random_dance;
  const bool written =
      write("alice.glb", {random_dance("alice", 1, 12, false)}) &&
      write("hands.glb", {random_dance("alice", 2, 9, true)}) &&
      write("couple.glb", {random_dance("alice", 3, 9, false), random_dance("bob", 4, 9, false)});
  return written ? 0 : 1;
}
