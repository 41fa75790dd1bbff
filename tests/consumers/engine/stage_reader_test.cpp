// What an engine reads while poses come late, go back, or are being written.
#include <fcntl.h>
#include <gtest/gtest.h>
#include <sys/mman.h>
#include <unistd.h>

#include "formats/engine/shared_memory.h"
#include "tests/consumers/engine/engine_house.h"

namespace dance {
namespace {

class StageReaderTest : public EngineHouse {};

TEST_F(StageReaderTest, ADanceThatGoesBackALittleGoesOnFromThere) {
  const MonoTime begin = mono_now() - Duration::s(1);
  const auto show_at = [&](int captured_ms, int staged_ms) {
    show(kAlice, Pose(), begin + Duration::ms(captured_ms), begin + Duration::ms(staged_ms));
  };
  for (int ms = 0; ms <= 500; ms += 10) show_at(ms, ms);
  const std::uint32_t slot = slot_of("alice");
  auto pose = of_size<dance_pose>();
  const auto ask = [&](int ms) {
    EXPECT_EQ(dance_adapter_at(adapter_, slot, (begin + Duration::ms(ms)).since_zero_ns(), &pose),
              DANCE_OK);
    return Duration::ns(pose.capture_ns - begin.since_zero_ns());
  };
  EXPECT_EQ(ask(495), Duration::ms(495));
  // One that was overtaken is no other dance.
  show_at(480, 510);
  EXPECT_EQ(ask(495), Duration::ms(495));
  show_at(510, 510);
  for (int ms = 520; ms <= 560; ms += 10) {
    show_at(ms - 300, ms);
    ask(215);
  }
  EXPECT_EQ(ask(255), Duration::ms(255));
}

TEST_F(StageReaderTest, AfterAStallADancerIsAsLateAsBefore) {
  const MonoTime begin = mono_now() - Duration::s(5);
  const auto show_at = [&](int captured_ms, int staged_ms) {
    show(kAlice, Pose(), begin + Duration::ms(captured_ms), begin + Duration::ms(staged_ms));
  };
  int ms = 0;
  for (; ms < 2000; ms += 10) show_at(ms, ms + 20);
  for (const int burst = ms + 320; ms < burst - 20; ms += 10) show_at(ms, burst);
  const std::uint32_t slot = slot_of("alice");
  for (; ms < 2600; ms += 10) {
    show_at(ms, ms + 20);
    auto pose = of_size<dance_pose>();
    ASSERT_EQ(
        dance_adapter_at(adapter_, slot, (begin + Duration::ms(ms + 25)).since_zero_ns(), &pose),
        DANCE_OK);
    EXPECT_EQ(pose.capture_ns, (begin + Duration::ms(ms + 5)).since_zero_ns());
  }
}

TEST_F(StageReaderTest, ACallThatIsOvertakenEveryTimeSaysSoAndIsCounted) {
  const MonoTime now = mono_now();
  show(kAlice, Pose(), now - Duration::ms(20), now - Duration::ms(20));
  show(kAlice, Pose(), now - Duration::ms(10), now - Duration::ms(10));
  const std::uint32_t slot = slot_of("alice");
  // As a writer that stands still in the middle of each of them.
  const auto name = engine::memory_name(*GuestId::parse(memory_of_test()));
  const int fd = shm_open(name.c_str(), O_RDWR, 0);
  ASSERT_GE(fd, 0);
  void* memory = mmap(nullptr, sizeof(engine::Segment), PROT_READ | PROT_WRITE, MAP_SHARED, fd, 0);
  close(fd);
  ASSERT_NE(memory, MAP_FAILED);
  const auto stand_still = [&](std::uint32_t writing) {
    for (auto& entry : static_cast<engine::Segment*>(memory)->guests[writing].poses.entries)
      entry.version |= 1;
  };
  stand_still(slot);
  auto pose = of_size<dance_pose>();
  EXPECT_EQ(dance_adapter_at(adapter_, slot, now.since_zero_ns(), &pose), DANCE_BUSY);
  EXPECT_EQ(dance_adapter_at(adapter_, slot, (now - Duration::ms(15)).since_zero_ns(), &pose),
            DANCE_BUSY);
  EXPECT_EQ(dance_adapter_newest(adapter_, slot, &pose), DANCE_BUSY);
  auto counters = of_size<dance_counters>();
  ASSERT_EQ(dance_adapter_counters(adapter_, &counters), DANCE_OK);
  EXPECT_EQ(counters.busy, 3u);
  // One that is answered from what the reader had read before is not counted.
  show(kBob, Pose(), now - Duration::ms(20), now - Duration::ms(20));
  show(kBob, Pose(), now - Duration::ms(10), now - Duration::ms(10));
  const std::uint32_t other = slot_of("bob");
  const std::int64_t between_ns = (now - Duration::ms(15)).since_zero_ns();
  EXPECT_EQ(dance_adapter_at(adapter_, other, between_ns, &pose), DANCE_OK);
  stand_still(other);
  EXPECT_EQ(dance_adapter_at(adapter_, other, between_ns, &pose), DANCE_OK);
  ASSERT_EQ(dance_adapter_counters(adapter_, &counters), DANCE_OK);
  EXPECT_EQ(counters.busy, 3u);
  munmap(memory, sizeof(engine::Segment));
}

}  // namespace
}  // namespace dance
