// The facts that the list of recordings shows: from shipped logs, a log with a song, and hostile
// files.
#include "lobby/shelf/recorded_dance.h"

#include <gtest/gtest.h>
#include <sys/stat.h>

#include <algorithm>
#include <filesystem>
#include <fstream>

#include "core/bus/channel.h"
#include "core/bus/encode.h"
#include "formats/log/log_file.h"
#include "tests/test_folder.h"

namespace dance {
namespace {

RecordedDance read_recording(const std::string& path) {
  RecordedDance dance;
  dance.path = path;
  read_dance(dance);
  return dance;
}

TEST(RecordedDance, ReadsGuestsLengthAndTempoOfPlainAndPackedLogs) {
  for (const char* name : {"couple", "couple-packed"}) {
    const RecordedDance dance =
        read_recording(std::string(DANCE_SOURCE_DIR "/logs/") + name + std::string(".lcm"));
    EXPECT_TRUE(dance.is_read && dance.has_motion) << name;
    EXPECT_EQ(dance.guests.size(), 2u) << name;
    EXPECT_NE(std::find(dance.guests.begin(), dance.guests.end(), "bob"), dance.guests.end());
    EXPECT_NEAR(dance.length.as_seconds(), name[6] == '-' ? 10.67 : 2.67, 0.1) << name;
    EXPECT_NEAR(dance.tempo_bpm, 180.0, 0.01) << name;
    EXPECT_EQ(dance.name(), name);
    EXPECT_GT(dance.begun_us, 1'700'000'000'000'000) << name;
  }
}

TEST(RecordedDance, ReadsTheTitleOfTheSong) {
  const TestFolder folder("recorded-dance");
  auto log = *LogWriter::create(folder.path("a.lcm"));
  Music music;
  music.time = music.start_time = MonoTime::from_us(5'000'000);
  music.clock_id = 7;
  ASSERT_TRUE(music.title.assign("Cuarto de luna"));
  MessageBuffer buffer;
  const std::size_t size = encode(music, buffer);
  const auto guest = *GuestId::parse("alice");
  const Channel channel = Channel::of(Signal::kMusic, Where::kRoom, guest);
  ASSERT_TRUE(log.append(1'790'000'000'000'000, channel.view(), {buffer.data(), size}));
  ASSERT_TRUE(log.flush());
  const RecordedDance dance = read_recording(folder.path("a.lcm"));
  EXPECT_EQ(dance.song, "Cuarto de luna");
  EXPECT_FALSE(dance.has_motion);
}

TEST(RecordedDance, ReadsTheShownNamesOfItsGuests) {
  const TestFolder folder("named-dance");
  auto log = *LogWriter::create(folder.path("a.lcm"));
  const auto guest = *GuestId::parse("alice");
  const auto append = [&](Where where, const Profile& profile) {
    MessageBuffer buffer;
    const std::size_t size = encode(profile, buffer);
    const Channel channel = Channel::of(Signal::kProfile, where, guest);
    return log.append(1'790'000'000'000'000, channel.view(), {buffer.data(), size}).has_value();
  };
  Profile profile;
  profile.shown_name = *parse_shown_name("Alicia L\u00f3pez");
  ASSERT_TRUE(append(Where::kCapture, profile) && append(Where::kCapture, Profile()));
  ASSERT_TRUE(log.flush());
  const RecordedDance dance = read_recording(folder.path("a.lcm"));
  EXPECT_EQ(dance.shown("alice"), "Alicia L\u00f3pez");
  EXPECT_EQ(dance.shown("bob"), "bob");
}

TEST(RecordedDance, ReadsABoundedPartOfHostileFiles) {
  const TestFolder folder("hostile-dance");
  const std::string path = folder.path("x.lcm");
  EXPECT_FALSE(read_recording(path).has_motion) << "missing";
  std::filesystem::create_directories(folder.path("folder.lcm"));
  EXPECT_FALSE(read_recording(folder.path("folder.lcm")).has_motion);
  ASSERT_EQ(mkfifo(folder.path("pipe.lcm").c_str(), 0600), 0);
  EXPECT_FALSE(read_recording(folder.path("pipe.lcm")).has_motion) << "a pipe would wait for ever";

  // A file of a terabyte, almost all of it a hole.
  std::ofstream(path) << "x";
  std::filesystem::resize_file(path, std::uintmax_t{1} << 40);
  EXPECT_FALSE(read_recording(path).has_motion);

  // Every prefix length and many damaged bytes of a real one: names stay names.
  const std::string good = text_of(DANCE_SOURCE_DIR "/logs/couple.lcm").substr(0, 3000);
  for (std::size_t i = 0; i < good.size(); i += 7) {
    std::string bad = good.substr(0, good.size() - i);
    bad[bad.size() / 2] = static_cast<char>(bad[bad.size() / 2] ^ 0x55);
    std::ofstream(path, std::ios::trunc) << bad;
    const RecordedDance dance = read_recording(path);
    EXPECT_LE(dance.guests.size(), RecordedDance::kMostGuests);
    for (const std::string& guest : dance.guests) EXPECT_TRUE(GuestId::parse(guest)) << guest;
  }
}

TEST(RecordedDance, BoundsGuestsAndLength) {
  const TestFolder folder("many-guests");
  auto log = *LogWriter::create(folder.path("a.lcm"));
  const std::vector<std::uint8_t> data(8);
  for (int i = 0; i < 40; ++i)
    ASSERT_TRUE(
        log.append(1'790'000'000'000'000 + i, "POSE/stage/guest-" + std::to_string(i), data));
  ASSERT_TRUE(log.append(std::int64_t{1} << 62, "POSE/stage/late", data));
  ASSERT_TRUE(log.append(1, "POSE/stage/early", data));
  ASSERT_TRUE(log.flush());
  const RecordedDance dance = read_recording(folder.path("a.lcm"));
  EXPECT_EQ(dance.guests.size(), RecordedDance::kMostGuests);
  EXPECT_EQ(dance.length, Duration()) << "half a century is no dance";
}

}  // namespace
}  // namespace dance
