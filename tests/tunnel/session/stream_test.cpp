// One session's records, both ways.
#include "tunnel/session/stream.h"

#include <gtest/gtest.h>

namespace dance {
namespace {

class StreamTest : public ::testing::Test {
 protected:
  void add(Stream& stream, std::uint32_t sequence) {
    const std::array<std::uint8_t, 10> payload{};
    wire::Record record;
    record.sequence = sequence;
    record.capture_us = 4'990'000;
    record.payload = payload;
    stream.bundle.add(record, false, 5'000'000, {});
    stream.sent.add({record.stream, static_cast<std::uint16_t>(sequence), record.slot});
  }
  wire::RecordsHeader sent_by(Stream& stream, bool with_records) {
    wire::RecordsHeader header;
    const wire::Bytes bytes = stream.write(header, with_records, buffer);
    ByteReader in(bytes);
    return wire::parse_records_header(in).value_or(wire::RecordsHeader{});
  }
  std::array<std::uint8_t, wire::kMaxPlain> buffer{};
};

TEST_F(StreamTest, CountsItsDatagramsAndSaysWhichHaveRecords) {
  Stream stream;
  add(stream, 1);
  const wire::RecordsHeader bare = sent_by(stream, false);
  EXPECT_EQ(bare.number, 0);
  EXPECT_FALSE(bare.has_records);
  const wire::RecordsHeader full = sent_by(stream, true);
  EXPECT_EQ(full.number, 1);
  EXPECT_TRUE(full.has_records);
  EXPECT_FALSE(sent_by(stream, true).has_records) << "they have left";
}

TEST_F(StreamTest, AnAcknowledgementOfTheOtherEndGivesBackTheFramesItWasSent) {
  Stream here;
  Stream there;
  add(here, 41);
  there.received.note(sent_by(here, true).number);
  wire::RecordsHeader answer;
  there.received.tell(answer, MonoTime::from_us(1));
  std::uint32_t frames = 0, sequence = 0;
  EXPECT_TRUE(here.sent.acknowledge(answer.acks, [&](const SentRing::Frame& frame) {
    ++frames;
    sequence = frame.sequence;
  }));
  EXPECT_EQ(frames, 1u);
  EXPECT_EQ(sequence, 41u);
}

TEST_F(StreamTest, ANewSessionBeginsWithNothingOfTheOneBefore) {
  Stream stream;
  add(stream, 1);
  (void)sent_by(stream, true);
  add(stream, 2);
  stream.received.note(77);
  stream.received.owe(MonoTime::from_us(1), false, MonoTime::from_us(1));
  stream = Stream();
  EXPECT_TRUE(stream.bundle.is_empty());
  EXPECT_FALSE(stream.received.has_any());
  EXPECT_FALSE(stream.received.owes());
  EXPECT_EQ(sent_by(stream, true).number, 0);
  wire::Acks acks;
  acks.newest = 1;
  EXPECT_FALSE(stream.sent.acknowledge(acks, [](const SentRing::Frame&) {}));
}

}  // namespace
}  // namespace dance
