// LCM logs, whole and damaged.
#include "formats/log/log_file.h"

#include <gtest/gtest.h>

#include <algorithm>
#include <cerrno>
#include <cstdio>
#include <filesystem>
#include <fstream>
#include <string>
#include <vector>

#include "tests/test_folder.h"

namespace dance {
namespace {

namespace fs = std::filesystem;
using Bytes = std::vector<std::uint8_t>;

class LogFile : public ::testing::Test {
 protected:
  std::string path(const std::string& name) const { return folder_.path(name); }

  // A log of `count` events; event i is on "CH/i" at 1000 i µs and carries i bytes of value i.
  std::string write_log(const std::string& name, int count) const {
    auto writer = LogWriter::create(path(name));
    EXPECT_TRUE(writer);
    for (int i = 0; i < count; ++i) {
      const Bytes data(static_cast<std::size_t>(i), static_cast<std::uint8_t>(i));
      EXPECT_TRUE(writer->append(1000 * i, "CH/" + std::to_string(i), data));
    }
    EXPECT_TRUE(writer->flush());
    EXPECT_EQ(writer->events(), static_cast<std::uint64_t>(count));
    EXPECT_EQ(writer->bytes(), fs::file_size(path(name)));
    return path(name);
  }

  TestFolder folder_{"log-file"};
};

std::size_t count_events(LogReader& reader) {
  std::size_t count = 0;
  while (reader.next()) ++count;
  return count;
}

void put_u32(Bytes& bytes, std::size_t at, std::uint32_t value) {
  for (std::size_t i = 0; i < 4; ++i)
    bytes[at + i] = static_cast<std::uint8_t>(value >> (8 * (3 - i)));
}

TEST_F(LogFile, EventsComeBackAsTheyWereWritten) {
  auto reader = LogReader::open(write_log("a.lcm", 200));
  ASSERT_TRUE(reader);
  for (int pass = 0; pass < 2; ++pass) {
    for (int i = 0; i < 200; ++i) {
      const auto event = reader->next();
      ASSERT_TRUE(event);
      EXPECT_EQ(event->time_us, 1000 * i);
      EXPECT_EQ(event->channel, "CH/" + std::to_string(i));
      ASSERT_EQ(event->data.size(), static_cast<std::size_t>(i));
      for (const std::uint8_t byte : event->data) EXPECT_EQ(byte, i);
    }
    EXPECT_FALSE(reader->next());
    EXPECT_EQ(reader->skipped_bytes(), 0u);
    reader->rewind();
  }
}

TEST_F(LogFile, NegativeAndHugeTimesSurvive) {
  auto writer = LogWriter::create(path("t.lcm"));
  ASSERT_TRUE(writer);
  for (const std::int64_t time : {INT64_MIN, std::int64_t{-1}, INT64_MAX})
    ASSERT_TRUE(writer->append(time, "T", {}));
  ASSERT_TRUE(writer->flush());
  auto reader = LogReader::open(path("t.lcm"));
  ASSERT_TRUE(reader);
  for (const std::int64_t time : {INT64_MIN, std::int64_t{-1}, INT64_MAX}) {
    const auto event = reader->next();
    ASSERT_TRUE(event);
    EXPECT_EQ(event->time_us, time);
  }
}

TEST_F(LogFile, AnExistingFileIsNotOverwritten) {
  const std::string name = write_log("a.lcm", 3);
  const auto writer = LogWriter::create(name);
  ASSERT_FALSE(writer);
  EXPECT_NE(writer.error().what.find(name), std::string::npos);
  EXPECT_NE(writer.error().what.find("there already"), std::string::npos);
  auto reader = LogReader::open(name);
  EXPECT_EQ(count_events(*reader), 3u);
}

TEST_F(LogFile, WhatCannotBeOpenedIsNamed) {
  const auto missing = LogReader::open(path("nothing.lcm"));
  ASSERT_FALSE(missing);
  EXPECT_NE(missing.error().what.find("nothing.lcm"), std::string::npos);
  const auto directory = LogReader::open(folder_.path());
  ASSERT_FALSE(directory);
  EXPECT_NE(directory.error().what.find("folder"), std::string::npos);
}

TEST_F(LogFile, EventsThatDoNotFitTheFormatAreRefused) {
  auto writer = LogWriter::create(path("x.lcm"));
  ASSERT_TRUE(writer);
  EXPECT_FALSE(writer->append(0, "", {}));
  EXPECT_FALSE(writer->append(0, std::string(64, 'x'), {}));
  EXPECT_TRUE(writer->append(0, std::string(63, 'x'), {}));
  EXPECT_EQ(writer->events(), 1u);
}

TEST_F(LogFile, EveryPrefixGivesItsWholeEvents) {
  const Bytes bytes = bytes_in(write_log("a.lcm", 20));
  std::vector<std::size_t> ends;  // where each event ends
  for (int i = 0; i < 20; ++i) {
    const std::size_t channel = 3 + std::to_string(i).size();
    ends.push_back((ends.empty() ? 0 : ends.back()) + 28 + channel + static_cast<std::size_t>(i));
  }
  ASSERT_EQ(ends.back(), bytes.size());
  for (std::size_t size = 0; size <= bytes.size(); ++size) {
    std::size_t whole = 0;
    while (whole < ends.size() && ends[whole] <= size) ++whole;
    LogReader reader = LogReader::over({bytes.data(), size});
    ASSERT_EQ(count_events(reader), whole) << size;
    EXPECT_EQ(reader.skipped_bytes(), size - (whole ? ends[whole - 1] : 0)) << size;
  }
}

TEST_F(LogFile, ADamagedEventCostsNoOther) {
  const Bytes bytes = bytes_in(write_log("a.lcm", 12));
  for (std::size_t bit = 0; bit < 8 * bytes.size(); ++bit) {
    Bytes damaged = bytes;
    damaged[bit / 8] = static_cast<std::uint8_t>(damaged[bit / 8] ^ (1u << (bit % 8)));
    LogReader reader = LogReader::over(damaged);
    std::size_t count = 0, used = 0;
    while (const auto event = reader.next()) {
      ++count;
      used += 28 + event->channel.size() + event->data.size();
    }
    ASSERT_EQ(used + reader.skipped_bytes(), bytes.size()) << "bit " << bit;
    ASSERT_GE(count, 11u) << "bit " << bit;
  }
}

TEST_F(LogFile, RubbishBetweenEventsIsSkippedAndCounted) {
  const Bytes one = bytes_in(write_log("a.lcm", 1));
  Bytes bytes(1000, 0x5a);
  bytes.insert(bytes.end(), one.begin(), one.end());
  bytes.insert(bytes.end(), {0xED, 0xA1, 0xDA});  // nearly a sync word
  bytes.insert(bytes.end(), one.begin(), one.end());
  LogReader reader = LogReader::over(bytes);
  EXPECT_EQ(count_events(reader), 2u);
  EXPECT_EQ(reader.skipped_bytes(), 1003u);
}

TEST_F(LogFile, LyingLengthsAreNotBelieved) {
  const Bytes two = [&] {
    Bytes bytes = bytes_in(write_log("a.lcm", 1));
    const Bytes again = bytes;
    bytes.insert(bytes.end(), again.begin(), again.end());
    return bytes;
  }();
  for (const std::uint32_t lie : {0u, 64u, 0x7fffffffu, 0x80000000u, 0xffffffffu}) {
    Bytes bytes = two;
    put_u32(bytes, 20, lie);
    LogReader channel_lie = LogReader::over(bytes);
    EXPECT_EQ(count_events(channel_lie), 1u) << "channel length " << lie;
  }
  for (const std::uint32_t lie :
       {(32u << 20) + 1, 32u << 20, 0x7fffffffu, 0x80000000u, 0xffffffffu}) {
    Bytes bytes = two;
    put_u32(bytes, 24, lie);
    LogReader data_lie = LogReader::over(bytes);
    EXPECT_EQ(count_events(data_lie), 1u) << "data length " << lie;
  }
}

// A file on a disk that fails behind its first bytes.
struct FailingDisk {
  Bytes bytes;
  std::size_t at = 0;
  bool fails = true;

  static ssize_t read(void* cookie, char* out, std::size_t size) {
    auto& disk = *static_cast<FailingDisk*>(cookie);
    const std::size_t left = disk.bytes.size() - disk.at;
    if (left == 0 && disk.fails) {
      errno = EIO;
      return -1;
    }
    const std::size_t got = std::min({size, left, std::size_t{100}});
    std::copy_n(disk.bytes.begin() + static_cast<std::ptrdiff_t>(disk.at), got, out);
    disk.at += got;
    return static_cast<ssize_t>(got);
  }
  static int seek(void* cookie, off64_t* offset, int) {
    static_cast<FailingDisk*>(cookie)->at = static_cast<std::size_t>(*offset);
    return 0;
  }
  LogReader open() {
    return LogReader::of(fopencookie(this, "rb", {read, nullptr, seek, nullptr}), "worn.lcm");
  }
};

TEST_F(LogFile, ADiskThatFailsIsNoEnd) {
  const Bytes whole = bytes_in(write_log("a.lcm", 20));
  for (const std::size_t size : {std::size_t{0}, std::size_t{10}, whole.size() - 5, whole.size()}) {
    FailingDisk disk{{whole.begin(), whole.begin() + static_cast<std::ptrdiff_t>(size)}};
    LogReader reader = disk.open();
    LogReader cut = LogReader::over(disk.bytes);
    EXPECT_EQ(count_events(reader), count_events(cut)) << "what could be read is had";
    EXPECT_TRUE(cut.ended());
    const auto ended = reader.ended();
    ASSERT_FALSE(ended) << size;
    EXPECT_NE(ended.error().what.find("worn.lcm"), std::string::npos) << ended.error().what;
    EXPECT_NE(ended.error().what.find("Input/output error"), std::string::npos);
    // A second try, that goes well.
    disk.fails = false;
    reader.rewind();
    EXPECT_EQ(count_events(reader), size == whole.size() ? 20u : size < 40 ? 0u : 19u);
    EXPECT_TRUE(reader.ended());
  }
}

TEST_F(LogFile, AFileThatTheKernelDoesNotReadIsSaid) {
  auto reader = LogReader::open("/proc/self/mem");  // at address 0, where nothing is
  ASSERT_TRUE(reader) << reader.error().what;
  EXPECT_FALSE(reader->next());
  EXPECT_FALSE(reader->ended());
}

TEST_F(LogFile, AFileOfSyncWordsThatPromiseMuchIsReadOnce) {
  // Each word looks like an event of 32 MiB that is not there: a reader that starts over for each
  // of them would take hours; CTest's time limit is the bound.
  Bytes bytes;
  for (int i = 0; i < 40'000; ++i) {
    Bytes header(28, 0);
    put_u32(header, 0, 0xEDA1DA01);
    put_u32(header, 20, 1);
    put_u32(header, 24, 32u << 20);
    bytes.insert(bytes.end(), header.begin(), header.end());
  }
  {
    std::ofstream file(path("sync.lcm"), std::ios::binary);
    file.write(reinterpret_cast<const char*>(bytes.data()),
               static_cast<std::streamsize>(bytes.size()));
  }
  auto reader = LogReader::open(path("sync.lcm"));
  ASSERT_TRUE(reader);
  EXPECT_EQ(count_events(*reader), 0u);
  EXPECT_EQ(reader->skipped_bytes(), bytes.size());
}

}  // namespace
}  // namespace dance
