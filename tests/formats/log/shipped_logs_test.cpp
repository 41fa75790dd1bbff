// The recordings that come with the tree, as they were made: they decode to the very same messages,
// and logs/README.md says of them what is so.
#include <gtest/gtest.h>

#include <cmath>
#include <filesystem>
#include <fstream>
#include <iterator>
#include <map>

#include "core/bus/channel.h"
#include "core/bus/encode.h"
#include "formats/log/unpacked_log.h"

namespace dance {
namespace {

const std::string kFolder = DANCE_SOURCE_DIR "/logs/";

struct Content {
  std::map<std::string, int> messages;         // by channel
  std::uint64_t hash = 0xcbf29ce484222325ULL;  // FNV-1a of all channels and messages
  double musical_time_beats = 0.0;             // that alice's poses span
};

void add(std::uint64_t& hash, const void* data, std::size_t size) {
  for (std::size_t i = 0; i < size; ++i)
    hash = (hash ^ static_cast<const std::uint8_t*>(data)[i]) * 0x100000001b3ULL;
}

template <class Message>
bool decodes(const LogEvent& event, Message message) {
  return decode(event.data.data(), event.data.size(), message) == Decoded::kFine;
}

bool decodes(const LogEvent& event, const Channel& channel) {
  switch (channel.signal()) {
    case Signal::kPose:
      return decodes(event, Pose());
    case Signal::kHands:
      return decodes(event, Hands());
    case Signal::kSkeleton:
      return decodes(event, TimedSkeleton());
    case Signal::kBeat:
      return decodes(event, Beat());
    default:
      return false;
  }
}

Content content_of(const std::string& name) {
  Content content;
  auto log = UnpackedLog::open(kFolder + name);
  if (!log) {
    ADD_FAILURE() << log.error().what;
    return content;
  }
  double first_beats = NAN;
  while (const auto event = log->next()) {
    const auto channel = Channel::parse(event->channel);
    EXPECT_TRUE(channel && decodes(*event, *channel)) << event->channel;
    ++content.messages[std::string(event->channel)];
    add(content.hash, event->channel.data(), event->channel.size());
    add(content.hash, event->data.data(), event->data.size());
    if (event->channel != "POSE/capture/alice") continue;
    Pose pose;
    decode(event->data.data(), event->data.size(), pose);
    if (std::isnan(first_beats)) first_beats = pose.music_beats;
    content.musical_time_beats = pose.music_beats - first_beats;
  }
  EXPECT_EQ(log->skipped_bytes(), 0u);
  EXPECT_EQ(log->unpacking().lost(), 0u);
  return content;
}

TEST(ShippedLogs, DecodeToTheMessagesThatWereRecorded) {
  const Content plain = content_of("couple.lcm"), packed = content_of("couple-packed.lcm");
  EXPECT_EQ(plain.hash, 16512757803173691758u);
  EXPECT_EQ(packed.hash, 8303187257305782641u);
  // Eight beats and thirty-two, so that a player that begins again goes on with the dance.
  EXPECT_NEAR(plain.musical_time_beats, 8.0, 0.1);
  EXPECT_NEAR(packed.musical_time_beats, 32.0, 0.1);
}

TEST(ShippedLogs, HoldWhatTheirReadmeSays) {
  std::ifstream file(kFolder + "README.md");
  const std::string readme{std::istreambuf_iterator<char>(file), {}};
  const Content plain = content_of("couple.lcm"), packed = content_of("couple-packed.lcm");
  EXPECT_EQ(packed.messages.size(), plain.messages.size());
  for (const auto& [channel, count] : plain.messages) {
    const auto row = readme.find("| `" + channel + "` |");
    ASSERT_NE(row, std::string::npos) << channel;
    const auto end = "` | " + std::to_string(count) + " | " +
                     std::to_string(packed.messages.at(channel)) + " |\n";
    EXPECT_EQ(readme.substr(readme.find('\n', row) + 1 - end.size(), end.size()), end);
  }
  for (const char* name : {"couple.lcm", "couple-packed.lcm"}) {
    std::string bytes = std::to_string(std::filesystem::file_size(kFolder + name));
    bytes.insert(bytes.size() - 3, ",");
    const auto row = readme.find(std::string("| `") + name + "` |");
    ASSERT_NE(row, std::string::npos) << name;
    EXPECT_NE(readme.substr(row, readme.find('\n', row) - row).find("| " + bytes + " |"),
              std::string::npos)
        << name;
  }
}

}  // namespace
}  // namespace dance
