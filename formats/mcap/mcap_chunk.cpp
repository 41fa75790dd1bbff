#include "formats/mcap/mcap_chunk.h"

#include <lzma.h>
#include <zstd.h>

#include <algorithm>
#include <array>

#include "core/base/assert.h"
#include "core/base/byte_writer.h"
#include "formats/mcap/mcap_record.h"

namespace dance {
namespace {

// Text of numbers: higher levels cost a multiple of the time for a few per cent.
constexpr int kLevel = 1;
constexpr std::size_t kMessageHead_bytes = kMcapRecordHead_bytes + 2 + 4 + 8 + 8;
constexpr std::size_t kMostEntries = std::size_t{1} << 15;

}  // namespace

void McapChunk::FreeContext::operator()(ZSTD_CCtx_s* context) const { ZSTD_freeCCtx(context); }

McapChunk::McapChunk(std::size_t most_bytes)
    : context_(ZSTD_createCCtx()), most_bytes_(most_bytes) {
  DANCE_ASSERT(context_ != nullptr, most_bytes);
  ZSTD_CCtx_setParameter(context_.get(), ZSTD_c_compressionLevel, kLevel);
  out_.resize(ZSTD_compressBound(most_bytes) + ZSTD_CStreamOutSize());
  entries_.reserve(kMostEntries);
  // The context allocates with its first frame.
  const std::array<std::uint8_t, 1> byte{};
  compress(byte, true);
  clear();
}

McapChunk::~McapChunk() = default;
McapChunk::McapChunk(McapChunk&&) noexcept = default;

void McapChunk::compress(std::span<const std::uint8_t> bytes, bool is_end) {
  ZSTD_inBuffer in{bytes.data(), bytes.size(), 0};
  ZSTD_outBuffer out{out_.data(), out_.size(), out_size_};
  for (;;) {
    const std::size_t left =
        ZSTD_compressStream2(context_.get(), &out, &in, is_end ? ZSTD_e_end : ZSTD_e_continue);
    DANCE_ASSERT(!ZSTD_isError(left), left, out.pos);
    if (is_end ? left == 0 : in.pos == in.size) break;
  }
  out_size_ = out.pos;
  crc_ = lzma_crc32(bytes.data(), bytes.size(), crc_);
  uncompressed_bytes_ += bytes.size();
}

bool McapChunk::add(std::uint16_t channel, std::uint32_t sequence, std::uint64_t log_ns,
                    std::uint64_t publish_ns, std::string_view data) {
  if (uncompressed_bytes_ + kMessageHead_bytes + data.size() > most_bytes_ ||
      entries_.size() == kMostEntries)
    return false;
  start_ns_ = entries_.empty() ? log_ns : std::min(start_ns_, log_ns);
  end_ns_ = entries_.empty() ? log_ns : std::max(end_ns_, log_ns);
  entries_.push_back({channel, log_ns, uncompressed_bytes_});
  std::array<std::uint8_t, kMessageHead_bytes> head;
  ByteWriter writer(head);
  writer.u8(static_cast<std::uint8_t>(McapOp::kMessage));
  writer.u64(kMessageHead_bytes - kMcapRecordHead_bytes + data.size());
  writer.u16(channel);
  writer.u32(sequence);
  writer.u64(log_ns);
  writer.u64(publish_ns);
  compress(head, false);
  compress({reinterpret_cast<const std::uint8_t*>(data.data()), data.size()}, false);
  return true;
}

void McapChunk::end() {
  compress({}, true);
  std::sort(entries_.begin(), entries_.end(), [](const Entry& a, const Entry& b) {
    return a.channel != b.channel ? a.channel < b.channel : a.offset < b.offset;
  });
}

void McapChunk::clear() {
  out_size_ = 0;
  entries_.clear();
  uncompressed_bytes_ = 0;
  crc_ = 0;
}

}  // namespace dance
