// MP4 files whose index, which cameras write last, is missing.
#include <gtest/gtest.h>

#include <fstream>
#include <utility>

#include "producers/camera/files/open_frame_source.h"
#include "tests/producers/camera/files/written_pictures.h"
#include "tests/test_folder.h"

namespace dance {
namespace {

// Boxes of an MP4 file: each its size, its type and zeros. Size 0: up to the end of the file.
std::string mp4_boxes(std::initializer_list<std::pair<const char*, std::size_t>> boxes) {
  std::string bytes;
  for (const auto& [type, size] : boxes) {
    for (int shift = 24; shift >= 0; shift -= 8) bytes += static_cast<char>(size >> shift & 0xff);
    bytes += type;
    bytes.append(size > 8 ? size - 8 : 64, '\0');
  }
  return bytes;
}

TEST(VideoEnd, DistinguishesAMissingEndOfAnMp4FromADamagedFile) {
  SKIP_WITHOUT_MEDIA();
  const TestFolder folder("video-end");
  const std::string path = folder.path("a.mp4");
  const auto is_without_end = [&](const std::string& bytes) {
    std::ofstream(path, std::ios::binary) << bytes;
    const auto source = open_frame_source(path);
    const std::string line = source ? "it was opened" : source.error().what;
    EXPECT_TRUE(line.starts_with(path + ": is no picture that can be read; as a video: ")) << line;
    const bool names_it = line.find("its end is missing") != std::string::npos;
    EXPECT_EQ(names_it, line.find("untrunc") != std::string::npos) << line;
    return names_it;
  };
  EXPECT_TRUE(is_without_end(mp4_boxes({{"ftyp", 24}, {"mdat", 0}}))) << "of a camera that died";
  EXPECT_TRUE(is_without_end(mp4_boxes({{"ftyp", 24}, {"free", 16}, {"mdat", 500}})));
  const std::string whole = mp4_boxes({{"ftyp", 24}, {"mdat", 5000}, {"moov", 200}});
  EXPECT_TRUE(is_without_end(whole.substr(0, 3000))) << "a copy that was cut";
  EXPECT_FALSE(is_without_end(whole)) << "the end is there, and says nothing";
  EXPECT_FALSE(is_without_end(mp4_boxes({{"ftyp", 24}, {"moov", 200}, {"mdat", 5000}})));
  EXPECT_FALSE(is_without_end("no video at all, and no box either"));
}

}  // namespace
}  // namespace dance
