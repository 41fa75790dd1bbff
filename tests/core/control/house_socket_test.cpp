// The socket over which programs of this user reach houses, and programs of other users do not.
#include "core/control/house_socket.h"

#include <gtest/gtest.h>
#include <sys/socket.h>
#include <sys/stat.h>
#include <sys/un.h>
#include <unistd.h>

#include <cstring>
#include <filesystem>
#include <string>
#include <vector>

#include "core/control/house_publisher.h"
#include "core/net/local_address.h"
#include "core/net/mono_clock.h"
#include "core/program/child_process.h"
#include "tests/allocation_guard.h"
#include "tests/core/bus/port_double.h"
#include "tests/test_folder.h"

namespace dance {
namespace {

constexpr const char* kHouseUrl = "udpm://239.255.76.67:7811?ttl=0";
constexpr uid_t kNobodyUid = 65534;
const Channel kRemovalChannel = Channel::of_house(Signal::kRemoval);

class HouseSocketTest : public ::testing::Test {
 protected:
  void SetUp() override {
    setenv("XDG_RUNTIME_DIR", folder_.path().c_str(), 1);
    auto made = Poller::create();
    ASSERT_TRUE(made);
    poller_ = std::move(*made);
  }
  std::unique_ptr<HouseSocket> open(const char* url = kHouseUrl) {
    auto opened = HouseSocket::open(
        url,
        [this](const Channel& channel, const Arrival& arrival) {
          Removal removal;
          if (decode(arrival.data, arrival.size, removal) == Decoded::kFine)
            received_.push_back(std::string(channel.view()) + " " +
                                std::string(removal.guest.view()));
        },
        *poller_);
    EXPECT_TRUE(opened) << opened.error().what;
    return std::move(*opened);
  }
  template <class Condition>
  bool turn_until(const Condition& is_so) {
    for (int i = 0; i < 3000 && !is_so(); ++i) poller_->run_once(Duration::ms(10));
    return is_so();
  }
  static Removal removal_of(const char* guest) {
    return {mono_now(), this_clock_id(), 1, *GuestId::parse(guest)};
  }
  static void send(HouseSender& sender, const char* guest) {
    const Removal removal = removal_of(guest);
    sender.send(kRemovalChannel, AnyMessage(removal));
  }

  TestFolder folder_{"house-socket"};
  std::unique_ptr<Poller> poller_;
  std::vector<std::string> received_;
};

TEST_F(HouseSocketTest, IsAFileOfThisUserInAFolderOfThisUser) {
  const auto house = open();
  struct stat about {};
  ASSERT_EQ(stat(house->path().c_str(), &about), 0);
  EXPECT_EQ(about.st_mode & 0777, 0600u);
  ASSERT_EQ(stat(folder_of(house->path()).c_str(), &about), 0);
  EXPECT_EQ(about.st_mode & 0777, 0700u);
}

TEST_F(HouseSocketTest, ReachesEveryHouseOfTheBusAndNoOther) {
  const auto one = open(), two = open("udpm://239.255.76.67:7811?ttl=0&recv_buf_size=2000000");
  const auto other = open("udpm://239.255.76.67:7812?ttl=0");
  HouseSender sender(kHouseUrl, *poller_);
  EXPECT_EQ(sender.house_count(), 2u);
  send(sender, "bob");
  EXPECT_TRUE(turn_until([&] { return received_.size() == 2; }));
  EXPECT_EQ(received_, (std::vector<std::string>(2, "REMOVAL/local bob")));
}

TEST_F(HouseSocketTest, FindsAHouseThatStartsLaterAndForgetsOneThatHasEnded) {
  HouseSender sender(kHouseUrl, *poller_);
  auto house = open();
  ASSERT_TRUE(turn_until([&] { return sender.house_count() == 1; }));
  const std::string path = house->path();
  house.reset();
  EXPECT_FALSE(std::filesystem::exists(path));
  ASSERT_TRUE(turn_until([&] {
    send(sender, "bob");
    return sender.house_count() == 0;
  }));
  house = open();
  ASSERT_TRUE(turn_until([&] { return sender.house_count() == 1; }));
  send(sender, "bob");
  EXPECT_TRUE(turn_until([&] { return received_.size() == 1; }));
}

TEST_F(HouseSocketTest, LosesMessagesRatherThanWaitForAHouseThatDoesNotRead) {
  const auto house = open();
  HouseSender sender(kHouseUrl, *poller_);
  for (int i = 0; i < 20'000 && sender.lost() == 0; ++i) send(sender, "bob");
  EXPECT_GT(sender.lost(), 0u);
}

TEST_F(HouseSocketTest, AllocatesNothingWhileItSendsAndReceives) {
  int received = 0;
  auto house = HouseSocket::open(
      kHouseUrl, [&](const Channel&, const Arrival&) { ++received; }, *poller_);
  ASSERT_TRUE(house);
  HouseSender sender(kHouseUrl, *poller_);
  const Pose pose;
  const Channel channel = Channel::of(Signal::kPose, Where::kCapture, *GuestId::parse("alice"));
  sender.send(channel, AnyMessage(pose));
  ASSERT_TRUE(turn_until([&] { return received == 1; }));
  const AllocationGuard guard;
  sender.send(channel, AnyMessage(pose));
  EXPECT_EQ(guard.allocations(), 0u);
  while (received < 2) poller_->run_once(Duration());
  // Looking for houses, which may have been due, lists a folder.
  EXPECT_LE(guard.allocations(), 20u);
}

// Each message that is none costs its connection nothing, and is counted.
TEST_F(HouseSocketTest, CountsWhatIsNoMessageForAHouse) {
  const auto house = open();
  auto raw = LocalMessageSender::connect(house->path());
  ASSERT_TRUE(raw);
  const auto bytes = [](std::string_view text) {
    return std::span(reinterpret_cast<const std::uint8_t*>(text.data()), text.size());
  };
  const std::string no_zero(100, 'A'), big(LocalMessageServer::kMostBytes + 1, 'A');
  using namespace std::string_view_literals;
  for (const std::string_view text :
       {"REMOVAL/local"sv, "\0"sv, "STATS/view\0x"sv, "POSE/stage/bob\0x"sv, "BEAT/local\0x"sv,
        "POSE/capture/Bob\0x"sv, std::string_view(no_zero)})
    EXPECT_EQ(raw->send(bytes(text), {}), LocalMessageSender::Sent::kSent);
  EXPECT_EQ(raw->send(bytes(big), {}), LocalMessageSender::Sent::kSent);
  EXPECT_TRUE(turn_until([&] { return house->counters().oversized == 1; }));
  EXPECT_EQ(house->unknown(), 7u);
  EXPECT_TRUE(received_.empty());
  HouseSender sender(kHouseUrl, *poller_);
  send(sender, "bob");
  EXPECT_TRUE(turn_until([&] { return received_.size() == 1; }));
}

TEST_F(HouseSocketTest, BoundsItsConnections) {
  const auto house = open();
  std::vector<LocalMessageSender> senders;
  for (std::size_t i = 0; i < LocalMessageServer::kMostClients + 3; ++i) {
    auto sender = LocalMessageSender::connect(house->path());
    ASSERT_TRUE(sender);
    senders.push_back(std::move(*sender));
    poller_->run_once(Duration());
  }
  EXPECT_TRUE(turn_until([&] { return house->counters().refused_clients == 3; }));
}

// Folder and file modes keep other users out. SO_PEERCRED does so even when both modes are open.
TEST_F(HouseSocketTest, RefusesAnotherUserThoughFolderAndFileAreOpen) {
  if (geteuid() != 0) GTEST_SKIP() << "only root can run a process of another user";
  const auto house = open();
  const auto run_as_nobody = [&](bool is_closed) {
    auto attacker = ChildProcess::start_copy([&] {
      if (setgid(kNobodyUid) != 0 || setuid(kNobodyUid) != 0) return 3;
      const int fd = socket(AF_UNIX, SOCK_SEQPACKET, 0);
      sockaddr_un address{};
      address.sun_family = AF_UNIX;
      std::strncpy(address.sun_path, house->path().c_str(), sizeof address.sun_path - 1);
      if (connect(fd, reinterpret_cast<const sockaddr*>(&address), sizeof address) != 0)
        return is_closed ? 0 : 4;
      MessageBuffer buffer;
      const std::size_t size = encode(removal_of("bob"), buffer);
      std::string message("REMOVAL/local");
      message.push_back('\0');
      message.append(reinterpret_cast<const char*>(buffer.data()), size);
      static_cast<void>(::send(fd, message.data(), message.size(), MSG_NOSIGNAL));
      return is_closed ? 5 : 0;
    });
    ASSERT_TRUE(attacker);
    ASSERT_TRUE(turn_until([&] { return attacker->has_ended(); }));
    EXPECT_EQ(attacker->exit_code(), 0) << "3: not another user, 4: no connection, 5: a connection";
  };
  run_as_nobody(true);
  EXPECT_EQ(house->counters().refused_users, 0u);
  ASSERT_EQ(chmod(house->path().c_str(), 0777), 0);
  ASSERT_EQ(chmod(folder_of(house->path()).c_str(), 0777), 0);
  ASSERT_EQ(chmod(folder_.path().c_str(), 0777), 0);
  run_as_nobody(false);
  EXPECT_TRUE(turn_until([&] { return house->counters().refused_users == 1; }));
  poller_->run_once(Duration::ms(50));
  EXPECT_TRUE(received_.empty());
}

TEST_F(HouseSocketTest, APublisherSendsRequestsPastTheBusAndCapturesBothWays) {
  const auto house = open();
  PortDouble bus;
  HousePublisher publisher(bus, kHouseUrl, *poller_);
  publisher.publish(kRemovalChannel, removal_of("bob"));
  EXPECT_TRUE(bus.sent.empty());
  EXPECT_TRUE(turn_until([&] { return received_.size() == 1; }));
  publisher.publish(Where::kCapture, *GuestId::parse("alice"), Pose());
  publisher.publish(Where::kView, *GuestId::parse("alice"), StageTime());
  EXPECT_EQ(bus.sent, (std::vector<std::string>{"POSE/capture/alice", "STAGE_TIME/view/alice"}));
}

}  // namespace
}  // namespace dance
