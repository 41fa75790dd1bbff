#include "formats/engine/shared_memory.h"

#include <fcntl.h>
#include <gtest/gtest.h>
#include <sys/mman.h>
#include <sys/stat.h>
#include <unistd.h>

#include <string>

#include "core/program/child_process.h"
#include "formats/engine/segment_writer.h"

namespace dance::engine {
namespace {

class SharedMemory : public testing::Test {
 protected:
  void TearDown() override { shm_unlink(memory_name(name_).c_str()); }
  // A file of that name and size which no house has made.
  void plant(off_t size, std::uint64_t magic = 0, std::uint32_t version = 0) {
    const int fd = shm_open(memory_name(name_).c_str(), O_RDWR | O_CREAT, 0600);
    ASSERT_GE(fd, 0);
    ASSERT_EQ(ftruncate(fd, size), 0);
    if (magic != 0) {
      ASSERT_EQ(pwrite(fd, &magic, sizeof magic, 0), 8);
      ASSERT_EQ(pwrite(fd, &version, sizeof version, 8), 4);
    }
    close(fd);
  }
  ino_t inode() {
    struct stat found {};
    return stat(("/dev/shm" + std::string(memory_name(name_).view())).c_str(), &found) == 0
               ? found.st_ino
               : 0;
  }

  GuestId name_ = *GuestId::parse("t" + std::to_string(getpid()));
};

TEST_F(SharedMemory, IsThisUsersAloneAndGoneInTheEnd) {
  {
    auto owned = OwnedSegment::open(name_);
    ASSERT_TRUE(owned) << owned.error().what;
    struct stat found {};
    ASSERT_EQ(stat(("/dev/shm" + std::string((*owned)->name().view())).c_str(), &found), 0);
    EXPECT_EQ(found.st_mode & 0777, 0600u);
    EXPECT_EQ(found.st_size, static_cast<off_t>(sizeof(Segment)));
  }
  EXPECT_EQ(inode(), 0u);
}

TEST_F(SharedMemory, ASecondHouseOfTheNameIsToldWhatToDo) {
  const auto first = OwnedSegment::open(name_);
  ASSERT_TRUE(first);
  const auto second = OwnedSegment::open(name_);
  ASSERT_FALSE(second);
  EXPECT_NE(second.error().what.find(name_.c_str()), std::string::npos);
  EXPECT_NE(second.error().what.find("another name"), std::string::npos);
  EXPECT_NE(inode(), 0u) << "the second took the first one's memory away";
}

TEST_F(SharedMemory, WhatAKilledHouseLeftIsUsedAgain) {
  plant(sizeof(Segment));
  const ino_t left = inode();
  const auto owned = OwnedSegment::open(name_);
  ASSERT_TRUE(owned) << owned.error().what;
  EXPECT_EQ(inode(), left);
}

TEST_F(SharedMemory, MemoryOfAnotherSizeIsReplacedAndNotCutOff) {
  for (const off_t size : {off_t{1}, off_t{4096}, static_cast<off_t>(sizeof(Segment)) * 2}) {
    plant(size);
    const int fd = shm_open(memory_name(name_).c_str(), O_RDONLY, 0);
    const auto owned = OwnedSegment::open(name_);
    ASSERT_TRUE(owned) << owned.error().what;
    struct stat found {};
    ASSERT_EQ(fstat(fd, &found), 0);
    EXPECT_EQ(found.st_size, size) << "who has it mapped would fall out of it";
    close(fd);
  }
}

TEST_F(SharedMemory, AReaderMapsOnlyWhatIsAHousesAndWhole) {
  using Look = SeenSegment::Look;
  SeenSegment seen(name_);
  EXPECT_EQ(seen.look(), Look::kNothing);
  plant(0);
  EXPECT_EQ(seen.look(), Look::kNothing) << "being made";
  plant(3);
  EXPECT_EQ(seen.look(), Look::kDamaged);
  plant(4096);
  EXPECT_EQ(seen.look(), Look::kNothing) << "being made";
  plant(4096, 0x4141414141414141);
  EXPECT_EQ(seen.look(), Look::kDamaged);
  plant(4096, kMagic, kVersion + 1);
  EXPECT_EQ(seen.look(), Look::kWrongVersion);
  plant(4096, kMagic, kVersion);
  EXPECT_EQ(seen.look(), Look::kDamaged) << "cut off";
  EXPECT_EQ(seen.segment(), nullptr);
  const auto owned = OwnedSegment::open(name_);
  ASSERT_TRUE(owned);
  SegmentWriter writer((*owned)->segment(), MonoTime::from_ns(1));
  EXPECT_EQ(seen.look(), Look::kNew);
  EXPECT_EQ(seen.look(), Look::kSame);
  ASSERT_NE(seen.segment(), nullptr);
  EXPECT_EQ(seen.segment()->header.magic.load(), kMagic);
}

// In a child, which is ended if it waits for the FIFO's other end.
template <class Opens>
bool comes_back(Opens&& opens) {
  auto child = ChildProcess::start_copy([&] { return opens() ? 0 : 1; });
  return child && child->wait(Duration::s(10)) && child->ended_well();
}

TEST_F(SharedMemory, NobodyWaitsForAFifoThatLiesInItsPlace) {
  const std::string path = "/dev/shm" + std::string(memory_name(name_).view());
  ASSERT_EQ(mkfifo(path.c_str(), 0600), 0);
  EXPECT_TRUE(comes_back([&] {
    SeenSegment seen(name_);
    return seen.look() == SeenSegment::Look::kDamaged && !seen.segment();
  }));
  EXPECT_TRUE(comes_back([&] { return !OwnedSegment::open(name_); }));
}

}  // namespace
}  // namespace dance::engine
