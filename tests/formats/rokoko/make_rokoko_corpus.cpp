// Writes the corpus of the fuzz target: argument 1 is the folder.
#include <fstream>
#include <span>
#include <string>

#include "formats/lz4/lz4_frame.h"
#include "formats/rokoko/rokoko_writer.h"
#include "tests/formats/rokoko/rokoko_couple.h"

int main(int argc, char** argv) {
  if (argc != 2) return 2;
  const std::string folder = argv[1];
  dance::RokokoWriter writer;
  dance::Lz4Packer packer(std::size_t{1} << 24);
  const auto save = [&](const std::string& name, std::string_view text) {
    std::ofstream(folder + "/" + name, std::ios::binary) << text;
  };
  const auto text = std::string(
      writer.write(*dance::rokoko_couple(3.0), 1, dance::RokokoWriter::kMostTextBytes).text);
  const auto packed_as_text = [&](std::string_view plain) {
    const auto packed = packer.pack(plain, std::size_t{1} << 24);
    return packed ? std::string(packed->begin(), packed->end()) : std::string();
  };
  save("actor.json", text);
  save("actor.lz4", packed_as_text(text));
  save("bomb.lz4", packed_as_text(std::string(std::size_t{4} << 20, ' ')));
  save("deep.json", std::string(200, '['));
  save("version_2.json",
       R"({"version":2,"timestamp":1,"props":[],"trackers":[],"faces":[],"actors":[]})");
  save("numbers.json",
       R"({"version":3,"fps":-1e999,"scene":{"timestamp":1e400,"actors":[{"name":"a",)"
       R"("color":[300,-1],"body":{"hip":{"position":{"x":1e39,"y":0,"z":0},)"
       R"("rotation":{"x":0,"y":0,"z":0,"w":0}}}}]}})");
  return 0;
}
