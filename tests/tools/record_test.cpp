// The recorder without a bus: what it keeps, and what it says when the disk is full.
#include <gtest/gtest.h>
#include <sys/resource.h>
#include <unistd.h>

#include <csignal>
#include <filesystem>

#include "tools/recorder.h"

namespace dance {
namespace {

namespace fs = std::filesystem;

class RecorderTest : public ::testing::Test {
 protected:
  void SetUp() override {
    folder_ = fs::temp_directory_path() / ("dance-record-test-" + std::to_string(getpid()));
    fs::create_directories(folder_);
  }
  void TearDown() override { fs::remove_all(folder_); }
  std::string path(const std::string& name) const { return (folder_ / name).string(); }
  static ChannelFilter filter(const std::vector<std::string>& patterns) {
    return *ChannelFilter::make(patterns);
  }
  fs::path folder_;
};

TEST(ChannelFilter, PatternsMatchWholeNames) {
  auto filter = ChannelFilter::make({"POSE/.*", "STATS/link"});
  ASSERT_TRUE(filter);
  for (int pass = 0; pass < 2; ++pass) {  // the second from memory
    EXPECT_TRUE(filter->wants("POSE/stage/bob"));
    EXPECT_TRUE(filter->wants("STATS/link"));
    EXPECT_FALSE(filter->wants("STATS/link2"));
    EXPECT_FALSE(filter->wants("XPOSE/stage/bob"));
    EXPECT_FALSE(filter->wants(""));
  }
}

TEST(ChannelFilter, NoPatternsWantAll) { EXPECT_TRUE(ChannelFilter::make({})->wants("x")); }

TEST(ChannelFilter, ABrokenPatternIsNamed) {
  const auto filter = ChannelFilter::make({"POSE/(.*"});
  ASSERT_FALSE(filter);
  EXPECT_NE(filter.error().what.find("POSE/(.*"), std::string::npos);
}

TEST(DefaultLogPath, IsTheLocalTimeUnderLogs) {
  setenv("TZ", "UTC", 1);
  tzset();
  const auto when = std::chrono::system_clock::from_time_t(1'772'395'530);
  EXPECT_EQ(default_log_path(when), "logs/2026-03-01-200530.lcm");
}

TEST_F(RecorderTest, KeepsWhatTheFilterWantsInANewFolder) {
  {
    auto recorder = Recorder::make(path("a/b/log.lcm"), filter({"KEEP"}));
    ASSERT_TRUE(recorder) << recorder.error().what;
    const std::uint8_t data[] = {1, 2, 3};
    recorder->take(10, "KEEP", data);
    recorder->take(20, "DROP", data);
    recorder->take(30, "KEEP", {});
    recorder->flush();
    EXPECT_FALSE(recorder->failure());
    EXPECT_EQ(recorder->events(), 2u);
    EXPECT_EQ(recorder->bytes(), fs::file_size(path("a/b/log.lcm")));
  }
  auto reader = LogReader::open(path("a/b/log.lcm"));
  ASSERT_TRUE(reader);
  const auto first = reader->next();
  ASSERT_TRUE(first);
  EXPECT_EQ(first->time_us, 10);
  EXPECT_EQ(first->data.size(), 3u);
  const auto second = reader->next();
  ASSERT_TRUE(second);
  EXPECT_EQ(second->time_us, 30);
  EXPECT_FALSE(reader->next());
}

TEST_F(RecorderTest, DoesNotOverwrite) {
  ASSERT_TRUE(Recorder::make(path("log.lcm"), filter({})));
  const auto again = Recorder::make(path("log.lcm"), filter({}));
  ASSERT_FALSE(again);
  EXPECT_NE(again.error().what.find("log.lcm"), std::string::npos);
}

TEST_F(RecorderTest, GoesOnBehindALogThatWasCutOff) {
  const std::uint8_t data[] = {1, 2, 3};
  for (int run = 0; run < 3; ++run) {
    {
      auto recorder = Recorder::make(path("log.lcm"), filter({}), Recorder::IfThere::kAppend);
      ASSERT_TRUE(recorder) << recorder.error().what;
      recorder->take(run * 10, "A", data);
      recorder->take(run * 10 + 1, "B", data);
    }
    fs::resize_file(path("log.lcm"), fs::file_size(path("log.lcm")) - 2);  // killed in the middle
  }
  auto reader = LogReader::open(path("log.lcm"));
  ASSERT_TRUE(reader);
  std::vector<std::int64_t> times;
  while (const auto event = reader->next()) times.push_back(event->time_us);
  EXPECT_EQ(std::count(times.begin(), times.end(), 0), 1);
  EXPECT_EQ(std::count(times.begin(), times.end(), 20), 1);
}

TEST_F(RecorderTest, AFolderThatCannotBeMadeIsNamed) {
  ASSERT_TRUE(Recorder::make(path("file"), filter({})));
  const auto below_a_file = Recorder::make(path("file/log.lcm"), filter({}));
  ASSERT_FALSE(below_a_file);
  EXPECT_NE(below_a_file.error().what.find(path("file")), std::string::npos);
}

TEST_F(RecorderTest, AFullDiskIsToldOnceAndNothingMoreIsWritten) {
  // A limit on file sizes stands for the full disk: the same failing write().
  const auto old_handler = std::signal(SIGXFSZ, SIG_IGN);
  rlimit old_limit{};
  getrlimit(RLIMIT_FSIZE, &old_limit);
  auto recorder = Recorder::make(path("log.lcm"), filter({}));
  ASSERT_TRUE(recorder);
  rlimit small = old_limit;
  small.rlim_cur = 100'000;
  setrlimit(RLIMIT_FSIZE, &small);
  const std::vector<std::uint8_t> data(1000, 7);
  for (int i = 0; i < 1000 && !recorder->failure(); ++i) {
    recorder->take(i, "POSE", data);
    recorder->flush();
  }
  setrlimit(RLIMIT_FSIZE, &old_limit);
  std::signal(SIGXFSZ, old_handler);
  ASSERT_TRUE(recorder->failure());
  EXPECT_NE(recorder->failure()->what.find("log.lcm"), std::string::npos);
  const std::uint64_t events = recorder->events();
  recorder->take(0, "POSE", data);
  EXPECT_EQ(recorder->events(), events);
  // What was written before is whole.
  auto reader = LogReader::open(path("log.lcm"));
  ASSERT_TRUE(reader);
  std::uint64_t whole = 0;
  while (reader->next()) ++whole;
  EXPECT_GE(whole + 1, events);
  EXPECT_GT(whole, 90u);
}

}  // namespace
}  // namespace dance
