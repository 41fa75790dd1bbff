// A house's end and an engine's end of the same memory, in one test.
//
// Units/frames: as dance_adapter.h; times of this machine.
// Ownership:    the memory has a name of this process's own, and is gone with the object.
// Threads:      one.
// Failure:      what cannot be had fails the test.
#pragma once

#include <gtest/gtest.h>
#include <unistd.h>

#include <memory>
#include <string>

#include "consumers/engine/dance_adapter.h"
#include "consumers/engine/engine_consumer.h"
#include "core/net/mono_clock.h"

namespace dance {

template <class T>
T of_size() {
  T value{};
  value.struct_size = sizeof value;
  return value;
}

inline std::string memory_of_test() { return "t" + std::to_string(getpid()); }

class EngineHouse : public testing::Test {
 protected:
  void SetUp() override { open(); }
  void TearDown() override { dance_adapter_close(adapter_); }

  void open() {
    auto consumer = EngineConsumer::open(memory_of_test(), 0.0, this_clock_id(), mono_now());
    ASSERT_TRUE(consumer) << consumer.error().what;
    consumer_ = std::move(*consumer);
  }
  void show(const GuestId& guest, Pose pose, MonoTime captured, MonoTime staged) {
    pose.clock_id = this_clock_id();
    pose.capture_time = captured;
    pose.stamp(Hop::kStaged, staged);
    consumer_->on_pose(guest, pose, staged);
  }
  std::uint32_t slot_of(const char* id) {
    std::uint32_t slot = DANCE_MAX_GUESTS;
    EXPECT_EQ(dance_adapter_find(adapter_, id, &slot), DANCE_OK) << id;
    return slot;
  }

  const GuestId kAlice = *GuestId::parse("alice");
  const GuestId kBob = *GuestId::parse("bob");
  std::unique_ptr<EngineConsumer> consumer_;
  dance_adapter* adapter_ = dance_adapter_open(memory_of_test().c_str(), DANCE_AXES_GLTF);
};

}  // namespace dance
