#include "formats/lz4/lz4_frame.h"

#include <lz4frame.h>

#include <cstring>

#include "core/base/assert.h"

namespace dance {
namespace {

constexpr std::uint8_t kMagic[] = {0x04, 0x22, 0x4d, 0x18};

LZ4F_preferences_t preferences_for(std::size_t text_bytes) {
  LZ4F_preferences_t preferences{};
  preferences.frameInfo.contentSize = text_bytes;
  return preferences;
}

}  // namespace

bool begins_as_lz4_frame(std::span<const std::uint8_t> bytes) {
  return bytes.size() >= sizeof kMagic && std::memcmp(bytes.data(), kMagic, sizeof kMagic) == 0;
}

Lz4Unpacker::Lz4Unpacker(std::size_t most_bytes) : text_(most_bytes) {
  const auto made = LZ4F_createDecompressionContext(&context_, LZ4F_VERSION);
  DANCE_ASSERT(!LZ4F_isError(made));
}

Lz4Unpacker::~Lz4Unpacker() { LZ4F_freeDecompressionContext(context_); }

std::optional<std::string_view> Lz4Unpacker::unpack(std::span<const std::uint8_t> frame) {
  LZ4F_resetDecompressionContext(context_);
  std::size_t read = 0, written = 0;
  // Each turn must move on, else the frame ends before it says so or says more than there is room
  // for.
  while (true) {
    std::size_t in = frame.size() - read, out = text_.size() - written;
    const std::size_t state =
        LZ4F_decompress(context_, text_.data() + written, &out, frame.data() + read, &in, nullptr);
    if (LZ4F_isError(state)) return std::nullopt;
    read += in;
    written += out;
    if (state == 0) break;
    if (in == 0 && out == 0) return std::nullopt;
  }
  if (read != frame.size()) return std::nullopt;
  return std::string_view(text_.data(), written);
}

Lz4Packer::Lz4Packer(std::size_t most_text_bytes) {
  const LZ4F_preferences_t preferences = preferences_for(most_text_bytes);
  frame_.resize(LZ4F_compressFrameBound(most_text_bytes, &preferences));
}

std::optional<std::span<const std::uint8_t>> Lz4Packer::pack(std::string_view text,
                                                             std::size_t most_bytes) {
  const LZ4F_preferences_t preferences = preferences_for(text.size());
  if (LZ4F_compressFrameBound(text.size(), &preferences) > frame_.size()) return std::nullopt;
  const std::size_t size =
      LZ4F_compressFrame(frame_.data(), frame_.size(), text.data(), text.size(), &preferences);
  if (LZ4F_isError(size) || size > most_bytes) return std::nullopt;
  return std::span<const std::uint8_t>(frame_.data(), size);
}

}  // namespace dance
