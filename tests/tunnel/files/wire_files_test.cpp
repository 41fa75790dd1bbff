// The datagrams of files: written, read, and refused where they are damaged.
#include "tunnel/wire/wire_files.h"

#include <gtest/gtest.h>

#include "tests/tunnel/files/test_file.h"

namespace dance::wire {
namespace {

std::vector<std::uint8_t> data_of(const TestFile& file, std::size_t index) {
  return {file.chunk(index).begin(), file.chunk(index).end()};
}

template <class Message>
std::vector<std::uint8_t> built(const Message& message) {
  std::array<std::uint8_t, kMaxPlain> out;
  const std::size_t size = build(message, out);
  return {out.begin(), out.begin() + static_cast<std::ptrdiff_t>(size)};
}

Bytes body_of(const std::vector<std::uint8_t>& datagram) { return Bytes(datagram).subspan(1); }

const TestFile kFile = test_file(100'000);
const FileName kName{{5, 777}, kFile.hash};

TEST(WireFiles, ComeBackAsTheyWereWritten) {
  const auto terms = parse_file_terms(body_of(built(FileTerms{131'072})));
  ASSERT_TRUE(terms);
  EXPECT_EQ(terms->bytes_per_second, 131'072u);

  const auto want = parse_file_want(body_of(built(FileWant{kName, 40, 0x80000005})));
  ASSERT_TRUE(want);
  EXPECT_EQ(want->file, kName);
  for (std::size_t i = 0; i < 200; ++i) EXPECT_EQ(want->has(i), i == 40 || i == 42 || i == 71) << i;

  for (const std::uint16_t index : std::array<std::uint16_t, 3>{0, 50, 97}) {
    const auto data = data_of(kFile, index);
    const auto datagram = built(FileChunk{kName, kFile.size(), index, data});
    EXPECT_LE(datagram.size(), kMaxPlain);
    const auto chunk = parse_file_chunk(body_of(datagram));
    ASSERT_TRUE(chunk) << index;
    EXPECT_EQ(chunk->size_bytes, kFile.size());
    EXPECT_EQ(chunk->index, index);
    EXPECT_TRUE(std::ranges::equal(chunk->data, data));
  }
  const auto refusal =
      parse_file_refusal(body_of(built(FileRefusal{kName, FileRefusalCause::kFull})));
  ASSERT_TRUE(refusal);
  EXPECT_EQ(refusal->cause, FileRefusalCause::kFull);
}

TEST(WireFiles, AreTheBytesOfThePage) {
  const auto want = built(FileWant{kName, 0x0102, 0x00000003});
  EXPECT_EQ(want.size(), 42u);
  EXPECT_EQ(want[0], 26);
  EXPECT_EQ(want[1], 5);  // slot
  EXPECT_EQ(want[2] | want[3] << 8, 777);
  EXPECT_EQ(want[4], kFile.hash.bytes[0]);
  EXPECT_EQ(want[36], 0x02);
  EXPECT_EQ(want[37], 0x01);
  EXPECT_EQ(want[38], 3);
  EXPECT_EQ(built(FileTerms{1}), (std::vector<std::uint8_t>{25, 1, 1, 0, 0, 0}));
  EXPECT_EQ(built(FileRefusal{kName, FileRefusalCause::kNoFiles}).size(), 37u);
  EXPECT_EQ(kFileChunkHeader, 42u);
}

template <class Parse>
void expect_survives(const std::vector<std::uint8_t>& datagram, Parse parse, bool has_tail) {
  for (std::size_t n = 0; n + 1 < datagram.size(); ++n)
    EXPECT_FALSE(parse(body_of(datagram).first(n))) << n;
  for (std::size_t bit = 8; bit < 8 * datagram.size(); ++bit) {
    auto flipped = datagram;
    flipped[bit / 8] ^= static_cast<std::uint8_t>(1u << bit % 8);
    parse(body_of(flipped));  // under the sanitizers
  }
  auto longer = datagram;
  longer.push_back(0);
  EXPECT_EQ(parse(body_of(longer)).has_value(), has_tail);
}

TEST(WireFiles, RefuseEveryPrefixAndSurviveEveryBitFlip) {
  const auto data = data_of(kFile, 97);                          // the short one
  expect_survives(built(FileTerms{1}), parse_file_terms, true);  // a later version may say more
  expect_survives(built(FileWant{kName, 1, 1}), parse_file_want, false);
  expect_survives(built(FileChunk{kName, kFile.size(), 97, data}), parse_file_chunk, false);
  expect_survives(built(FileRefusal{kName, FileRefusalCause::kFull}), parse_file_refusal, false);
}

TEST(WireFiles, RefuseWhatNoSideWrites) {
  const auto data = data_of(kFile, 0);
  const auto refuses_want = [](const FileWant& want) {
    return !parse_file_want(body_of(built(want)));
  };
  EXPECT_TRUE(refuses_want({kName, 0, 2})) << "the first is not wanted";
  EXPECT_TRUE(refuses_want({kName, 16'383, 3})) << "beyond the largest file";
  EXPECT_FALSE(refuses_want({kName, 16'383, 1}));
  EXPECT_TRUE(refuses_want({{{128, 1}, kFile.hash}, 0, 1})) << "no such slot";
  EXPECT_TRUE(refuses_want({{{5, 1}, FileHash()}, 0, 1})) << "no hash";
  const auto refuses_chunk = [](const FileChunk& chunk) {
    return !parse_file_chunk(body_of(built(chunk)));
  };
  EXPECT_TRUE(refuses_chunk({kName, 0, 0, data}));
  EXPECT_TRUE(refuses_chunk({kName, kMaxFileBytes + 1, 0, data}));
  EXPECT_FALSE(refuses_chunk({kName, kMaxFileBytes, 0, data}));
  EXPECT_TRUE(refuses_chunk({kName, 100'000, 98, data})) << "behind the last";
  EXPECT_TRUE(refuses_chunk({kName, 100'000, 97, data})) << "longer than the last is";
  EXPECT_TRUE(refuses_chunk({kName, 100'000, 0, Bytes(data).first(1000)}));
  EXPECT_FALSE(parse_file_refusal(body_of(built(FileRefusal{kName, FileRefusalCause(0)}))));
  EXPECT_FALSE(parse_file_refusal(body_of(built(FileRefusal{kName, FileRefusalCause(4)}))));
}

}  // namespace
}  // namespace dance::wire
