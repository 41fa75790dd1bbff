// The recorder without a bus: what it keeps, and what it says when the disk is full.
#include <gtest/gtest.h>
#include <sys/resource.h>

#include <csignal>
#include <filesystem>
#include <fstream>

#include "apps/record/log_converter.h"
#include "apps/record/recorder.h"
#include "formats/log/unpacked_log.h"
#include "tests/formats/log/recorded_dance.h"
#include "tests/test_folder.h"

namespace dance {
namespace {

namespace fs = std::filesystem;

class RecorderTest : public ::testing::Test {
 protected:
  std::string path(const std::string& name) const { return folder_.path(name); }
  static RecordFilter filter(const std::vector<std::string>& patterns) {
    return *RecordFilter::make(patterns);
  }
  TestFolder folder_{"record"};
};

TEST(RecordFilter, PatternsMatchWholeNames) {
  auto filter = RecordFilter::make({"POSE/.*", "STATS/link"});
  ASSERT_TRUE(filter);
  for (int pass = 0; pass < 2; ++pass) {  // the second from memory
    EXPECT_TRUE(filter->wants("POSE/stage/bob"));
    EXPECT_TRUE(filter->wants("STATS/link"));
    EXPECT_FALSE(filter->wants("STATS/link2"));
    EXPECT_FALSE(filter->wants("XPOSE/stage/bob"));
    EXPECT_FALSE(filter->wants(""));
  }
}

TEST(RecordFilter, MatchesAllChannelsWithoutPatterns) {
  EXPECT_TRUE(RecordFilter::make({})->wants("x"));
}

TEST(RecordFilter, ABrokenPatternIsNamed) {
  const auto filter = RecordFilter::make({"POSE/(.*"});
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

class PackedRecording : public RecorderTest {
 protected:
  void record(const std::string& name, const OwnEvents& events, Recorder::Poses poses) const {
    auto recorder = Recorder::make(path(name), filter({}), Recorder::IfThere::kAppend, poses);
    ASSERT_TRUE(recorder) << recorder.error().what;
    for (const OwnEvent& event : events) recorder->take(event.time_us, event.channel, event.data);
    recorder->flush();
    ASSERT_FALSE(recorder->failure());
    EXPECT_EQ(recorder->packing().has_value(), poses == Recorder::Poses::kPacked);
    if (const auto packing = recorder->packing()) {
      EXPECT_EQ(packing->bytes, recorder->bytes());
      EXPECT_LT(packing->bytes, packing->plain_bytes / 2);
    }
  }
  std::string bytes_in(const std::string& name) const { return text_of(path(name)); }
};

TEST_F(PackedRecording, UnpackedIsByteForByteThePlainOne) {
  const OwnEvents evening = recorded_evening(320);
  record("plain.lcm", evening, Recorder::Poses::kPlain);
  record("packed.lcm", evening, Recorder::Poses::kPacked);
  const auto unpacked = convert_log(path("packed.lcm"), path("again.lcm"), LogForm::kPlain);
  ASSERT_TRUE(unpacked) << unpacked.error().what;
  EXPECT_TRUE(bytes_in("again.lcm") == bytes_in("plain.lcm"));
  EXPECT_TRUE(check_is_whole(*unpacked));

  const auto packed = convert_log(path("plain.lcm"), path("packed-later.lcm"), LogForm::kPacked);
  ASSERT_TRUE(packed) << packed.error().what;
  EXPECT_TRUE(bytes_in("packed-later.lcm") == bytes_in("packed.lcm"));
  const auto repacked = convert_log(path("packed.lcm"), path("packed-again.lcm"), LogForm::kPacked);
  ASSERT_TRUE(repacked) << repacked.error().what;
  EXPECT_TRUE(bytes_in("packed-again.lcm") == bytes_in("packed.lcm"));
  for (const auto& conversion : {*unpacked, *packed, *repacked}) {
    const std::string line = conversion_line(conversion);
    for (const std::string size : {"plain.lcm", "packed.lcm"})
      EXPECT_NE(line.find(" " + std::to_string(bytes_in(size).size()) + " bytes"),
                std::string::npos)
          << line;
  }
}

TEST_F(PackedRecording, GoesOnBehindAPackedLogThatWasCutOffAndBehindAPlainOne) {
  const OwnEvents evening = recorded_evening(20);
  record("log.lcm", evening, Recorder::Poses::kPacked);
  fs::resize_file(path("log.lcm"), fs::file_size(path("log.lcm")) - 2);  // killed in the middle
  record("log.lcm", evening, Recorder::Poses::kPacked);
  record("log.lcm", evening, Recorder::Poses::kPlain);
  record("log.lcm", evening, Recorder::Poses::kPacked);
  auto log = UnpackedLog::open(path("log.lcm"));
  ASSERT_TRUE(log);
  OwnEvents back;
  while (const auto event = log->next()) back.emplace_back(*event);
  OwnEvents expected(evening.begin(), evening.end() - 1);
  for (int run = 0; run < 3; ++run) expected.insert(expected.end(), evening.begin(), evening.end());
  EXPECT_TRUE(back == expected);
  EXPECT_EQ(log->unpacking().lost(), 0u);
}

TEST_F(PackedRecording, OfADamagedOneAllTheRestIsWrittenAndTheLossIsAnError) {
  record("packed.lcm", recorded_evening(20), Recorder::Poses::kPacked);
  {
    std::fstream file(path("packed.lcm"), std::ios::in | std::ios::out | std::ios::binary);
    file.seekp(static_cast<std::streamoff>(fs::file_size(path("packed.lcm")) / 2));
    file << std::string(40, 'x');  // beyond the number and time of one event, which no log protects
  }
  const auto conversion = convert_log(path("packed.lcm"), path("rest.lcm"), LogForm::kPlain);
  ASSERT_TRUE(conversion) << conversion.error().what;
  EXPECT_GT(conversion->events, 30u);
  EXPECT_GT(conversion->unpacking.lost() + conversion->skipped_bytes, 0u);
  const auto whole = check_is_whole(*conversion);
  ASSERT_FALSE(whole);
  for (const char* word : {"packed.lcm", "rest.lcm", "damaged"})
    EXPECT_NE(whole.error().what.find(word), std::string::npos) << whole.error().what;
  EXPECT_FALSE(convert_log(path("packed.lcm"), path("rest.lcm"), LogForm::kPlain)) << "is there";
  EXPECT_FALSE(convert_log(path("nothing.lcm"), path("nothing-plain.lcm"), LogForm::kPlain));
  EXPECT_FALSE(fs::exists(path("nothing-plain.lcm")));
}

TEST_F(PackedRecording, WhatIsNoLogOrEmptyIsAnErrorAndLeavesNothingInTheWayOfTheNextTry) {
  const OwnEvents evening = recorded_evening(20);
  record("evening.lcm", evening, Recorder::Poses::kPlain);
  std::ofstream(path("notes.txt")) << "Tuesday: tango. Wednesday: none. Thursday: salsa, twice.\n";
  std::ofstream(path("empty.lcm")).flush();
  for (const LogForm form : {LogForm::kPacked, LogForm::kPlain}) {
    const std::string to = path(form == LogForm::kPacked ? "packed.lcm" : "plain.lcm");
    for (const auto& [from, word] :
         {std::pair{"notes.txt", "no LCM log"}, {"empty.lcm", "empty"}}) {
      const auto refused = convert_log(path(from), to, form);
      ASSERT_FALSE(refused) << from;
      for (const std::string& part : {path(from), std::string(word)})
        EXPECT_NE(refused.error().what.find(part), std::string::npos) << refused.error().what;
      EXPECT_FALSE(fs::exists(to));
      EXPECT_FALSE(fs::exists(to + ".part"));
    }
    const auto conversion = convert_log(path("evening.lcm"), to, form);
    ASSERT_TRUE(conversion) << conversion.error().what;
    EXPECT_EQ(conversion->events, evening.size());
    EXPECT_FALSE(fs::exists(to + ".part"));
  }
}

TEST_F(PackedRecording, ADiskThatIsFullMidwayLeavesNoHalfLog) {
  record("packed.lcm", recorded_evening(320), Recorder::Poses::kPacked);
  // As in AFullDiskIsToldOnceAndNothingMoreIsWritten.
  const auto old_handler = std::signal(SIGXFSZ, SIG_IGN);
  rlimit old_limit{};
  getrlimit(RLIMIT_FSIZE, &old_limit);
  rlimit small = old_limit;
  small.rlim_cur = 100'000;
  setrlimit(RLIMIT_FSIZE, &small);
  const auto full = convert_log(path("packed.lcm"), path("plain.lcm"), LogForm::kPlain);
  setrlimit(RLIMIT_FSIZE, &old_limit);
  std::signal(SIGXFSZ, old_handler);
  ASSERT_FALSE(full);
  EXPECT_NE(full.error().what.find("plain.lcm"), std::string::npos) << full.error().what;
  EXPECT_FALSE(fs::exists(path("plain.lcm")));
  EXPECT_FALSE(fs::exists(path("plain.lcm.part")));
  EXPECT_TRUE(convert_log(path("packed.lcm"), path("plain.lcm"), LogForm::kPlain));
}

TEST_F(PackedRecording, SomebodyElsesPartFileIsLeftAlone) {
  record("evening.lcm", recorded_evening(20), Recorder::Poses::kPlain);
  std::ofstream(path("packed.lcm.part")) << "mine";
  const auto refused = convert_log(path("evening.lcm"), path("packed.lcm"), LogForm::kPacked);
  ASSERT_FALSE(refused);
  EXPECT_NE(refused.error().what.find("packed.lcm.part"), std::string::npos);
  EXPECT_EQ(bytes_in("packed.lcm.part"), "mine");
}

TEST_F(PackedRecording, PackSaysWhenItsInputHoldsPackedEventsAsUnpackWillNotGiveThatFileBack) {
  const OwnEvents evening = recorded_evening(20);
  record("packed.lcm", evening, Recorder::Poses::kPacked);
  // As a plain recorder hears it while somebody plays that log onto the bus.
  OwnEvents heard;
  auto log = LogReader::open(path("packed.lcm"));
  ASSERT_TRUE(log);
  while (const auto event = log->next()) heard.emplace_back(*event);
  record("heard.lcm", heard, Recorder::Poses::kPlain);

  const auto packed = convert_log(path("heard.lcm"), path("heard-packed.lcm"), LogForm::kPacked);
  ASSERT_TRUE(packed) << packed.error().what;
  EXPECT_NE(packed_before(*packed).find("heard.lcm"), std::string::npos);
  const auto again = convert_log(path("heard-packed.lcm"), path("again.lcm"), LogForm::kPlain);
  ASSERT_TRUE(again) << again.error().what;
  EXPECT_EQ(packed_before(*again), "") << "nobody is surprised that unpacking unpacks";
  EXPECT_FALSE(bytes_in("again.lcm") == bytes_in("heard.lcm"));

  record("plain.lcm", evening, Recorder::Poses::kPlain);
  const auto fresh = convert_log(path("plain.lcm"), path("fresh.lcm"), LogForm::kPacked);
  ASSERT_TRUE(fresh) << fresh.error().what;
  EXPECT_EQ(packed_before(*fresh), "");
}

}  // namespace
}  // namespace dance
