#include "producers/music/tracker/beat_model.h"

#include <gtest/gtest.h>

#include <limits>

#include "tests/test_folder.h"

namespace dance {
namespace {

std::vector<std::uint8_t> beats_model_file() {
  return bytes_in(DANCE_SOURCE_DIR "/data/music/beats.model");
}

TEST(BeatModel, TheBuiltInOneIsTheFileOfTheTree) {
  const auto model = read_beat_model(beats_model_file());
  ASSERT_TRUE(model) << model.error().what;
  EXPECT_EQ((*model)->name, built_in_beat_model()->name);
}

TEST(BeatModel, WrittenAndReadAgainIsTheSame) {
  EXPECT_EQ(write_beat_model(*built_in_beat_model()), beats_model_file());
}

TEST(BeatModel, RefusesWhatIsDamaged) {
  const std::vector<std::uint8_t> whole = beats_model_file();
  for (const std::size_t size :
       {std::size_t{0}, std::size_t{3}, std::size_t{8}, whole.size() / 2, whole.size() - 1})
    EXPECT_FALSE(read_beat_model(std::span(whole).first(size))) << size;
  auto longer = whole;
  longer.push_back(0);
  EXPECT_FALSE(read_beat_model(longer));
  const auto changed = [&](std::size_t byte, std::uint8_t value) {
    auto other = whole;
    other[byte] = value;
    return read_beat_model(other);
  };
  constexpr std::size_t kVersionByte = 4, kPatternsByte = 6;
  EXPECT_FALSE(changed(0, whole[0] ^ 1));
  for (const int patterns : {0, 1, 33, 255})
    EXPECT_FALSE(changed(kPatternsByte, static_cast<std::uint8_t>(patterns))) << patterns;
  for (const int version : {1, 2, 4}) {
    const auto other = changed(kVersionByte, static_cast<std::uint8_t>(version));
    ASSERT_FALSE(other);
    EXPECT_NE(other.error().what.find("version " + std::to_string(version)), std::string::npos)
        << other.error().what;
  }
}

TEST(BeatModel, RefusesNumbersNoTrackerCouldUse) {
  BeatModel model = *built_in_beat_model();
  model.net.layers[0].in(3, 4) = std::numeric_limits<float>::quiet_NaN();
  EXPECT_FALSE(read_beat_model(write_beat_model(model)));
  model = *built_in_beat_model();
  model.net.layers[1].again(1, 2) = std::numeric_limits<float>::quiet_NaN();
  EXPECT_FALSE(read_beat_model(write_beat_model(model)));
  model = *built_in_beat_model();
  model.patterns.front().least_tempo_bpm = 210;
  model.patterns.front().most_tempo_bpm = 230;
  EXPECT_FALSE(read_beat_model(write_beat_model(model)));
  model.patterns.front().least_tempo_bpm = 130;
  model.patterns.front().most_tempo_bpm = 120;
  EXPECT_FALSE(read_beat_model(write_beat_model(model)));
  model.patterns.front().least_tempo_bpm = 102;
  model.patterns.front().most_tempo_bpm = 103;
  EXPECT_FALSE(read_beat_model(write_beat_model(model))) << "no period of whole hops is between";
  for (const float wrong : {std::numeric_limits<float>::infinity(), -2e4f}) {
    model = *built_in_beat_model();
    model.net.out(1, 2) = wrong;
    EXPECT_FALSE(read_beat_model(write_beat_model(model))) << wrong;
  }
}

}  // namespace
}  // namespace dance
