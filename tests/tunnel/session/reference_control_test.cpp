// What an encoder is told to refer to.
#include "tunnel/session/reference_control.h"

#include <gtest/gtest.h>

#include <vector>

namespace dance {
namespace {

constexpr MonoTime kControlTime = MonoTime::from_us(5'000'000);
constexpr Duration kFrame = Duration::us(16'667);

class RecordingEncoder final : public PoseEncoder {
 public:
  CodecName name() const override { return {}; }
  std::size_t encode(const Pose&, std::span<std::uint8_t>) override { return 1; }
  void acknowledged(std::uint32_t sequence) override { acked.push_back(sequence); }
  void base_acknowledged(std::uint32_t sequence) override { base_acked.push_back(sequence); }
  void request_intra() override { ++intra_frames; }
  void request_refresh() override { ++stills; }
  void request_base() override { ++bases; }
  void restart() override { ++restarts; }
  void set_references(References to) override { references = to; }

  std::vector<std::uint32_t> acked, base_acked;
  int intra_frames = 0, stills = 0, bases = 0, restarts = 0;
  References references = References::kPrevious;
};

class ReferenceControlTest : public ::testing::Test {
 protected:
  void send(std::uint32_t sequence, bool is_intra = false) {
    now = now + kFrame;
    control.prepare(encoder, now, Duration(), now);
    control.note_sent(sequence, is_intra, now);
  }
  static wire::GuestFeedback feedback_of(std::uint16_t newest, std::uint16_t before) {
    wire::GuestFeedback about;
    about.has_acked = true;
    about.newest_acked = newest;
    about.acked_before = before;
    return about;
  }

  MonoTime now = kControlTime;
  RecordingEncoder encoder;
  ReferenceControl control;
};

TEST_F(ReferenceControlTest, TellsTheEncoderOnceOfEachFrameThatWasSentAndAllHave) {
  control.begin(encoder);
  EXPECT_EQ(encoder.references, References::kPreviousTwice);
  for (std::uint32_t i = 65534; i <= 65538; ++i) send(i);
  EXPECT_FALSE(control.take(feedback_of(2, 0b111), {}, encoder, now));
  EXPECT_EQ(encoder.acked, (std::vector<std::uint32_t>{65535, 65536, 65537, 65538}))
      << "whole sequences through the wrap of the low half";
  control.take(feedback_of(2, 0b111), {}, encoder, now);
  EXPECT_EQ(encoder.acked.size(), 4u) << "each once";
  control.take(feedback_of(40, 0), {}, encoder, now);
  EXPECT_EQ(control.acked(), 4u) << "40 was never sent";
}

TEST_F(ReferenceControlTest, FeedbackAboutAnotherStreamTellsOfNoFrames) {
  send(1);
  wire::GuestFeedback about = feedback_of(1, 0);
  about.restarts = 9;
  control.take(about, {}, encoder, now);
  EXPECT_TRUE(encoder.acked.empty());
}

TEST_F(ReferenceControlTest, AProducerThatBeginsAnewHasNothingToReferTo) {
  send(1);
  control.take(feedback_of(1, 0), {}, encoder, now);
  control.restart(encoder, 1);
  EXPECT_EQ(encoder.restarts, 1);
  EXPECT_FALSE(control.acked_frames().is_of(0));
}

TEST_F(ReferenceControlTest, EachChangeOfTheRequestCounterAsksForOneIntraFrame) {
  wire::GuestFeedback about;
  about.intra_frames = 3;
  EXPECT_TRUE(control.take(about, {}, encoder, now));
  EXPECT_FALSE(control.take(about, {}, encoder, now));
  EXPECT_EQ(encoder.intra_frames, 1);
}

TEST_F(ReferenceControlTest, MakesEachSecondPoseABaseFrameWhereReceiversWantHalf) {
  wire::GuestFeedback about;
  about.base_log2 = 1;
  control.take(about, {}, encoder, now);
  for (std::uint32_t i = 1; i <= 8; ++i) send(i);
  EXPECT_EQ(encoder.bases, 4);
}

TEST_F(ReferenceControlTest, MakesAnIntraFrameAsOftenAsReceiversWantOneAndWhenTheLastIsOld) {
  wire::GuestFeedback about;
  about.intra_log2 = 2;
  control.take(about, {}, encoder, now);
  send(1, true);
  for (std::uint32_t i = 2; i <= 4; ++i) send(i);
  EXPECT_EQ(encoder.stills, 0);
  send(5, true);
  EXPECT_EQ(encoder.stills, 1) << "the fourth after it";
  now = now + Duration::s(3);
  send(6);
  EXPECT_EQ(encoder.stills, 2) << "the newest is three seconds old";
}

TEST_F(ReferenceControlTest, RefreshesWithAnIntraFrameEachPeriod) {
  int frames = 0;
  for (; now < kControlTime + Duration::s(5); now = now + kFrame, ++frames)
    control.prepare(encoder, now, Duration::s(2), now);
  EXPECT_EQ(encoder.intra_frames, 2);
}

TEST_F(ReferenceControlTest, TurnsToAcknowledgedFramesWhileReceiversTellOfNothing) {
  send(1);
  control.take(feedback_of(1, 0), {}, encoder, now);
  for (std::uint32_t i = 2; i <= 12; ++i) send(i);
  EXPECT_EQ(encoder.references, References::kAcknowledged);
}

FrameWindow frames_of(std::initializer_list<std::uint16_t> sequences, std::uint32_t stream = 5) {
  FrameWindow frames;
  for (const std::uint16_t sequence : sequences) frames.add(stream, sequence);
  return frames;
}

TEST(ReceiverSummary, SaysWhatAllReceiversHaveInCommon) {
  ReceiverSummary summary(true, 5, 10);
  summary.add(1, frames_of({7, 8, 9, 10}));
  summary.add(1, frames_of({7, 9}));
  summary.add(0, frames_of({1})) /* wants nothing */;
  wire::GuestFeedback about;
  summary.fill(about);
  ASSERT_TRUE(about.has_acked);
  EXPECT_EQ(about.newest_acked, 9);
  EXPECT_EQ(about.acked_before, 0b10) << "7, but not 8";
  EXPECT_FALSE(about.has_base_acked);
}

TEST(ReceiverSummary, WhoHasNothingOfTheStreamIsNotWaitedFor) {
  ReceiverSummary summary(true, 5, 200);
  summary.add(1, frames_of({199, 200}));
  summary.add(1, frames_of({199, 200}, 4));
  summary.add(1, frames_of({100}));
  wire::GuestFeedback about;
  summary.fill(about);
  EXPECT_EQ(about.newest_acked, 200);
}

TEST(ReceiverSummary, TellsWhatTheMostEagerOfThoseWithLessWants) {
  ReceiverSummary summary(true, 5, 10);
  summary.add(1, frames_of({8, 9, 10}));
  summary.add(2, frames_of({8, 10}));
  summary.add(8, frames_of({8}));
  summary.add(16, {});
  summary.add(100, {});
  wire::GuestFeedback about;
  summary.fill(about);
  EXPECT_EQ(about.base_log2, 1);
  EXPECT_EQ(about.intra_log2, 4);
  EXPECT_EQ(about.newest_acked, 10) << "of those who get all";
  ASSERT_TRUE(about.has_base_acked);
  EXPECT_EQ(about.newest_base_acked, 8);
}

}  // namespace
}  // namespace dance
