#include <gtest/gtest.h>

#include <cstring>
#include <limits>
#include <string>
#include <vector>

#include "formats/osc/osc_bundle_writer.h"
#include "formats/osc/osc_reader.h"
#include "tests/allocation_guard.h"
#include "tests/formats/osc/decoded_osc.h"

namespace dance {
namespace {

// Remembers what was read, as text: "/a i7 f0.5 sword".
class Heard : public OscMessageSink {
 public:
  void on_message(const OscMessage& message) override {
    std::string line(message.address);
    for (const OscArgument& argument : message.arguments) {
      if (argument.kind == OscArgument::Kind::kInt) line += " i" + std::to_string(argument.number);
      if (argument.kind == OscArgument::Kind::kFloat) line += " f" + std::to_string(argument.real);
      if (argument.kind == OscArgument::Kind::kText) line += " s" + std::string(argument.text);
      if (argument.kind == OscArgument::Kind::kOther) line += " ?";
    }
    lines.push_back(line);
  }
  std::vector<std::string> lines;
};

std::vector<std::uint8_t> bytes_of(const std::string& text) { return {text.begin(), text.end()}; }

// "#bundle", time tag 1, then each element with its size.
std::string bundle_of(const std::vector<std::string>& elements) {
  std::string bundle("#bundle\0\0\0\0\0\0\0\0\1", 16);
  for (const std::string& element : elements) {
    const auto size = static_cast<std::uint32_t>(element.size());
    for (int shift = 24; shift >= 0; shift -= 8)
      bundle += static_cast<char>((size >> shift) & 0xffu);
    bundle += element;
  }
  return bundle;
}

const std::string kPlain("/a\0\0,if\0\0\0\0\7\x3f\0\0\0", 16);

TEST(OscReader, ReadsMessagesAndBundlesInBundles) {
  OscReader reader;
  Heard heard;
  EXPECT_TRUE(reader.read(bytes_of(kPlain), heard));
  EXPECT_TRUE(reader.read(bytes_of(bundle_of({kPlain, bundle_of({kPlain})})), heard));
  EXPECT_EQ(heard.lines, std::vector<std::string>(3, "/a i7 f0.500000"));
  EXPECT_EQ(reader.counters().packets, 2u);
  EXPECT_EQ(reader.counters().messages, 3u);
  EXPECT_EQ(reader.counters().damaged, 0u);
}

TEST(OscReader, RefusesBundlesThatAreNestedWithoutEnd) {
  std::string nested = kPlain;
  for (int depth = 0; depth < OscReader::kMostDepth; ++depth) nested = bundle_of({nested});
  OscReader reader;
  Heard heard;
  EXPECT_TRUE(reader.read(bytes_of(nested), heard));
  EXPECT_EQ(heard.lines.size(), 1u);
  EXPECT_FALSE(reader.read(bytes_of(bundle_of({nested})), heard));
  for (int depth = 0; depth < 3000; ++depth) nested = bundle_of({nested});
  EXPECT_FALSE(reader.read(bytes_of(nested), heard));
  EXPECT_EQ(heard.lines.size(), 1u);
  EXPECT_EQ(reader.counters().damaged, 2u);
}

TEST(OscReader, BoundsTheMessagesOfAPacketAndTheArgumentsOfAMessage) {
  OscReader reader;
  Heard heard;
  EXPECT_FALSE(reader.read(bytes_of(bundle_of(std::vector<std::string>(1000, kPlain))), heard));
  EXPECT_EQ(heard.lines.size(), static_cast<std::size_t>(OscReader::kMostMessages));
  // "/b" with a hundred truths: type tags only.
  std::string many("/b\0\0,", 5);
  many += std::string(100, 'T') + std::string(3, '\0');
  heard.lines.clear();
  EXPECT_TRUE(reader.read(bytes_of(many), heard));
  ASSERT_EQ(heard.lines.size(), 1u);
  EXPECT_EQ(heard.lines[0].size(), 2 + 2 * kMostOscArguments);
}

TEST(OscReader, KnowsWhatIsNoOpenSoundControl) {
  OscReader reader;
  Heard heard;
  const std::vector<std::string> hostile{
      "",
      "/",
      "/a\0",
      "abcd",
      "GET / HTTP/1.1\r\n\r\n",
      "#bundle",
      "#bundl\0\0\0\0\0\0\0\0\0\1",
      std::string("#bundle\0\0\0\0\0\0\0\0\1\0\0\0\7", 20),          // an element of 7 bytes
      std::string("#bundle\0\0\0\0\0\0\0\0\1\0\0\0\10", 20),         // that is not there
      std::string("#bundle\0\0\0\0\0\0\0\0\1\xff\xff\xff\xfc", 20),  // of -4
      std::string("#bundle\0\0\0\0\0\0\0\0\1\x7f\xff\xff\xfc", 20),  // of 2 GiB
      std::string("#bundle\0\0\0\0\0\0\0\0\1\0\0\0\0", 20),          // of none
      std::string("/aaa,i\0\0\0\0\0\1", 12),                         // an address without an end
      std::string("/a\0\0,ii\0\0\0\0\1", 12),                        // one int of two
      std::string("/a\0\0,s\0\0word", 12),                           // a text without an end
      std::string("/a\0\0,[[\0", 8),                                 // arrays without an end
      std::string("/a\0\0,Q\0\0", 8),                                // no type
  };
  for (const std::string& packet : hostile) reader.read(bytes_of(packet), heard);
  EXPECT_EQ(reader.counters().damaged, hostile.size()) << heard.lines.size();
}

TEST(OscReader, PassesOverABlobAndRefusesOneThatReachesPastItsMessage) {
  OscReader reader;
  Heard heard;
  const std::string inside("/a\0\0,bi\0\0\0\0\5hello\0\0\0\0\0\0\7", 24);
  EXPECT_TRUE(reader.read(bytes_of(inside), heard));
  EXPECT_EQ(heard.lines, std::vector<std::string>{"/a ? i7"});
  heard.lines.clear();
  // -1 rounded up is none, and -189,992,197 bytes on is before the datagram.
  const std::string sizes[] = {"\xff\xff\xff\xff", "\xf4\xac\xf6\xfb", "\x7f\xff\xff\xff",
                               std::string("\0\0\0\11", 4)};
  for (const std::string& size : sizes) {
    const std::string beyond = std::string("/a\0\0,bi\0", 8) + size + std::string("\0\0\0\7", 4);
    EXPECT_FALSE(reader.read(bytes_of(beyond), heard));
    EXPECT_FALSE(reader.read(bytes_of(bundle_of({beyond})), heard));
  }
  // A text that ends before its fourth byte, which is not zero: the library reads on, and takes
  // what follows for the blob's size.
  const std::string padded("/a\0x/b\0\0,b\0\0\0\0\0\0", 16);
  EXPECT_FALSE(reader.read(bytes_of(padded), heard));
  const std::string tags("/a\0\0,i\0bbbb\0\0\0\0\0\xf4\xac\xf6\xfb", 20);
  EXPECT_FALSE(reader.read(bytes_of(tags), heard));
  EXPECT_TRUE(heard.lines.empty());
  EXPECT_EQ(reader.counters().damaged, 10u);
}

TEST(OscReader, SurvivesEveryPrefixAndEveryFlippedBit) {
  const std::vector<std::uint8_t> whole = bytes_of(
      bundle_of({kPlain, bundle_of({kPlain, std::string("/c\0\0,sb\0hi\0\0\0\0\0\2xy\0\0", 20)})}));
  OscReader reader;
  Heard heard;
  ASSERT_TRUE(reader.read(whole, heard));
  for (std::size_t n = 0; n < whole.size(); ++n) {
    // On the heap, exactly as long: a read past the end is seen by the sanitizer.
    const std::vector<std::uint8_t> prefix(whole.begin(),
                                           whole.begin() + static_cast<std::ptrdiff_t>(n));
    reader.read(prefix, heard);
  }
  for (std::size_t bit = 0; bit < 8 * whole.size(); ++bit) {
    std::vector<std::uint8_t> flipped = whole;
    flipped[bit / 8] ^= static_cast<std::uint8_t>(1u << (bit % 8));
    reader.read(flipped, heard);
  }
  EXPECT_EQ(reader.counters().packets, 1 + whole.size() + 8 * whole.size());
  EXPECT_GT(reader.counters().damaged, whole.size() / 2);
}

TEST(OscBundleWriter, WritesTheBytesThatTheSpecificationShows) {
  KeptPackets kept;
  OscBundleWriter writer(kept);
  writer.add("/a", {std::int32_t{7}, 0.5f});
  EXPECT_TRUE(kept.packets.empty());
  writer.flush();
  writer.flush();
  ASSERT_EQ(kept.packets.size(), 1u);
  EXPECT_EQ(kept.packets[0], bytes_of(bundle_of({kPlain})));
}

TEST(OscBundleWriter, BeginsANewPacketBeforeOneGrowsTooLong) {
  KeptPackets kept;
  OscBundleWriter writer(kept);
  const std::string text(99, 'x');
  for (int i = 0; i < 100; ++i) writer.add("/text", {text.c_str(), std::int32_t{i}});
  writer.flush();
  int i = 0;
  std::size_t largest = 0;
  for (const auto& packet : kept.packets) {
    largest = std::max(largest, packet.size());
    for (const DecodedOsc& message : decode_osc(packet)) {
      EXPECT_EQ(message.address, "/text");
      EXPECT_EQ(message.types, "si");
      EXPECT_EQ(message.texts[0], text);
      EXPECT_EQ(message.ints[0], i++);
    }
  }
  EXPECT_EQ(i, 100);
  EXPECT_LE(largest, OscBundleWriter::kMostPacketBytes);
  EXPECT_GT(largest, OscBundleWriter::kMostPacketBytes - 132);  // none more would have had room
}

TEST(OscBundleWriter, LeavesOutAMessageThatFitsNoPacket) {
  KeptPackets kept;
  OscBundleWriter writer(kept);
  const std::string longest(OscBundleWriter::kMostPacketBytes, 'x');
  writer.add("/text", {longest.c_str()});
  writer.add("/a", {std::int32_t{1}});
  writer.flush();
  EXPECT_EQ(writer.left_out(), 1u);
  ASSERT_EQ(kept.packets.size(), 1u);
  EXPECT_EQ(decode_osc(kept.packets[0]).size(), 1u);
}

TEST(OscReader, ReadsAndWritesWithoutAllocating) {
  class Count : public OscPacketSink, public OscMessageSink {
   public:
    void on_packet(std::span<const std::uint8_t> packet) override { reader.read(packet, *this); }
    void on_message(const OscMessage& message) override { arguments += message.arguments.size(); }
    OscReader reader;
    std::size_t arguments = 0;
  } count;
  OscBundleWriter writer(count);
  const AllocationGuard guard;
  for (int i = 0; i < 1000; ++i) writer.add("/VMC/Ext/T", {"text", std::int32_t{i}, 0.5f});
  writer.flush();
  EXPECT_EQ(guard.allocations(), 0u);
  EXPECT_EQ(count.arguments, 3000u);
}

}  // namespace
}  // namespace dance
