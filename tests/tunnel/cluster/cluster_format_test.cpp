#include "tunnel/cluster/cluster_format.h"

#include <gtest/gtest.h>

#include "core/base/random.h"
#include "tests/tunnel/cluster/cluster_samples.h"
#include "tunnel/cluster/cluster_names.h"

namespace dance {
namespace {

using cluster_samples::bytes_of;

TEST(ClusterFormat, ReadsWhatItWrites) {
  for (const cluster::Message& message : cluster_samples::messages()) {
    const auto bytes = bytes_of(message);
    ASSERT_FALSE(bytes.empty()) << message.index();
    const auto read = cluster::parse_message(bytes);
    ASSERT_TRUE(read) << message.index();
    EXPECT_EQ(read->index(), message.index());
    EXPECT_EQ(bytes_of(*read), bytes);
  }
  for (const cluster::Value& value : cluster_samples::values()) {
    const auto bytes = bytes_of(value);
    ASSERT_FALSE(bytes.empty()) << value.index();
    const auto read = cluster::parse_value(bytes);
    ASSERT_TRUE(read) << value.index();
    EXPECT_EQ(bytes_of(*read), bytes);
  }
}

TEST(ClusterFormat, KeepsEveryFieldOfARecord) {
  const auto message = cluster_samples::record();
  const auto bytes = bytes_of(cluster::Message(message));
  const auto read = cluster::parse_message(bytes);
  ASSERT_TRUE(read);
  const auto& record = std::get<cluster::RecordMessage>(*read).record;
  EXPECT_EQ(record.kind, message.record.kind);
  EXPECT_EQ(record.stream, message.record.stream & 0xffff) << "the generation is each server's own";
  EXPECT_EQ(record.sequence, message.record.sequence);
  EXPECT_EQ(record.capture_us, message.record.capture_us);
  EXPECT_EQ(record.published_age_us, message.record.published_age_us);
  EXPECT_EQ(record.sent_age_us, message.record.sent_age_us);
  EXPECT_EQ(record.server_age_us, message.record.server_age_us);
  EXPECT_EQ(record.is_intra, message.record.is_intra);
  EXPECT_EQ(record.is_base, message.record.is_base);
  EXPECT_TRUE(std::ranges::equal(record.payload, message.record.payload));
}

TEST(ClusterFormat, KeepsEveryFieldOfAVoice) {
  const auto message = cluster_samples::voice();
  const auto bytes = bytes_of(cluster::Message(message));
  // 13 and 14 are server and token, 7,654,321 the sequence, 9,876,543,210 µs the capture.
  const std::vector<std::uint8_t> golden{1,    8,    13, 0, 0, 0, 0,    0,    0,    0, 14,   0,
                                         0,    0,    0,  0, 0, 0, 0xb1, 0xcb, 0x74, 0, 0xea, 0x16,
                                         0xb0, 0x4c, 2,  0, 0, 0, 31,   4,    8,    6, 4,    2};
  EXPECT_EQ(bytes, golden);
  const auto read = cluster::parse_message(bytes);
  ASSERT_TRUE(read);
  const auto& voice = std::get<cluster::VoiceMessage>(*read);
  EXPECT_EQ(voice.link_token, message.link_token);
  EXPECT_EQ(voice.record.sequence, message.record.sequence);
  EXPECT_EQ(voice.record.capture_us, message.record.capture_us);
  EXPECT_EQ(voice.record.level_dbfs, message.record.level_dbfs);
  EXPECT_TRUE(std::ranges::equal(voice.record.packet, message.record.packet));
}

TEST(ClusterFormat, KeepsTheKeyOfAGuest) {
  for (const OwnerKey& key : {OwnerKey{guest("alice"), false}, OwnerKey{guest("party"), true}}) {
    cluster::GuestValue value;
    value.server = 3;
    value.key = key;
    const auto read = cluster::parse_value(bytes_of(cluster::Value(value)));
    ASSERT_TRUE(read);
    EXPECT_EQ(std::get<cluster::GuestValue>(*read).key, key);
  }
}

// Version 1, written down: what a server of then says is understood for good.
TEST(ClusterFormat, GoldenBytes) {
  cluster::ClockQuestion question;
  question.server = 0x0102030405060708;
  question.asked_us = 1'000'000;
  const std::vector<std::uint8_t> golden{1, 2,    8,    7,    6, 5, 4, 3, 2,
                                         1, 0x40, 0x42, 0x0f, 0, 0, 0, 0, 0};
  EXPECT_EQ(bytes_of(cluster::Message(question)), golden);
  const cluster::Value value(cluster::StateValue{7, guest("ann"), 9, golden});
  std::vector<std::uint8_t> state{1, 18, 7, 0, 0, 0, 0, 0, 0, 0, 3, 'a', 'n', 'n', 9, 0, 0, 0};
  state.insert(state.end(), golden.begin(), golden.end());
  EXPECT_EQ(bytes_of(value), state);
}

TEST(ClusterFormat, RefusesWhatIsCutOffOrTooLong) {
  for (const cluster::Message& message : cluster_samples::messages()) {
    if (std::holds_alternative<cluster::RecordMessage>(message))
      continue;  // its payload is the rest
    auto bytes = bytes_of(message);
    for (std::size_t size = 0; size < bytes.size(); ++size)
      EXPECT_FALSE(cluster::parse_message(std::span(bytes).first(size))) << message.index();
    bytes.push_back(0);
    EXPECT_FALSE(cluster::parse_message(bytes)) << message.index();
  }
}

TEST(ClusterFormat, RefusesOtherVersionsAndTypes) {
  auto bytes = bytes_of(cluster_samples::messages().front());
  bytes[0] = 2;
  EXPECT_FALSE(cluster::parse_message(bytes));
  bytes[0] = 1;
  bytes[1] = 99;
  EXPECT_FALSE(cluster::parse_message(bytes));
  EXPECT_FALSE(cluster::parse_value(bytes_of(cluster_samples::messages().front())))
      << "a message is no value";
}

// Whatever is damaged is refused, or reads as something that can be written again.
TEST(ClusterFormat, DamageIsNeverMoreThanRefused) {
  Random random(7);
  for (const cluster::Message& message : cluster_samples::messages())
    for (int i = 0; i < 2000; ++i) {
      auto bytes = bytes_of(message);
      bytes[random.next_u64() % bytes.size()] ^= static_cast<std::uint8_t>(random.next_u64());
      const auto read = cluster::parse_message(bytes);
      EXPECT_TRUE(!read || !bytes_of(*read).empty());
    }
}

TEST(ClusterFormat, SubjectsAndKeysReadBack) {
  const auto subject = cluster::pose_subject(guest("salsa"), guest("alice-2"));
  EXPECT_EQ(subject.view(), "dance.1.pose.salsa.alice-2");
  const auto read = cluster::parse_pose_subject(subject.view());
  ASSERT_TRUE(read);
  EXPECT_EQ(read->room, guest("salsa"));
  EXPECT_EQ(read->guest, guest("alice-2"));
  for (const char* wrong : {"", "dance.1.pose.salsa", "dance.1.pose.salsa.a.b", "dance.1.pose.*.a",
                            "dance.1.pose.salsa.>", "dance.1.pose.SALSA.a", "dance.1.beat"})
    EXPECT_FALSE(cluster::parse_pose_subject(wrong)) << wrong;

  const std::string longest(24, 'x');
  for (const cluster::Key& key :
       {cluster::Key{cluster::KeyKind::kPresence, guest("salsa"), 0xabc, {}, 0},
        cluster::Key{cluster::KeyKind::kGuest, guest(longest), 0, guest(longest), 0},
        cluster::Key{cluster::KeyKind::kGuestState, guest(longest), 0, guest(longest), 13},
        cluster::Key{cluster::KeyKind::kRoomState, guest("salsa"), 0, {}, 1}}) {
    const auto text = cluster::text_of(key);
    const auto again = cluster::parse_key(text.view());
    ASSERT_TRUE(again) << text.view();
    EXPECT_EQ(cluster::text_of(*again), text);
    EXPECT_EQ(again->kind, key.kind);
  }
  for (const char* wrong :
       {"", "salsa", "salsa.at.12", "salsa.at.0000000000000000", "salsa.room.3", "salsa.room.1.x",
        "salsa.guest.A", "salsa.guest.a.b", "salsa.state.a", "salsa.state.a.14", "salsa.what.a"})
    EXPECT_FALSE(cluster::parse_key(wrong)) << wrong;
}

}  // namespace
}  // namespace dance
