#include "core/bus/subscription.h"

#include <gtest/gtest.h>

#include <string>

#include "tests/core/bus/bus_help.h"

namespace dance {
namespace {

constexpr int kMany = 1000;

TEST(NewestSlots, KeepsASteadyChannelBesideMoreMadeUpOnesThanItHolds) {
  NewestSlots<int, int> slots;
  constexpr int kSteady = -1;
  const auto use = [&](int channel) {
    if (!slots.find(channel))
      slots.add(
          channel, [] { return 0; }, [](int, int) {});
  };
  use(kSteady);
  for (int made_up = 0; made_up < kMany; ++made_up) {
    use(made_up);
    if (made_up % 100 == 0) {
      EXPECT_NE(slots.find(kSteady), nullptr) << made_up;
    }
  }
  EXPECT_NE(slots.find(kMany - 1), nullptr);
  EXPECT_EQ(slots.find(0), nullptr) << "silent longest";
}

class NewestPoses {
 public:
  void take(const std::string& name, const Pose& pose) {
    MessageBuffer buffer;
    const std::size_t size = encode(pose, buffer);
    poses_.take({name, buffer.data(), size, MonoTime()}, counters);
  }
  void take_garbage(const std::string& name) {
    poses_.take({name, "garbage", 7, MonoTime()}, counters);
  }
  void deliver() { poses_.deliver(MonoTime()); }

  SignalCounters counters;
  std::vector<std::uint32_t> delivered;

 private:
  TypedSubscription<Pose> poses_{
      Where::kCapture,
      [this](const Channel&, const Pose& pose, MonoTime) { delivered.push_back(pose.sequence); },
      Delivery::kNewest};
};

TEST(TypedSubscription, GivesNoPlaceToChannelsWithoutADecodableMessage) {
  NewestPoses poses;
  poses.take("POSE/capture/alice", numbered(7));
  for (int i = 0; i < kMany; ++i) poses.take_garbage("POSE/capture/evil-" + std::to_string(i));
  poses.deliver();
  EXPECT_EQ(poses.delivered, std::vector<std::uint32_t>{7});
  EXPECT_EQ(poses.counters.undecodable, static_cast<std::uint64_t>(kMany));
  EXPECT_EQ(poses.counters.refused(), static_cast<std::uint64_t>(kMany));
}

TEST(TypedSubscription, DeliversASteadyGuestBesideMoreMadeUpGuestsThanItHolds) {
  NewestPoses poses;
  for (std::uint32_t turn = 0; turn < 10; ++turn) {
    poses.delivered.clear();
    poses.take("POSE/capture/alice", numbered(10'000 + turn));
    for (std::uint32_t i = 0; i < 300; ++i)
      poses.take("POSE/capture/evil-" + std::to_string(turn * 300 + i), numbered(i));
    poses.deliver();
    EXPECT_EQ(std::count(poses.delivered.begin(), poses.delivered.end(), 10'000 + turn), 1) << turn;
  }
}

}  // namespace
}  // namespace dance
