#include "tests/field_mutation.h"

#include <algorithm>
#include <array>
#include <cstring>
#include <string>
#include <string_view>

namespace dance {
namespace {

using Bytes = std::vector<std::uint8_t>;

constexpr std::array<std::string_view, 22> kNumbers{"0",
                                                    "1",
                                                    "-1",
                                                    "2",
                                                    "3",
                                                    "127",
                                                    "255",
                                                    "256",
                                                    "65535",
                                                    "65536",
                                                    "2147483647",
                                                    "-2147483648",
                                                    "4294967295",
                                                    "4294967296",
                                                    "1e9",
                                                    "1e308",
                                                    "-1e308",
                                                    "1e999",
                                                    "0.5",
                                                    "1e-320",
                                                    "9007199254740993",
                                                    "18446744073709551616"};

bool is_digit(std::uint8_t c) { return c >= '0' && c <= '9'; }
bool is_of_number(std::uint8_t c) {
  return is_digit(c) || c == '-' || c == '+' || c == '.' || c == 'e' || c == 'E';
}

struct Piece {
  std::size_t begin, end;
};

// Numbers in text from `begin` to `end`: they stand behind a delimiter.
std::vector<Piece> numbers_in(std::span<const std::uint8_t> text, Piece within) {
  std::vector<Piece> numbers;
  for (std::size_t i = within.begin; i < within.end; ++i) {
    const bool is_first = i == within.begin || std::strchr(" \t\r\n,:[({=\"", text[i - 1]);
    if (!is_first || !(is_digit(text[i]) || text[i] == '-')) continue;
    std::size_t end = i + 1;
    while (end < within.end && is_of_number(text[end])) ++end;
    if (is_digit(text[end - 1])) numbers.push_back({i, end});
    i = end;
  }
  return numbers;
}

std::uint32_t little_endian(std::span<const std::uint8_t> bytes, std::size_t at) {
  std::uint32_t value = 0;
  std::memcpy(&value, bytes.data() + at, sizeof value);
  return value;
}

void put_little_endian(Bytes& bytes, std::size_t at, std::size_t value) {
  const auto word = static_cast<std::uint32_t>(value);
  std::memcpy(bytes.data() + at, &word, sizeof word);
}

// A GLB: 12 bytes of header, then the JSON chunk: length, "JSON", text.
constexpr std::size_t kJsonAt = 20;
bool is_glb(std::span<const std::uint8_t> bytes) {
  return bytes.size() > kJsonAt && std::memcmp(bytes.data(), "glTF", 4) == 0 &&
         std::memcmp(bytes.data() + 16, "JSON", 4) == 0 &&
         little_endian(bytes, 12) <= bytes.size() - kJsonAt;
}

Bytes with_text_replaced(std::span<const std::uint8_t> input, Piece piece, std::string_view by) {
  Bytes bytes(input.begin(), input.begin() + static_cast<std::ptrdiff_t>(piece.begin));
  bytes.insert(bytes.end(), by.begin(), by.end());
  bytes.insert(bytes.end(), input.begin() + static_cast<std::ptrdiff_t>(piece.end), input.end());
  if (!is_glb(input)) return bytes;
  // The JSON chunk is padded with spaces to a multiple of four.
  std::size_t json_size = little_endian(input, 12) + by.size() - (piece.end - piece.begin);
  const std::size_t padding = (4 - json_size % 4) % 4;
  bytes.insert(bytes.begin() + static_cast<std::ptrdiff_t>(kJsonAt + json_size), padding, ' ');
  json_size += padding;
  put_little_endian(bytes, 12, json_size);
  put_little_endian(bytes, 8, bytes.size());
  return bytes;
}

// Changes an integer of 1, 2, 4 or 8 bytes, in either byte order.
void mutate_integer(Bytes& bytes, Random& random) {
  const std::size_t size = std::size_t{1} << random.below(4);
  if (bytes.size() < size) return;
  const std::size_t at = random.below(bytes.size() - size + 1);
  const std::uint64_t most = size == 8 ? ~0ULL : (1ULL << 8 * size) - 1;
  std::uint64_t value = 0;
  const bool is_big_endian = random.below(2) == 0;
  for (std::size_t i = 0; i < size; ++i)
    value = value << 8 | bytes[is_big_endian ? at + i : at + size - 1 - i];
  const std::array<std::uint64_t, 10> values{0,
                                             1,
                                             most,
                                             most >> 1,
                                             (most >> 1) + 1,
                                             bytes.size(),
                                             bytes.size() - at,
                                             value + 1,
                                             value - 1,
                                             value << 1 | 1};
  value = values[random.below(values.size())];
  for (std::size_t i = 0; i < size; ++i)
    bytes[is_big_endian ? at + size - 1 - i : at + i] = static_cast<std::uint8_t>(value >> 8 * i);
}

}  // namespace

std::vector<std::uint8_t> with_field_mutated(std::span<const std::uint8_t> input, Random& random) {
  const bool has_json = is_glb(input);
  const Piece text =
      has_json ? Piece{kJsonAt, kJsonAt + little_endian(input, 12)} : Piece{0, input.size()};
  const std::vector<Piece> numbers = numbers_in(input, text);
  if (!numbers.empty() && random.below(4) != 0) {
    const Piece number = numbers[random.below(numbers.size())];
    // One of the file's other numbers may be an index that is valid elsewhere.
    const Piece other = numbers[random.below(numbers.size())];
    const std::string copied(input.begin() + static_cast<std::ptrdiff_t>(other.begin),
                             input.begin() + static_cast<std::ptrdiff_t>(other.end));
    const std::size_t choice = random.below(kNumbers.size() + 6);
    return with_text_replaced(input, number, choice < kNumbers.size() ? kNumbers[choice] : copied);
  }
  Bytes bytes(input.begin(), input.end());
  mutate_integer(bytes, random);
  return bytes;
}

}  // namespace dance
