#include "formats/mcap/mcap_writer.h"

#include <lzma.h>

#include <algorithm>
#include <utility>

#include "core/base/assert.h"

namespace dance {
namespace {

constexpr std::string_view kLibrary = "dancegraph";
constexpr std::string_view kCompression = "zstd";
constexpr std::size_t kRoom_bytes = std::size_t{1} << 20;

}  // namespace

McapWriter::McapWriter(Put put, std::size_t chunk_bytes, std::size_t most_index_bytes)
    : put_(std::move(put)), most_index_bytes_(most_index_bytes), chunk_(chunk_bytes) {
  record_.reserve(kRoom_bytes);
  chunk_index_.reserve(kRoom_bytes);
  this->put(kMcapMagic);
  record_.begin(McapOp::kHeader);
  record_.text("");  // no profile
  record_.text(kLibrary);
  record_.end();
  put_record();
}

void McapWriter::put(std::span<const std::uint8_t> bytes) {
  put_(bytes);
  offset_ += bytes.size();
  crc_ = lzma_crc32(bytes.data(), bytes.size(), crc_);
}

void McapWriter::put_record() {
  put(record_.bytes());
  record_.clear();
}

std::uint16_t McapWriter::add_schema(std::string_view name, std::string_view json_schema) {
  DANCE_ASSERT(schema_count_ < 0xffff, schema_count_);
  const std::size_t before = schemas_.size();
  schemas_.begin(McapOp::kSchema);
  schemas_.u16(++schema_count_);
  schemas_.text(name);
  schemas_.text("jsonschema");
  schemas_.text(json_schema);
  schemas_.end();
  put(schemas_.bytes().subspan(before));
  return schema_count_;
}

std::uint16_t McapWriter::add_channel(std::uint16_t schema, std::string_view topic) {
  DANCE_ASSERT(channel_messages_.size() < 0xffff, channel_messages_.size());
  channel_messages_.push_back(0);
  const auto id = static_cast<std::uint16_t>(channel_messages_.size());
  const std::size_t before = channels_.size();
  channels_.begin(McapOp::kChannel);
  channels_.u16(id);
  channels_.u16(schema);
  channels_.text(topic);
  channels_.text("json");
  channels_.end_list(channels_.begin_list());  // no metadata
  channels_.end();
  put(channels_.bytes().subspan(before));
  return id;
}

void McapWriter::write(std::uint16_t channel, std::uint32_t sequence, std::uint64_t log_ns,
                       std::uint64_t publish_ns, std::string_view json) {
  DANCE_ASSERT(channel >= 1 && channel <= channel_messages_.size(), channel);
  if (chunk_index_.size() >= most_index_bytes_) {
    ++left_out_;
    return;
  }
  if (!chunk_.add(channel, sequence, log_ns, publish_ns, json)) {
    end_chunk();
    if (!chunk_.add(channel, sequence, log_ns, publish_ns, json)) {
      ++left_out_;
      return;
    }
  }
  start_ns_ = messages_ == 0 ? log_ns : std::min(start_ns_, log_ns);
  end_ns_ = messages_ == 0 ? log_ns : std::max(end_ns_, log_ns);
  ++messages_;
  ++channel_messages_[channel - 1u];
}

void McapWriter::end_chunk() {
  if (chunk_.is_empty()) return;
  chunk_.end();
  const std::uint64_t chunk_offset = offset_;
  record_.begin(McapOp::kChunk);
  record_.u64(chunk_.start_ns());
  record_.u64(chunk_.end_ns());
  record_.u64(chunk_.uncompressed_bytes());
  record_.u32(chunk_.crc());
  record_.text(kCompression);
  record_.u64(chunk_.compressed().size());
  record_.end(chunk_.compressed().size());
  put_record();
  put(chunk_.compressed());
  index_chunk(chunk_offset, offset_ - chunk_offset);
  ++chunk_count_;
  chunk_.clear();
}

// The chunk's message index, of each channel one record, and its entry in the summary.
void McapWriter::index_chunk(std::uint64_t chunk_offset, std::uint64_t chunk_bytes) {
  const std::uint64_t index_offset = offset_;
  chunk_index_.begin(McapOp::kChunkIndex);
  chunk_index_.u64(chunk_.start_ns());
  chunk_index_.u64(chunk_.end_ns());
  chunk_index_.u64(chunk_offset);
  chunk_index_.u64(chunk_bytes);
  const std::size_t offsets = chunk_index_.begin_list();
  const auto entries = chunk_.entries();
  for (std::size_t i = 0; i < entries.size();) {
    const std::uint16_t channel = entries[i].channel;
    chunk_index_.u16(channel);
    chunk_index_.u64(index_offset + record_.size());
    record_.begin(McapOp::kMessageIndex);
    record_.u16(channel);
    const std::size_t list = record_.begin_list();
    for (; i < entries.size() && entries[i].channel == channel; ++i) {
      record_.u64(entries[i].log_ns);
      record_.u64(entries[i].offset);
    }
    record_.end_list(list);
    record_.end();
  }
  chunk_index_.end_list(offsets);
  chunk_index_.u64(record_.size());
  chunk_index_.text(kCompression);
  chunk_index_.u64(chunk_.compressed().size());
  chunk_index_.u64(chunk_.uncompressed_bytes());
  chunk_index_.end();
  put_record();
}

void McapWriter::put_summary() {
  struct Group {
    McapOp op;
    std::uint64_t start;
    std::uint64_t length;
  };
  std::vector<Group> groups;
  const auto put_group = [&](McapOp op, std::span<const std::uint8_t> records) {
    if (records.empty()) return;
    groups.push_back({op, offset_, records.size()});
    put(records);
  };
  const std::uint64_t summary_start = offset_;
  put_group(McapOp::kSchema, schemas_.bytes());
  put_group(McapOp::kChannel, channels_.bytes());
  record_.begin(McapOp::kStatistics);
  record_.u64(messages_);
  record_.u16(schema_count_);
  record_.u32(static_cast<std::uint32_t>(channel_messages_.size()));
  record_.u32(0);  // attachments
  record_.u32(0);  // metadata
  record_.u32(chunk_count_);
  record_.u64(start_ns_);
  record_.u64(end_ns_);
  const std::size_t counts = record_.begin_list();
  for (std::size_t i = 0; i < channel_messages_.size(); ++i) {
    if (channel_messages_[i] == 0) continue;
    record_.u16(static_cast<std::uint16_t>(i + 1));
    record_.u64(channel_messages_[i]);
  }
  record_.end_list(counts);
  record_.end();
  put_group(McapOp::kStatistics, record_.bytes());
  record_.clear();
  put_group(McapOp::kChunkIndex, chunk_index_.bytes());
  const std::uint64_t offsets_start = offset_;
  for (const Group& group : groups) {
    record_.begin(McapOp::kSummaryOffset);
    record_.u8(static_cast<std::uint8_t>(group.op));
    record_.u64(group.start);
    record_.u64(group.length);
    record_.end();
  }
  put_record();
  record_.begin(McapOp::kFooter);
  record_.u64(summary_start);
  record_.u64(offsets_start);
  record_.end(4);  // the checksum, over all before it
  put_record();
  record_.u32(crc_);
  put_record();
}

void McapWriter::finish() {
  end_chunk();
  record_.begin(McapOp::kDataEnd);
  record_.u32(crc_);
  record_.end();
  put_record();
  crc_ = 0;
  put_summary();
  put(kMcapMagic);
}

}  // namespace dance
