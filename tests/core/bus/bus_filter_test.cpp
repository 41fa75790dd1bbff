// What a bus wakes its program for, and that nothing wanted is kept back: the kernel's filter on
// real sockets.
#include <gtest/gtest.h>

#include <fstream>
#include <map>
#include <string>

#include "tests/core/bus/bus_help.h"

namespace dance {
namespace {

// Datagrams that the kernel kept back from the sockets on the tests' port, by the last column of
// its table.
std::uint64_t kept_back() {
  std::ifstream table("/proc/net/udp");
  std::uint64_t sum = 0;
  for (std::string line; std::getline(table, line);)
    if (line.find(":4501 ") != std::string::npos)  // 17665
      sum += std::stoull(line.substr(line.find_last_of(' ', line.find_last_not_of(' ')) + 1));
  return sum;
}

TEST(BusFilter, WhoWantsTheBeatIsNotWokenByPoses) {
  constexpr const char* kOwnPort = "udpm://239.255.76.67:17665?ttl=0";
  const auto sender = *Bus::open(kOwnPort), receiver = *Bus::open(kOwnPort);
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
  EXPECT_EQ(kept_back(), 200u);
  // Who wants more later gets it, and a second bus of the same process only its own.
  const auto second = *Bus::open(kOwnPort);
  int captures = 0;
  second->subscribe<Pose>(Where::kCapture,
                          [&](const Channel&, const Pose&, MonoTime) { ++captures; });
  receiver->subscribe<Pose>(Where::kStage,
                            [&](const Channel&, const Pose&, MonoTime) { ++stages; });
  const std::uint64_t before = kept_back();
  send();
  drain_until(*receiver, [&] { return beats == 2 && stages == 100; });
  drain_until(*second, [&] { return captures == 100; });
  EXPECT_EQ(stages, 100);
  EXPECT_EQ(captures, 100);
  EXPECT_EQ(kept_back() - before, 100u + 101u);
}

TEST(BusFilter, WhoIsWatchedBeforeItWantsAnythingIsNotWokenEither) {
  constexpr const char* kOwnPort = "udpm://239.255.76.67:17665?ttl=0";
  const auto sender = *Bus::open(kOwnPort), receiver = *Bus::open(kOwnPort);
  EXPECT_GE(receiver->fd(), 0);
  const auto send = [&] {
    for (std::uint32_t i = 0; i < 100; ++i) sender->publish(capture_of("alice"), numbered(i));
    Beat beat;
    beat.tempo_bpm = 120.0;
    sender->publish(Channel::of_house(Signal::kBeat), beat);
  };
  const std::uint64_t before = kept_back();
  send();
  // The kernel may hand datagrams on a little later.
  for (int i = 0; i < 1000 && kept_back() - before < 101; ++i) poll(nullptr, 0, 10);
  EXPECT_EQ(kept_back() - before, 101u);
  int beats = 0;
  receiver->subscribe<Beat>(Where::kLocal, [&](const Channel&, const Beat&, MonoTime) { ++beats; });
  send();
  drain_until(*receiver, [&] { return beats == 1; });
  EXPECT_EQ(beats, 1);
  EXPECT_EQ(kept_back() - before, 201u);
}

TEST(BusFilter, WhoComesToWantEverythingHearsEverything) {
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

// More than a filter holds, and names that cannot be cut at a slash.
TEST(BusFilter, WhoWantsManyChannelsHearsTheLastOfThem) {
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

// How much the kernel keeps for one socket, in this network; for as long as this lives.
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

TEST(BusFilter, LosesNothingWhereTheKernelHasNoRoomForAFilter) {
  const FilterRoom room(2000);
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
