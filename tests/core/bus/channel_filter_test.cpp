#include "core/bus/channel_filter.h"

#include <gtest/gtest.h>
#include <sys/socket.h>
#include <unistd.h>

#include <array>
#include <string>

#include "core/bus/channel.h"

namespace dance {
namespace {

using Beginnings = std::vector<std::string>;
using Reach = ChannelFilter::Reach;

// What the kernel does with datagrams: a pair of sockets whose datagrams begin with eight bytes, as
// a UDP header would. These sockets have no network device, so that the filter's reach is not
// restricted; bus_reach_test.cpp tests it in networks.
class FilteredPair {
 public:
  explicit FilteredPair(const ChannelFilter& filter) {
    EXPECT_EQ(socketpair(AF_UNIX, SOCK_DGRAM, 0, fds_.data()), 0);
    attach(filter);
  }
  void attach(const ChannelFilter& filter) { EXPECT_TRUE(filter.attach(fds_[1])); }
  ~FilteredPair() {
    for (const int fd : fds_) close(fd);
  }
  FilteredPair(const FilteredPair&) = delete;
  FilteredPair& operator=(const FilteredPair&) = delete;

  bool passes(const std::string& name, std::size_t message_bytes = 300) const {
    return passes_bytes("LC02" + std::string(4, '\0') + name + '\0' +
                        std::string(message_bytes, 'x'));
  }
  bool passes_bytes(const std::string& payload) const {
    const std::string datagram = std::string(8, '\0') + payload;
    EXPECT_EQ(send(fds_[0], datagram.data(), datagram.size(), 0),
              static_cast<ssize_t>(datagram.size()));
    std::array<char, 4096> got{};
    const ssize_t size = recv(fds_[1], got.data(), got.size(), MSG_DONTWAIT);
    EXPECT_TRUE(size < 0 || size == static_cast<ssize_t>(datagram.size())) << size;
    return size >= 0;
  }

 private:
  std::array<int, 2> fds_{};
};

ChannelFilter filter_of(const Beginnings& beginnings) {
  ChannelFilter filter(Reach::kNetwork);
  for (const std::string& beginning : beginnings) filter.want(beginning);
  return filter;
}

TEST(ChannelFilter, KeepsTheShortestBeginningsShortestFirst) {
  EXPECT_EQ(
      filter_of({"POSE/guest/bob", "BEAT/local", "POSE/guest/", "POSE/guest/al"}).beginnings(),
      (Beginnings{"BEAT/local", "POSE/guest/"}));
  EXPECT_EQ(filter_of({"POSE/guest/bob", "BEAT/local", "X"}).beginnings(),
            (Beginnings{"X", "BEAT/local", "POSE/guest/bob"}));
  EXPECT_EQ(filter_of({"POSE/guest/bob", "", "BEAT/local"}).beginnings(), (Beginnings{""}));
}

TEST(ChannelFilter, ShortensManyBeginningsUntilTheyAreFew) {
  ChannelFilter filter = filter_of({"BEAT/local"});
  for (int i = 0; i < 100; ++i) filter.want("POSE/guest/guest-" + std::to_string(1000 + i));
  EXPECT_LE(filter.beginnings().size(), ChannelFilter::kMostBeginnings);
  const FilteredPair pair(filter);
  for (int i = 0; i < 100; ++i)
    EXPECT_TRUE(pair.passes("POSE/guest/guest-" + std::to_string(1000 + i)));
  EXPECT_TRUE(pair.passes("BEAT/local"));
  EXPECT_FALSE(pair.passes("POSE/stage/alice"));
  // Names without a slash cannot be shortened at one.
  for (char c = 'a'; c <= 'z'; ++c) filter.want(std::string(1, c));
  EXPECT_EQ(filter.beginnings(), (Beginnings{""}));
}

TEST(ChannelFilter, PassesNamesWithASubscribedBeginning) {
  const FilteredPair pair(filter_of({"BEAT/local", "POSE/guest/", "X"}));
  EXPECT_TRUE(pair.passes("BEAT/local"));
  EXPECT_TRUE(pair.passes("POSE/guest/alice"));
  EXPECT_TRUE(pair.passes("X"));
  EXPECT_TRUE(pair.passes("XY/z"));
  for (const char* name : {"BEAT/loca", "BEAT/locaL", "BEAT", "POSE/guest", "POSE/guesT/a",
                           "POSE/stage/alice", "pose/guest/alice", "Y", ""})
    EXPECT_FALSE(pair.passes(name)) << name;
}

TEST(ChannelFilter, ComparesBeginningsOfEveryLengthToTheLastCharacter) {
  const std::string longest(kMaxChannelLength, 'q');
  for (std::size_t size = 1; size <= kMaxChannelLength; ++size) {
    const std::string name = longest.substr(0, size);
    const FilteredPair pair(filter_of({name}));
    EXPECT_TRUE(pair.passes(name, 0)) << size;
    std::string other = name;
    other.back() = 'r';
    EXPECT_FALSE(pair.passes(other)) << size;
    EXPECT_FALSE(pair.passes(name.substr(0, size - 1))) << size;
  }
}

TEST(ChannelFilter, PassesShortDatagramsBesideALongBeginning) {
  const FilteredPair pair(filter_of({"POSE/guest/a-guest-of-a-long-name", "X", "BEAT/local"}));
  EXPECT_TRUE(pair.passes("X", 0));
  EXPECT_TRUE(pair.passes("BEAT/local", 0));
  EXPECT_FALSE(pair.passes("Y", 0));
}

TEST(ChannelFilter, DropsWhatIsNoShortMessage) {
  const FilteredPair pair(filter_of({"POSE/guest/", "X"}));
  EXPECT_FALSE(pair.passes_bytes("LC03" + std::string(4, '\0') + "X" + std::string(2000, 'x')));
  EXPECT_FALSE(pair.passes_bytes("LC01" + std::string(4, '\0') + "X" + std::string(2000, 'x')));
  for (std::size_t size = 0; size < 80; ++size)
    EXPECT_FALSE(pair.passes_bytes(std::string(size, 'P'))) << size;
}

TEST(ChannelFilter, PassesAllNamesAndFragmentsWhereEverythingIsWanted) {
  ChannelFilter filter = filter_of({"BEAT/local"});
  FilteredPair pair(filter);
  EXPECT_FALSE(pair.passes("POSE/guest/alice"));
  filter.want("");
  for (int i = 0; i < 2; ++i) {
    pair.attach(filter);
    EXPECT_TRUE(pair.passes("POSE/guest/alice"));
    EXPECT_TRUE(pair.passes_bytes("LC03" + std::string(100, '\0')));
    EXPECT_FALSE(pair.passes_bytes("LC04" + std::string(100, '\0')));
  }
}

TEST(ChannelFilter, PassesNothingBeforeASubscription) {
  const FilteredPair pair(filter_of({}));
  EXPECT_FALSE(pair.passes("BEAT/local"));
  EXPECT_FALSE(pair.passes_bytes("LC03" + std::string(100, '\0')));
}

TEST(ChannelFilter, DropsWhatHasNoDeviceWhereOnlyThisMachineMaySend) {
  ChannelFilter filter(Reach::kThisMachine);
  filter.want("");
  EXPECT_FALSE(FilteredPair(filter).passes("BEAT/local"));
}

TEST(ChannelFilter, FailsWithoutASocket) { EXPECT_FALSE(filter_of({"BEAT/local"}).attach(-1)); }

}  // namespace
}  // namespace dance
