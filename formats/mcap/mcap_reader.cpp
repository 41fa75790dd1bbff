#include "formats/mcap/mcap_reader.h"

#include <lzma.h>
#include <zstd.h>

#include <algorithm>
#include <cerrno>
#include <filesystem>
#include <system_error>

#include "core/base/byte_reader.h"

namespace dance {
namespace {

// A hostile length makes the buffer grow no further than the file has bytes, and one such step.
constexpr std::size_t kStep_bytes = std::size_t{1} << 20;

std::string reason_of(int error) { return std::generic_category().message(error); }

std::string_view text_of(ByteReader& reader) { return reader.text(reader.u32()); }

}  // namespace

void McapReader::FreeContext::operator()(ZSTD_DCtx_s* context) const { ZSTD_freeDCtx(context); }

McapReader::McapReader() : context_(ZSTD_createDCtx()) {}
McapReader::McapReader(McapReader&&) noexcept = default;
McapReader& McapReader::operator=(McapReader&&) noexcept = default;
McapReader::~McapReader() = default;

Result<McapReader> McapReader::open(const std::string& path) {
  std::error_code error;
  if (std::filesystem::is_directory(path, error))
    return fail(path + ": is a folder, not an MCAP file; name a file in it");
  McapReader reader;
  reader.file_.reset(std::fopen(path.c_str(), "rbe"));
  if (!reader.file_) return fail(path + ": " + reason_of(errno));
  if (auto begun = reader.begin(path); !begun) return tl::make_unexpected(begun.error());
  return reader;
}

Result<McapReader> McapReader::over(std::span<const std::uint8_t> bytes) {
  McapReader reader;
  reader.memory_ = bytes;
  if (auto begun = reader.begin("the file"); !begun) return tl::make_unexpected(begun.error());
  return reader;
}

Result<void> McapReader::begin(const std::string& name) {
  name_ = name;
  const auto magic = read(kMcapMagic.size());
  if (magic && std::equal(magic->begin(), magic->end(), kMcapMagic.begin())) return {};
  if (read_error_ != 0) return ended();
  return fail(name + ": is no MCAP file; name one that was recorded with dance listen --to mcap");
}

Result<void> McapReader::ended() const {
  if (read_error_ == 0) return {};
  return fail(name_ + ": cannot be read to its end: " + reason_of(read_error_) +
              "; copy what can be had of it to another disk");
}

std::optional<std::span<const std::uint8_t>> McapReader::read(std::size_t bytes) {
  if (!file_) {
    if (memory_.size() < bytes) return std::nullopt;
    const auto taken = memory_.first(bytes);
    memory_ = memory_.subspan(bytes);
    return taken;
  }
  for (std::size_t has = 0; has < bytes;) {
    const std::size_t step = std::min(bytes - has, kStep_bytes);
    if (buffer_.size() < has + step) buffer_.resize(has + step);
    const std::size_t got = std::fread(buffer_.data() + has, 1, step, file_.get());
    has += got;
    if (got == step) continue;
    if (std::ferror(file_.get())) read_error_ = errno;
    return std::nullopt;
  }
  return std::span<const std::uint8_t>(buffer_.data(), bytes);
}

bool McapReader::skip(std::uint64_t bytes) {
  while (bytes > 0) {
    const auto step = static_cast<std::size_t>(std::min<std::uint64_t>(bytes, kStep_bytes));
    if (!read(step)) return false;
    bytes -= step;
  }
  return true;
}

std::optional<McapMessage> McapReader::next() {
  for (;;) {
    if (!chunk_.empty()) {
      if (next_in_chunk()) return message_;
    } else if (is_at_end_) {
      return std::nullopt;
    } else if (next_in_file()) {
      return message_;
    }
  }
}

bool McapReader::next_in_file() {
  const auto head = read(kMcapRecordHead_bytes);
  if (!head) {
    is_at_end_ = true;
    return false;
  }
  ByteReader reader(*head);
  const auto op = static_cast<McapOp>(reader.u8());
  const std::uint64_t length = reader.u64();
  // What comes after the data only tells where in it things are.
  if (op == McapOp::kDataEnd || op == McapOp::kFooter) {
    was_finished_ = is_at_end_ = true;
    return false;
  }
  if (op != McapOp::kSchema && op != McapOp::kChannel && op != McapOp::kMessage &&
      op != McapOp::kChunk) {
    is_at_end_ = !skip(length);
    return false;
  }
  if (length > kMostRecord_bytes) {
    ++counters_.oversized;
    is_at_end_ = !skip(length);
    return false;
  }
  const auto content = read(static_cast<std::size_t>(length));
  if (!content) {
    is_at_end_ = true;
    return false;
  }
  if (op != McapOp::kChunk) return take(op, *content);
  open_chunk(*content);
  return false;
}

bool McapReader::next_in_chunk() {
  ByteReader reader(chunk_);
  const auto op = static_cast<McapOp>(reader.u8());
  const std::uint64_t length = reader.u64();
  if (!reader.ok() || length > reader.remaining()) {
    ++counters_.malformed;
    chunk_ = {};
    return false;
  }
  const auto content = reader.bytes(static_cast<std::size_t>(length));
  chunk_ = chunk_.last(reader.remaining());
  return take(op, content);
}

bool McapReader::take(McapOp op, std::span<const std::uint8_t> content) {
  if (op == McapOp::kSchema) take_schema(content);
  if (op == McapOp::kChannel) take_channel(content);
  return op == McapOp::kMessage && take_message(content);
}

void McapReader::open_chunk(std::span<const std::uint8_t> content) {
  ByteReader reader(content);
  reader.u64();  // the times of its messages
  reader.u64();
  const std::uint64_t size = reader.u64();
  const std::uint32_t crc = reader.u32();
  const std::string_view compression = text_of(reader);
  const std::uint64_t packed_size = reader.u64();
  if (!reader.ok() || packed_size != reader.remaining()) {
    ++counters_.malformed;
    return;
  }
  const auto packed = reader.bytes(reader.remaining());
  if (size > kMostChunk_bytes ||
      (!compression.empty() && size > kFreeOfRatio_bytes && size / kMostRatio > packed_size)) {
    ++counters_.oversized;
    return;
  }
  if (compression.empty()) {
    chunk_ = packed;
  } else if (compression == "zstd") {
    unpacked_.resize(static_cast<std::size_t>(size));
    const std::size_t got = ZSTD_decompressDCtx(context_.get(), unpacked_.data(), unpacked_.size(),
                                                packed.data(), packed.size());
    if (ZSTD_isError(got) || got != size) {
      ++counters_.damaged_chunks;
      return;
    }
    chunk_ = unpacked_;
  } else {
    ++counters_.other_compression;
    return;
  }
  if (crc != 0 && lzma_crc32(chunk_.data(), chunk_.size(), 0) != crc) {
    ++counters_.damaged_chunks;
    chunk_ = {};
  }
}

void McapReader::take_schema(std::span<const std::uint8_t> content) {
  ByteReader reader(content);
  const std::uint16_t id = reader.u16();
  const std::string_view name = text_of(reader);
  if (!reader.ok() || id == 0 || name.size() > kMostName_bytes) {
    ++counters_.malformed;
    return;
  }
  if (schemas_.size() < kMostChannels)
    schemas_.try_emplace(id, name);
  else if (!schemas_.contains(id))
    ++counters_.beyond_channels;
}

void McapReader::take_channel(std::span<const std::uint8_t> content) {
  ByteReader reader(content);
  const std::uint16_t id = reader.u16();
  const std::uint16_t schema = reader.u16();
  const std::string_view topic = text_of(reader);
  const std::string_view encoding = text_of(reader);
  if (!reader.ok() || topic.size() > kMostName_bytes || encoding.size() > kMostName_bytes) {
    ++counters_.malformed;
    return;
  }
  if (channels_.size() < kMostChannels)
    channels_.try_emplace(id, Channel{schema, std::string(topic), std::string(encoding)});
  else if (!channels_.contains(id))
    ++counters_.beyond_channels;
}

bool McapReader::take_message(std::span<const std::uint8_t> content) {
  ByteReader reader(content);
  const std::uint16_t channel = reader.u16();
  message_.sequence = reader.u32();
  message_.log_ns = reader.u64();
  message_.publish_ns = reader.u64();
  if (!reader.ok()) {
    ++counters_.malformed;
    return false;
  }
  const auto found = channels_.find(channel);
  if (found == channels_.end()) {
    ++counters_.without_channel;
    return false;
  }
  const auto schema = schemas_.find(found->second.schema);
  message_.schema = schema == schemas_.end() ? std::string_view() : schema->second;
  message_.topic = found->second.topic;
  message_.encoding = found->second.encoding;
  message_.data = reader.text(reader.remaining());
  ++counters_.messages;
  return true;
}

}  // namespace dance
