// Writes the files of the fuzz target:
//   make_picture_corpus tests/formats/picture/corpus
#include <cstdio>
#include <string>

#include "tests/formats/picture/packed_pictures.h"

int main(int argc, char** argv) {
  if (argc != 2) {
    std::fprintf(stderr, "%s: give the folder of the corpus\n", argv[0]);
    return 2;
  }
  const auto write = [&](const char* name, const std::vector<std::uint8_t>& bytes) {
    std::FILE* file = std::fopen((std::string(argv[1]) + "/" + name).c_str(), "wb");
    if (!file) return false;
    const bool written = std::fwrite(bytes.data(), 1, bytes.size(), file) == bytes.size();
    return std::fclose(file) == 0 && written;
  };
  using namespace dance::test;
  const bool written =
      write("ramp.png", png(9, 7)) && write("ramp.jpg", jpeg(16, 16)) &&
      write("progressive.jpg", jpeg(16, 16, TJFLAG_PROGRESSIVE)) &&
      write("ramp.webp", webp(9, 7)) && write("held.jpg", with_exif(jpeg(16, 16), exif(6, true))) &&
      write("held.png", with_exif(png(9, 7), exif(8, false))) && write("large.png", png(80, 70));
  return written ? 0 : 1;
}
