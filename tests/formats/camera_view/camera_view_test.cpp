#include <gtest/gtest.h>

#include <algorithm>
#include <cstring>
#include <limits>
#include <memory>

#include "formats/camera_view/camera_view_reader.h"
#include "formats/camera_view/camera_view_writer.h"
#include "tests/allocation_guard.h"
#include "tests/formats/camera_view/drawn_view.h"

namespace dance {
namespace {

using Bytes = std::vector<std::uint8_t>;
using Fault = CameraViewReader::Fault;

Bytes view_record(const CameraFacts& facts, int width, int height, int seed) {
  const auto buffer = std::make_unique<CameraRecordBuffer>();
  const auto rgb = drawn_rgb(width, height, seed);
  const auto record = write_camera_view(facts, {width, height, rgb}, *buffer);
  return {record.begin(), record.end()};
}

Bytes status_record(const CameraStatus& status) {
  const auto buffer = std::make_unique<CameraRecordBuffer>();
  const auto record = write_camera_status(status, *buffer);
  return {record.begin(), record.end()};
}

void feed(CameraViewReader& reader, std::span<const std::uint8_t> bytes, std::size_t piece) {
  while (!bytes.empty() && reader.fault() == Fault::kNone) {
    const auto room = reader.room();
    const std::size_t count = std::min({piece, bytes.size(), room.size()});
    std::copy_n(bytes.begin(), count, room.begin());
    reader.add(count);
    bytes = bytes.subspan(count);
  }
}

Bytes joined(std::initializer_list<Bytes> parts) {
  Bytes all;
  for (const Bytes& part : parts) all.insert(all.end(), part.begin(), part.end());
  return all;
}

TEST(CameraView, ComesBackAsItWasWrittenInPiecesOfAnyLength) {
  CameraFacts facts = good_facts();
  facts.shake = 0.25f;
  facts.body.points[3].x = -1.5f;
  const Bytes record = view_record(facts, 320, 180, 5);
  for (const std::size_t piece :
       {std::size_t{1}, std::size_t{7}, std::size_t{4096}, record.size()}) {
    CameraViewReader reader;
    feed(reader, record, piece);
    ASSERT_TRUE(reader.take_view()) << piece;
    EXPECT_FALSE(reader.take_view()) << "once";
    EXPECT_EQ(reader.facts().time, facts.time);
    EXPECT_EQ(reader.facts().shake, 0.25f);
    EXPECT_EQ(reader.facts().light.spread, facts.light.spread);
    EXPECT_EQ(reader.facts().body.points[3].x, -1.5f);
    EXPECT_NEAR(reader.facts().body.points[30].visibility, 1.0f, 0.003f);
    const PreviewPicture picture = reader.picture();
    EXPECT_EQ(picture.width, 320);
    EXPECT_EQ(picture.height, 180);
    const auto rgb = drawn_rgb(320, 180, 5);
    EXPECT_TRUE(std::equal(rgb.begin(), rgb.end(), picture.rgb.begin(), picture.rgb.end()));
  }
}

TEST(CameraView, TheNewestOfSeveralWins) {
  CameraFacts later = good_facts();
  later.time += Duration::ms(100);
  CameraViewReader reader;
  feed(reader, joined({view_record(good_facts(), 64, 48, 1), view_record(later, 48, 64, 2)}),
       99999);
  ASSERT_TRUE(reader.take_view());
  EXPECT_FALSE(reader.take_view());
  EXPECT_EQ(reader.facts().time, later.time);
  EXPECT_EQ(reader.picture().height, 64);
  EXPECT_EQ(reader.picture().rgb[0], drawn_rgb(48, 64, 2)[0]);
}

TEST(CameraView, AStatusComesBackBetweenViews) {
  CameraStatus status = running_status();
  status.state = CameraState::kFailed;
  status.cause = CameraCause::kInUse;
  ASSERT_TRUE(status.words.assign("in use by cheese (77); close that"));
  CameraViewReader reader;
  feed(reader, joined({view_record(good_facts(), 8, 8, 1), status_record(status)}), 13);
  EXPECT_TRUE(reader.take_view());
  ASSERT_TRUE(reader.take_status());
  EXPECT_EQ(reader.status().state, CameraState::kFailed);
  EXPECT_EQ(reader.status().cause, CameraCause::kInUse);
  EXPECT_EQ(reader.status().name, status.name);
  EXPECT_EQ(reader.status().words, status.words);
  EXPECT_EQ(reader.status().width_px, 1280);
}

TEST(CameraView, BytesOfAnotherProgramEndTheReading) {
  CameraViewReader reader;
  const std::string text = "usage: dance capture [OPTIONS] [SOURCE]\n";
  feed(reader, Bytes(text.begin(), text.end()), 5);
  EXPECT_EQ(reader.fault(), Fault::kForeign);
  EXPECT_FALSE(reader.take_view());
}

TEST(CameraView, ARecordOfAnotherVersionEndsTheReading) {
  Bytes record = view_record(good_facts(), 8, 8, 1);
  record[4] = 2;
  CameraViewReader reader;
  feed(reader, record, record.size());
  EXPECT_EQ(reader.fault(), Fault::kOtherVersion);
}

TEST(CameraView, ARecordLongerThanAnyEndsTheReading) {
  Bytes record = view_record(good_facts(), 8, 8, 1);
  record[11] = 0x7f;
  CameraViewReader reader;
  feed(reader, record, record.size());
  EXPECT_EQ(reader.fault(), Fault::kForeign);
}

TEST(CameraView, AnUnknownKindIsSkipped) {
  Bytes unknown = view_record(good_facts(), 8, 8, 1);
  unknown[6] = 99;
  CameraViewReader reader;
  feed(reader, joined({unknown, view_record(good_facts(), 16, 8, 1)}), 40);
  ASSERT_TRUE(reader.take_view());
  EXPECT_EQ(reader.picture().width, 16);
  EXPECT_EQ(reader.invalid(), 0u);
}

// The numbers by their places in the body of a view: head 12, time 8, then floats.
TEST(CameraView, NumbersOutOfRangeAreLeftOutAndCounted) {
  const Bytes good = view_record(good_facts(), 8, 8, 1);
  const auto with_f32 = [&](std::size_t at, float value) {
    Bytes record = good;
    std::memcpy(record.data() + at, &value, sizeof value);
    return record;
  };
  const float nan = std::numeric_limits<float>::quiet_NaN();
  const std::size_t begin = 12 + 8;
  Bytes of_no_size = good;
  of_no_size[12 + kCameraViewFacts_bytes - 4] = 9;  // width: the bytes are fewer
  Bytes without_time = good;
  std::fill_n(without_time.begin() + 12, 8, std::uint8_t{0});
  const std::vector<Bytes> bad{with_f32(begin, nan),
                               with_f32(begin + 4, -1.0f),
                               with_f32(begin + 8, 1.01f),
                               with_f32(begin + 29, nan),
                               with_f32(begin + 29, 50.0f),
                               of_no_size,
                               without_time};
  CameraViewReader reader;
  for (const Bytes& record : bad) {
    feed(reader, record, record.size());
    EXPECT_FALSE(reader.take_view());
  }
  EXPECT_EQ(reader.invalid(), bad.size());
  feed(reader, good, good.size());
  EXPECT_TRUE(reader.take_view()) << "what follows is read";
}

TEST(CameraView, AStatusThatMovesTheCursorIsLeftOut) {
  Bytes record = status_record(running_status());
  record[record.size() - 5] = 0x1b;
  CameraViewReader reader;
  feed(reader, record, record.size());
  EXPECT_FALSE(reader.take_status());
  EXPECT_EQ(reader.invalid(), 1u);
}

TEST(CameraView, ReadingAllocatesNothing) {
  const Bytes all =
      joined({view_record(good_facts(), 320, 180, 1), status_record(running_status())});
  CameraViewReader reader;
  AllocationGuard guard;
  for (int i = 0; i < 10; ++i) feed(reader, all, 5000);
  EXPECT_EQ(guard.allocations(), 0u);
}

}  // namespace
}  // namespace dance
