#include "testing/line/trace_file.h"

#include <lzma.h>

#include <array>
#include <fstream>

namespace dance {
namespace {

constexpr std::string_view kXzMagic(
    "\xfd"
    "7zXZ\0",
    6);
constexpr std::size_t kMostXzMemory_bytes = 256u << 20;
constexpr std::size_t kLongestQuote = 40;

Result<std::string> unpack_xz(const std::string& packed) {
  lzma_stream stream = LZMA_STREAM_INIT;
  if (lzma_stream_decoder(&stream, kMostXzMemory_bytes, LZMA_CONCATENATED) != LZMA_OK)
    return fail("no memory to unpack it");
  stream.next_in = reinterpret_cast<const std::uint8_t*>(packed.data());
  stream.avail_in = packed.size();
  std::string text;
  std::array<std::uint8_t, 65536> piece;
  lzma_ret state = LZMA_OK;
  while (state == LZMA_OK && text.size() <= kMostTraceBytes) {
    stream.next_out = piece.data();
    stream.avail_out = piece.size();
    state = lzma_code(&stream, LZMA_FINISH);
    text.append(reinterpret_cast<const char*>(piece.data()), piece.size() - stream.avail_out);
  }
  lzma_end(&stream);
  if (text.size() > kMostTraceBytes) return fail("it unpacks to more than 64 MB");
  if (state != LZMA_STREAM_END) return fail("it is not a whole xz file: get it again");
  return text;
}

}  // namespace

Result<std::string> unpack_trace(std::string bytes) {
  return bytes.starts_with(kXzMagic) ? unpack_xz(bytes) : Result<std::string>(std::move(bytes));
}

Result<std::string> read_trace_file(const std::string& path) {
  std::ifstream file(path, std::ios::binary);
  std::string bytes;
  std::array<char, 65536> piece;
  while (file.read(piece.data(), piece.size()) || file.gcount() > 0) {
    bytes.append(piece.data(), static_cast<std::size_t>(file.gcount()));
    if (bytes.size() > kMostTraceBytes)
      return fail("trace '" + path + "' has more than 64 MB: cut it");
  }
  if (!file.is_open() || file.bad())
    return fail("trace '" + path + "' cannot be read: check the path");
  auto text = unpack_trace(std::move(bytes));
  if (!text) return fail("trace '" + path + "': " + text.error().what);
  return text;
}

tl::unexpected<Error> broken_trace_line(std::size_t line, const char* what, std::string_view text) {
  std::string quote(text.substr(0, kLongestQuote));
  for (char& c : quote)
    if (c < ' ' || c > '~') c = '?';
  return fail("line " + std::to_string(line) + ": " + what + " '" + quote + "'");
}

}  // namespace dance
