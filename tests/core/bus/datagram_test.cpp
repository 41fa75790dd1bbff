#include "core/bus/datagram.h"

#include <gtest/gtest.h>

#include <string>
#include <vector>

namespace dance {
namespace {

using Kind = BusDatagram::Kind;

BusDatagram parse(const std::string& bytes) {
  return parse_datagram({reinterpret_cast<const std::uint8_t*>(bytes.data()), bytes.size()});
}
std::string text_of(const BusDatagram& datagram) {
  return {reinterpret_cast<const char*>(datagram.data.data()), datagram.data.size()};
}
std::string message(const std::string& name, const std::string& data = "data") {
  return "LC02" + std::string("\0\0\0\7", 4) + name + '\0' + data;
}
// A fragment of a 10-byte message.
std::string fragment(char number, const std::string& rest) {
  return "LC03" + std::string("\0\0\0\7", 4) + std::string("\0\0\0\12", 4) +
         std::string("\xff\xff\xff\0", 4) + std::string("\0", 1) + number + std::string("\0\2", 2) +
         rest;
}

TEST(Datagram, ReadsTheHeaderThatItWrites) {
  const DatagramHeader header(0x01020304, "POSE/stage/bob");
  const std::string bytes(reinterpret_cast<const char*>(header.bytes.data()), header.size);
  EXPECT_EQ(bytes, "LC02\1\2\3\4POSE/stage/bob" + std::string(1, '\0'));
  const std::string whole = bytes + "pose";
  const BusDatagram datagram = parse(whole);
  EXPECT_EQ(datagram.kind, Kind::kMessage);
  EXPECT_EQ(datagram.name, "POSE/stage/bob");
  EXPECT_EQ(text_of(datagram), "pose");
}

TEST(Datagram, MayHoldAnEmptyMessage) {
  const std::string bytes = message("LIGHT/desk", "");
  EXPECT_EQ(parse(bytes).kind, Kind::kMessage);
  EXPECT_TRUE(parse(bytes).data.empty());
}

TEST(Datagram, RefusesEveryPrefixThatEndsBeforeTheNul) {
  const std::string bytes = message("POSE/stage/bob");
  const std::size_t nul = 8 + std::string("POSE/stage/bob").size();
  for (std::size_t size = 0; size < bytes.size(); ++size)
    EXPECT_EQ(parse(bytes.substr(0, size)).kind, size <= nul ? Kind::kMalformed : Kind::kMessage)
        << size;
}

TEST(Datagram, RefusesAnotherMagic) {
  for (std::size_t bit = 0; bit < 32; ++bit) {
    std::string bytes = message("POSE/stage/bob");
    bytes[bit / 8] = static_cast<char>(bytes[bit / 8] ^ (1 << bit % 8));
    EXPECT_EQ(parse(bytes).kind, bytes.starts_with("LC03") ? Kind::kFragment : Kind::kMalformed);
  }
}

TEST(Datagram, RefusesNamesLongerThanLcmAllows) {
  EXPECT_EQ(parse(message(std::string(63, 'n'))).name, std::string(63, 'n'));
  EXPECT_EQ(parse(message(std::string(64, 'n'))).kind, Kind::kMalformed);
  EXPECT_EQ(parse(message("")).kind, Kind::kMalformed);
  EXPECT_EQ(parse("LC02" + std::string(65'503, 'n')).kind, Kind::kMalformed);
}

TEST(Datagram, RefusesControlCharactersAndNonAsciiInNames) {
  for (int c = 1; c < 256; ++c) {
    const std::string name = std::string("A") + static_cast<char>(c) + "B";
    EXPECT_EQ(parse(message(name)).kind, c >= 0x20 && c < 0x7f ? Kind::kMessage : Kind::kMalformed)
        << c;
  }
}

TEST(Datagram, NamesAMessageByItsFirstFragmentOnly) {
  const std::string first = fragment(0, std::string("CLOUD/points") + '\0' + "xyz");
  EXPECT_EQ(parse(first).kind, Kind::kFragment);
  EXPECT_EQ(parse(first).name, "CLOUD/points");
  EXPECT_TRUE(parse(first).data.empty());
  EXPECT_EQ(parse(fragment(1, std::string("CLOUD/points") + '\0')).name, "");
}

TEST(Datagram, ReadsNoNameFromAFragmentThatHasNoValidOne) {
  for (const std::string& rest : {std::string(), std::string("no end"), std::string(1, '\0'),
                                  std::string("\x1b[2J") + '\0', std::string(64, 'n') + '\0'}) {
    EXPECT_EQ(parse(fragment(0, rest)).kind, Kind::kFragment);
    EXPECT_EQ(parse(fragment(0, rest)).name, "");
  }
  EXPECT_EQ(parse(fragment(0, "").substr(0, 19)).kind, Kind::kMalformed);
}

TEST(DatagramDeathTest, PanicsOfANameThatItWouldRefuseItself) {
  EXPECT_DEATH(DatagramHeader(1, "two\nlines"), "is_channel_name");
}

}  // namespace
}  // namespace dance
