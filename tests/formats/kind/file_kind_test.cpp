#include "formats/kind/file_kind.h"

#include <gtest/gtest.h>

#include "formats/kind/file_content.h"
#include "tests/test_folder.h"

namespace dance {
namespace {

using std::string_view_literals::operator""sv;

constexpr std::string_view kLogHead =
    "\xED\xA1\xDA\x01\0\0\0\0\0\0\0\0\0\0\0\0\0\0\0\0\0\0\0\x04\0\0\0\x02POSExx"sv;
constexpr std::string_view kLcmTypeText =
    "/* a pose */\npackage demo;\n\nstruct pose_sample_t\n{\n  int64_t utime;\n}\n";

class FileKinds : public testing::Test {
 protected:
  std::string write(const std::string& name, std::string_view bytes) {
    const std::string path = folder_.path(name);
    std::ofstream(path, std::ios::binary)
        .write(bytes.data(), static_cast<std::streamsize>(bytes.size()));
    return path;
  }
  std::string error_of(const std::string& name, std::string_view bytes) {
    const auto kind = input_kind(write(name, bytes));
    return kind ? "no error" : kind.error().what;
  }
  TestFolder folder_{"file-kinds"};
};

TEST(FileContent, RecognisesKindsByTheirFirstBytes) {
  const std::pair<std::string_view, FileContent> kCases[] = {
      {"", FileContent::kEmpty},
      {kLogHead, FileContent::kLcmLog},
      {"\xEF\xBB\xBF \r\nhierarchy\nROOT a\n"sv, FileContent::kBvh},
      {"glTF\2\0\0\0"sv, FileContent::kGlb},
      {R"( {"asset": {"version": "2.0"}})", FileContent::kGltf},
      {R"({"a": 1})", FileContent::kJson},
      {"\x89MCAP0\r\n"sv, FileContent::kMcap},
      {"heard_us,capture_us,guest,hips_x_m\n1,2,alice,0\n", FileContent::kTable},
      {"# mine\n[house]\nguest = \"alice\"\n", FileContent::kSessionFile},
      {kLcmTypeText, FileContent::kLcmType},
      {"version https://git-lfs.github.com/spec/v1\noid sha256:0\n", FileContent::kFilePointer},
      {"PK\3\4\x14\0"sv, FileContent::kZip},
      {"\x1F\x8B\x08"sv, FileContent::kGzip},
      {"Kaydara FBX Binary  \0"sv, FileContent::kFbx},
      {"; FBX 7.4.0 project file\n", FileContent::kFbx},
      {"fLaC", FileContent::kSound},
      {"RIFF\0\0\0\0WAVEfmt "sv, FileContent::kSound},
      {"<!DOCTYPE html><html>", FileContent::kWebPage},
      {"package of notes, no definition", FileContent::kUnknown},
      {"\0\0\0\0"sv, FileContent::kUnknown},
  };
  for (const auto& [head, content] : kCases)
    EXPECT_EQ(content_of(head), content)
        << head.substr(0, 20) << ": " << content_name(content_of(head));
}

TEST(FileContent, FindsALogWhoseBeginningIsDamaged) {
  EXPECT_EQ(content_of(std::string(100, '\xAA') + std::string(kLogHead)), FileContent::kLcmLog);
}

TEST_F(FileKinds, AreRecognisedByContentRegardlessOfTheName) {
  EXPECT_EQ(input_kind(write("lcmlog-2026-11-28.00", kLogHead)).value(), FileKind::kLcm);
  EXPECT_EQ(input_kind(write("take.txt", "HIERARCHY\nROOT a\n")).value(), FileKind::kBvh);
  EXPECT_EQ(input_kind(write("take.lcm", "\x89MCAP0\r\n")).value(), FileKind::kMcap);
}

TEST_F(FileKinds, AreRecognisedByNameIfTheContentIsAmbiguous) {
  EXPECT_EQ(input_kind(write("take.BVH", "???")).value(), FileKind::kBvh);
  EXPECT_EQ(input_kind(write("empty.lcm", "")).value(), FileKind::kLcm);
  EXPECT_EQ(input_kind(folder_.path("not-there.glb")).value(), FileKind::kGlb);
}

TEST_F(FileKinds, ErrorsNameTheKindAndTheProgramThatReadsIt) {
  EXPECT_NE(error_of("types.lcm", kLcmTypeText)
                .find("types.lcm: an LCM type definition, not a recorded dance; lcm-gen takes it"),
            std::string::npos);
  EXPECT_NE(
      error_of("take.bvh", "version https://git-lfs.github.com/spec/v1\n").find("git lfs pull"),
      std::string::npos);
  EXPECT_NE(error_of("take.zip", "PK\3\4").find("a ZIP archive"), std::string::npos);
  EXPECT_NE(error_of("take.bvh.gz", "\x1F\x8B\x08").find("gunzip"), std::string::npos);
  EXPECT_NE(error_of("song.ogg", "OggS").find("dance music takes it"), std::string::npos);
  EXPECT_NE(error_of("x.dat", "???").find("none of the kinds that can be read"), std::string::npos);
  EXPECT_EQ(input_kind(folder_.path("not-there")).error().what,
            folder_.path("not-there") + ": no such file");
}

}  // namespace
}  // namespace dance
