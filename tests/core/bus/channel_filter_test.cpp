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

// What the kernel does with datagrams: a pair of sockets whose datagrams begin with eight bytes, as
// UDP's header would.
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

ChannelFilter filter_of(const Beginnings& regexes) {
  ChannelFilter filter;
  for (const std::string& regex : regexes) filter.want(regex);
  return filter;
}

TEST(ChannelFilter, ARegularExpressionBeginsWithItsPlainCharacters) {
  EXPECT_EQ(plain_beginning("BEAT/local"), "BEAT/local");
  EXPECT_EQ(plain_beginning("POSE/guest/[a-z0-9-]+"), "POSE/guest/");
  EXPECT_EQ(plain_beginning(".*"), "");
  EXPECT_EQ(plain_beginning(""), "");
  EXPECT_EQ(plain_beginning("LIGHT/desk\\.a.*"), "LIGHT/desk");
  EXPECT_EQ(plain_beginning("LIGHT/d.*"), "LIGHT/d");
}

TEST(ChannelFilter, WhatMayBeMissingIsNoBeginning) {
  EXPECT_EQ(plain_beginning("POSES?/guest"), "POSE");
  EXPECT_EQ(plain_beginning("POSES*"), "POSE");
  EXPECT_EQ(plain_beginning("POSES{0,2}"), "POSE");
  EXPECT_EQ(plain_beginning("POSES+"), "POSES");
  EXPECT_EQ(plain_beginning("?"), "");
  EXPECT_EQ(plain_beginning("POSE/a|BEAT/b"), "");
}

TEST(ChannelFilter, KeepsTheWidestBeginningsOnly) {
  EXPECT_EQ(filter_of({"POSE/guest/bob", "BEAT/local", "POSE/guest/[a-z]+", "POSE/guest/al"})
                .beginnings(),
            (Beginnings{"BEAT/local", "POSE/guest/"}));
  EXPECT_EQ(filter_of({"POSE/guest/bob", ".*", "BEAT/local"}).beginnings(), (Beginnings{""}));
}

TEST(ChannelFilter, ManyBeginningsAreCutShorterUntilTheyAreFew) {
  ChannelFilter filter = filter_of({"BEAT/local"});
  for (int i = 0; i < 100; ++i) filter.want("POSE/guest/guest-" + std::to_string(1000 + i));
  EXPECT_LE(filter.beginnings().size(), ChannelFilter::kMostBeginnings);
  const FilteredPair pair(filter);
  for (int i = 0; i < 100; ++i)
    EXPECT_TRUE(pair.passes("POSE/guest/guest-" + std::to_string(1000 + i)));
  EXPECT_TRUE(pair.passes("BEAT/local"));
  EXPECT_FALSE(pair.passes("POSE/stage/alice"));
  // Names without a slash have nothing to be cut at.
  for (char c = 'a'; c <= 'z'; ++c) filter.want(std::string(1, c));
  EXPECT_EQ(filter.beginnings(), (Beginnings{""}));
}

TEST(ChannelFilter, TheKernelLetsThroughWhatBeginsSo) {
  const FilteredPair pair(filter_of({"BEAT/local", "POSE/guest/[a-z0-9-]+", "X"}));
  EXPECT_TRUE(pair.passes("BEAT/local"));
  EXPECT_TRUE(pair.passes("POSE/guest/alice"));
  EXPECT_TRUE(pair.passes("X"));
  EXPECT_TRUE(pair.passes("XY/z"));
  for (const char* name : {"BEAT/loca", "BEAT/locaL", "BEAT", "POSE/guest", "POSE/guesT/a",
                           "POSE/stage/alice", "pose/guest/alice", "Y", ""})
    EXPECT_FALSE(pair.passes(name)) << name;
}

TEST(ChannelFilter, BeginningsOfEveryLengthAreComparedToTheLastCharacter) {
  const std::string longest(kMaxChannelLength, 'q');
  for (std::size_t size = 1; size <= kMaxChannelLength; ++size) {
    const std::string name = longest.substr(0, size);
    const FilteredPair pair(filter_of({name}));
    EXPECT_TRUE(pair.passes(name)) << size;
    std::string other = name;
    other.back() = 'r';
    EXPECT_FALSE(pair.passes(other)) << size;
    EXPECT_FALSE(pair.passes(name.substr(0, size - 1))) << size;
  }
}

TEST(ChannelFilter, NothingIsLostThatIsTooShortOrInParts) {
  const FilteredPair pair(filter_of({"POSE/guest/", "X"}));
  EXPECT_TRUE(pair.passes("X", 0));
  EXPECT_TRUE(pair.passes_bytes("LC03" + std::string(2000, 'x')));
  for (std::size_t size = 0; size < 80; ++size)
    EXPECT_TRUE(pair.passes_bytes(std::string(size, 'P')));
}

TEST(ChannelFilter, WhoWantsEverythingGetsEverything) {
  ChannelFilter filter = filter_of({"BEAT/local"});
  FilteredPair pair(filter);
  EXPECT_FALSE(pair.passes("POSE/guest/alice"));
  filter.want(".*");
  pair.attach(filter);
  EXPECT_TRUE(pair.passes("POSE/guest/alice"));
  pair.attach(filter);  // from a socket that has none
  EXPECT_TRUE(pair.passes("POSE/guest/alice"));
  const FilteredPair never_filtered(filter);
  EXPECT_TRUE(never_filtered.passes("POSE/guest/alice"));
}

TEST(ChannelFilter, SaysWhereThereIsNoSuchSocket) {
  EXPECT_FALSE(filter_of({"BEAT/local"}).attach(-1));
  EXPECT_TRUE(udp_sockets_on(1).empty());
}

}  // namespace
}  // namespace dance
