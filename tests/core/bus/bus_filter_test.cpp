// Tests the kernel's filter on real sockets: which messages wake a program, and that no subscribed
// channel is lost.
#include <gtest/gtest.h>
#include <linux/sock_diag.h>
#include <sys/socket.h>

#include <array>
#include <fstream>
#include <map>
#include <string>

#include "tests/core/bus/bus_help.h"

namespace dance {
namespace {

// Datagrams that the kernel dropped for this bus.
std::uint32_t dropped(const Bus& bus) {
  std::array<std::uint32_t, SK_MEMINFO_VARS> figures{};
  socklen_t size = sizeof figures;
  EXPECT_EQ(getsockopt(receive_socket_of(bus), SOL_SOCKET, SO_MEMINFO, figures.data(), &size), 0);
  return figures[SK_MEMINFO_DROPS];
}

TEST(BusFilter, DoesNotWakeAProgramForChannelsItHasNotSubscribedTo) {
  const auto sender = open_bus(), receiver = open_bus();
  int beats = 0, stages = 0;
  receiver->subscribe<Beat>(Where::kLocal, [&](const Channel&, const Beat&, MonoTime) { ++beats; });
  Beat beat;
  beat.tempo_bpm = 120.0;
  const auto send = [&] {
    for (std::uint32_t i = 0; i < 100; ++i) sender->publish(capture_of("alice"), numbered(i));
    for (std::uint32_t i = 0; i < 100; ++i)
      sender->publish(Channel::of(Signal::kPose, Where::kStage, guest("bob")), numbered(i));
    sender->publish(Channel::of_house(Signal::kBeat), beat);
  };
  send();
  drain_until(*receiver, [&] { return beats == 1; });
  EXPECT_EQ(beats, 1);
  EXPECT_EQ(dropped(*receiver), 200u);
  // A later subscription widens the filter; a second bus of the process has its own.
  const auto second = open_bus();
  int captures = 0;
  second->subscribe<Pose>(Where::kCapture,
                          [&](const Channel&, const Pose&, MonoTime) { ++captures; });
  receiver->subscribe<Pose>(Where::kStage,
                            [&](const Channel&, const Pose&, MonoTime) { ++stages; });
  send();
  drain_until(*receiver, [&] { return beats == 2 && stages == 100; });
  drain_until(*second, [&] { return captures == 100; });
  EXPECT_EQ(stages, 100);
  EXPECT_EQ(captures, 100);
  EXPECT_EQ(dropped(*receiver), 300u);
  EXPECT_EQ(dropped(*second), 101u);
}

TEST(BusFilter, DoesNotWakeAProgramBeforeItsFirstSubscription) {
  const auto sender = open_bus(), receiver = open_bus();
  const auto send = [&] {
    for (std::uint32_t i = 0; i < 100; ++i) sender->publish(capture_of("alice"), numbered(i));
    Beat beat;
    beat.tempo_bpm = 120.0;
    sender->publish(Channel::of_house(Signal::kBeat), beat);
  };
  send();
  // The kernel may deliver datagrams a little later.
  for (int i = 0; i < 1000 && dropped(*receiver) < 101; ++i) poll(nullptr, 0, 10);
  EXPECT_EQ(dropped(*receiver), 101u);
  int beats = 0;
  receiver->subscribe<Beat>(Where::kLocal, [&](const Channel&, const Beat&, MonoTime) { ++beats; });
  send();
  drain_until(*receiver, [&] { return beats == 1; });
  EXPECT_EQ(beats, 1);
  EXPECT_EQ(dropped(*receiver), 201u);
}

TEST(BusFilter, PassesEverythingOnceEverythingIsSubscribed) {
  const auto sender = open_bus(), receiver = open_bus();
  int beats = 0, all = 0;
  receiver->subscribe<Beat>(Where::kLocal, [&](const Channel&, const Beat&, MonoTime) { ++beats; });
  receiver->on_anything([&](std::string_view, const void*, std::size_t, MonoTime) { ++all; });
  Beat beat;
  beat.tempo_bpm = 120.0;
  for (std::uint32_t i = 0; i < 100; ++i) sender->publish(capture_of("alice"), numbered(i));
  sender->publish(Channel::of_house(Signal::kBeat), beat);
  drain_until(*receiver, [&] { return all == 101; });
  EXPECT_EQ(all, 101);
  EXPECT_EQ(beats, 1);
}

// More names than a filter holds, and without a slash at which they could be shortened.
TEST(BusFilter, PassesMoreChannelsThanAFilterHolds) {
  const auto sender = open_bus(), receiver = open_bus();
  std::map<std::string, int> heard;
  const auto lamp = [](int i) { return "LAMP_" + std::to_string(10 + i); };
  for (int i = 0; i < 40; ++i)
    receiver->on_raw(*ChannelPattern::parse(lamp(i)), Delivery::kEvery, 1000,
                     [&](std::string_view name, const void*, std::size_t, MonoTime) {
                       ++heard[std::string(name)];
                     });
  const std::string message(200, 'x');
  for (int i = 0; i < 40; ++i) sender->publish_raw(lamp(i).c_str(), message.data(), message.size());
  drain_until(*receiver, [&] { return heard.size() == 40; });
  EXPECT_EQ(heard.size(), 40u);
}

// Limits the kernel's memory for options of sockets in this network while it lives.
class FilterRoom {
 public:
  explicit FilterRoom(int bytes) {
    std::ifstream(kFile) >> before_;
    is_set_ = static_cast<bool>(std::ofstream(kFile) << bytes << std::flush);
  }
  ~FilterRoom() { std::ofstream(kFile) << before_; }
  FilterRoom(const FilterRoom&) = delete;
  FilterRoom& operator=(const FilterRoom&) = delete;
  bool is_set() const { return is_set_; }

 private:
  static constexpr const char* kFile = "/proc/sys/net/core/optmem_max";
  int before_ = 0;
  bool is_set_ = false;
};

// Enough for a filter that passes all names, not for one with these names beside it.
constexpr int kRoomForTheShortest_bytes = 2000;

TEST(BusFilter, LosesNothingWhereTheKernelHasNoRoomForTheFullFilter) {
  const FilterRoom room(kRoomForTheShortest_bytes);
  if (!room.is_set()) GTEST_SKIP() << "a network's own limit cannot be set here";
  const auto sender = open_bus(), receiver = open_bus();
  int stages = 0, captures = 0;
  const auto count = [](int& poses) {
    return [&poses](const Channel&, const Pose&, MonoTime) { ++poses; };
  };
  receiver->subscribe<Beat>(Where::kLocal, [](const Channel&, const Beat&, MonoTime) {});
  receiver->subscribe<Pose>({Where::kStage, guest("a-guest-of-a-long-name")}, count(stages));
  receiver->subscribe<Pose>({Where::kCapture, guest("a-guest-of-a-long-name")}, count(captures));
  for (std::uint32_t i = 0; i < 10; ++i) {
    sender->publish(Channel::of(Signal::kPose, Where::kStage, guest("a-guest-of-a-long-name")),
                    numbered(i));
    sender->publish(capture_of("a-guest-of-a-long-name"), numbered(i));
  }
  drain_until(*receiver, [&] { return stages == 10 && captures == 10; });
  EXPECT_EQ(stages, 10);
  EXPECT_EQ(captures, 10);
}

}  // namespace
}  // namespace dance
