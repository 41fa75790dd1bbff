#include "formats/mcap/mcap_reader.h"

#include <lzma.h>
#include <zstd.h>

#include <algorithm>
#include <cerrno>
#include <filesystem>
#include <limits>
#include <system_error>

#include "core/base/byte_reader.h"
#include "formats/lz4/lz4_frame.h"

namespace dance {
namespace {

// A hostile length makes the buffer grow no further than the file has bytes, and one such step.
constexpr std::size_t kStep_bytes = std::size_t{1} << 20;
constexpr std::size_t kFirstStep_bytes = std::size_t{4} << 10;  // of a search behind damage

// Records that have to follow each other where reading goes on behind damage.
constexpr int kRecordsInARow = 3;
// Bounds the time that a hostile file can cost.
constexpr int kMostTries = 100'000;

// Records without which something is missing; the others are indexes of the file.
constexpr bool is_content(McapOp op) {
  return op == McapOp::kSchema || op == McapOp::kChannel || op == McapOp::kMessage ||
         op == McapOp::kChunk;
}
constexpr bool is_op(std::uint8_t op) { return op > 0 && op <= 0x0f; }
constexpr bool is_private_op(std::uint8_t op) { return op >= 0x80; }

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
  const auto size = std::filesystem::file_size(path, error);
  if (!error && std::filesystem::is_regular_file(path, error)) reader.size_bytes_ = size;
  if (auto begun = reader.begin(path); !begun) return tl::make_unexpected(begun.error());
  return reader;
}

Result<McapReader> McapReader::over(std::span<const std::uint8_t> bytes) {
  McapReader reader;
  reader.whole_ = reader.memory_ = bytes;
  reader.size_bytes_ = bytes.size();
  if (auto begun = reader.begin("the file"); !begun) return tl::make_unexpected(begun.error());
  return reader;
}

Result<void> McapReader::begin(std::string name) {
  name_ = std::move(name);
  const auto magic = read(kMcapMagic.size());
  if (magic && std::equal(magic->begin(), magic->end(), kMcapMagic.begin())) return {};
  if (read_error_ != 0) return ended();
  return fail(name_ + ": is no MCAP file; name one that was recorded with dance listen --to mcap");
}

Result<void> McapReader::rewind() {
  if (file_) std::rewind(file_.get());
  memory_ = whole_;
  at_bytes_ = 0;
  chunk_ = {};
  schemas_.clear();
  channels_.clear();
  counters_ = {};
  is_at_end_ = was_finished_ = false;
  tries_ = 0;
  read_error_ = 0;
  return begin(name_);
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
    at_bytes_ += bytes;
    return taken;
  }
  for (std::size_t has = 0; has < bytes;) {
    const std::size_t step = std::min(bytes - has, kStep_bytes);
    if (buffer_.size() < has + step) buffer_.resize(has + step);
    const std::size_t got = std::fread(buffer_.data() + has, 1, step, file_.get());
    has += got;
    at_bytes_ += got;
    if (got == step) continue;
    if (std::ferror(file_.get())) read_error_ = errno;
    return std::nullopt;
  }
  return std::span<const std::uint8_t>(buffer_.data(), bytes);
}

std::uint64_t McapReader::left_bytes() const {
  if (!size_bytes_) return std::numeric_limits<std::uint64_t>::max();
  return *size_bytes_ - std::min(*size_bytes_, at_bytes_);
}

std::span<const std::uint8_t> McapReader::look_at(std::uint64_t at, std::size_t most) {
  if (!file_)
    return whole_.subspan(std::min<std::uint64_t>(at, whole_.size()))
        .first(std::min<std::uint64_t>(most,
                                       whole_.size() - std::min<std::uint64_t>(at, whole_.size())));
  window_.resize(most);
  if (fseeko(file_.get(), static_cast<off_t>(at), SEEK_SET) != 0) return {};
  return std::span(window_).first(std::fread(window_.data(), 1, most, file_.get()));
}

// Whether a record begins there that others follow, several of them or up to the end of the file.
bool McapReader::begins_records(std::uint64_t at) {
  for (int i = 0; i < kRecordsInARow; ++i) {
    const auto head = look_at(at, kMcapRecordHead_bytes);
    if (i > 0 &&
        std::ranges::equal(head.first(std::min(head.size(), kMcapMagic.size())), kMcapMagic))
      return true;
    ByteReader reader(head);
    const std::uint8_t op = reader.u8();
    const std::uint64_t length = reader.u64();
    if (!reader.ok() || !is_op(op) || length > *size_bytes_ - at - kMcapRecordHead_bytes)
      return false;
    at += kMcapRecordHead_bytes + length;
    if (at == *size_bytes_) return true;
  }
  return true;
}

// Goes on behind damage, with the next records from there on; false where none follow.
bool McapReader::find_records(std::uint64_t from) {
  if (!size_bytes_) return false;
  if (++tries_ > kMostTries) return false;
  std::vector<std::uint8_t> bytes;
  std::size_t step = kFirstStep_bytes;
  for (std::uint64_t at = from + 1; at < *size_bytes_; step = std::min(2 * step, kStep_bytes)) {
    const auto some = look_at(at, step);
    if (some.size() < kMcapRecordHead_bytes) return false;
    bytes.assign(some.begin(), some.end());
    const std::size_t last = bytes.size() - kMcapRecordHead_bytes;
    for (std::size_t i = 0; i <= last; ++i) {
      // No record is longer than 2^40 bytes.
      if (!is_op(bytes[i]) || (bytes[i + 6] | bytes[i + 7] | bytes[i + 8]) != 0) continue;
      if (++tries_ > kMostTries) return false;
      if (!begins_records(at + i)) continue;
      counters_.damaged_bytes += at + i - from;
      at_bytes_ = at + i;
      if (file_) return fseeko(file_.get(), static_cast<off_t>(at_bytes_), SEEK_SET) == 0;
      memory_ = whole_.subspan(static_cast<std::size_t>(at_bytes_));
      return true;
    }
    at += last + 1;
  }
  return false;
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
  const std::uint64_t at = at_bytes_;
  const std::uint64_t left = left_bytes();
  const auto head = read(kMcapRecordHead_bytes);
  if (!head) {
    if (size_bytes_ && left > 0 && is_content(McapOp{file_ ? buffer_[0] : memory_[0]}))
      ++counters_.cut_records;
    is_at_end_ = true;
    return false;
  }
  ByteReader reader(*head);
  const std::uint8_t code = reader.u8();
  const auto op = static_cast<McapOp>(code);
  const std::uint64_t length = reader.u64();
  const bool is_known = is_op(code) || is_private_op(code);
  if (!is_known || length > left_bytes()) {
    if (find_records(at)) return false;
    if (is_known)
      counters_.cut_records += is_content(op);
    else if (size_bytes_)
      counters_.damaged_bytes += left;
    is_at_end_ = true;
    return false;
  }
  // After the data there are only indexes of it.
  if (op == McapOp::kDataEnd || op == McapOp::kFooter) {
    was_finished_ = is_at_end_ = true;
    return false;
  }
  if (!is_content(op)) {
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
    ++counters_.cut_records;
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
  if (!compression.empty() && compression != "zstd" && compression != "lz4") {
    ++counters_.other_compression;
    return;
  }
  const auto unpacked = unpack(compression, static_cast<std::size_t>(size), packed);
  if (!unpacked) {
    ++counters_.damaged_chunks;
    return;
  }
  chunk_ = *unpacked;
  if (crc != 0 && lzma_crc32(chunk_.data(), chunk_.size(), 0) != crc) {
    ++counters_.damaged_chunks;
    chunk_ = {};
  }
}

std::optional<std::span<const std::uint8_t>> McapReader::unpack(
    std::string_view compression, std::size_t size, std::span<const std::uint8_t> packed) {
  if (compression.empty()) return packed;
  if (compression == "lz4") {
    if (!lz4_ || lz4_bytes_ < size) {
      lz4_ = std::make_unique<Lz4Unpacker>(size);
      lz4_bytes_ = size;
    }
    const auto bytes = lz4_->unpack(packed);
    if (!bytes || bytes->size() != size) return std::nullopt;
    return std::span(reinterpret_cast<const std::uint8_t*>(bytes->data()), bytes->size());
  }
  unpacked_.resize(size);
  const std::size_t got = ZSTD_decompressDCtx(context_.get(), unpacked_.data(), unpacked_.size(),
                                              packed.data(), packed.size());
  if (ZSTD_isError(got) || got != size) return std::nullopt;
  return unpacked_;
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
