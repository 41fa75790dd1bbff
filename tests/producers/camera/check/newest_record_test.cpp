#include "producers/camera/check/newest_record.h"

#include <fcntl.h>
#include <gtest/gtest.h>
#include <unistd.h>

#include <csignal>

#include "formats/camera_view/camera_view_reader.h"
#include "tests/formats/camera_view/drawn_view.h"

namespace dance {
namespace {

class NewestRecordTest : public testing::Test {
 protected:
  void SetUp() override {
    std::signal(SIGPIPE, SIG_IGN);
    int ends[2];
    ASSERT_EQ(::pipe2(ends, O_CLOEXEC), 0);
    read_fd_ = ends[0];
    write_fd_ = ends[1];
    ::fcntl(read_fd_, F_SETFL, O_NONBLOCK);
  }
  void TearDown() override {
    if (read_fd_ >= 0) ::close(read_fd_);
    ::close(write_fd_);
  }
  void put_view(NewestRecord& out, int seed) {
    const auto rgb = drawn_rgb(320, 180, seed);
    CameraFacts facts = good_facts();
    facts.time = MonoTime::from_us(1'000'000 + seed);
    out.put(facts, {320, 180, rgb});
  }
  // What is in the pipe now; how many records of views that were.
  int read_all(NewestRecord& out, CameraViewReader& reader) {
    int views = 0;
    for (int turn = 0; turn < 1000; ++turn) {
      out.flush();
      const auto room = reader.room();
      const ssize_t count =
          ::read(read_fd_, room.data(), std::min<std::size_t>(room.size(), 30'000));
      if (count <= 0) return views;
      reader.add(static_cast<std::size_t>(count));
      if (reader.take_view()) ++views;
    }
    return views;
  }

  int read_fd_ = -1;
  int write_fd_ = -1;
};

TEST_F(NewestRecordTest, AReaderThatReadsGetsAll) {
  NewestRecord out(write_fd_);
  CameraViewReader reader;
  for (int i = 1; i <= 5; ++i) {
    put_view(out, i);
    EXPECT_EQ(read_all(out, reader), 1);
    EXPECT_EQ(reader.facts().time, MonoTime::from_us(1'000'000 + i));
  }
  EXPECT_EQ(out.left_out(), 0u);
}

TEST_F(NewestRecordTest, OneThatDoesNotReadHoldsNothingUpAndGetsTheNewestThen) {
  NewestRecord out(write_fd_);
  for (int i = 1; i <= 200; ++i) put_view(out, i);
  CameraViewReader reader;
  const int views = read_all(out, reader);
  EXPECT_EQ(reader.fault(), CameraViewReader::Fault::kNone);
  EXPECT_EQ(reader.facts().time, MonoTime::from_us(1'000'200));
  EXPECT_EQ(reader.picture().rgb[0], drawn_rgb(320, 180, 200)[0]);
  EXPECT_LE(views, 10) << "what the pipe held, and the newest";
  EXPECT_EQ(out.left_out() + static_cast<std::uint64_t>(views), 200u);
}

TEST_F(NewestRecordTest, AStatusIsNotLeftOutForAView) {
  NewestRecord out(write_fd_);
  for (int i = 1; i <= 50; ++i) put_view(out, i);
  CameraStatus gone = running_status();
  gone.state = CameraState::kUnplugged;
  out.put(gone);
  for (int i = 51; i <= 100; ++i) put_view(out, i);
  CameraViewReader reader;
  read_all(out, reader);
  EXPECT_TRUE(reader.take_status());
  EXPECT_EQ(reader.status().state, CameraState::kUnplugged);
}

TEST_F(NewestRecordTest, SaysThatItsReaderIsGone) {
  NewestRecord out(write_fd_);
  put_view(out, 1);
  EXPECT_FALSE(out.is_closed());
  ::close(read_fd_);
  read_fd_ = -1;
  put_view(out, 2);
  EXPECT_TRUE(out.is_closed());
}

}  // namespace
}  // namespace dance
