#include "tunnel/wire/wire_files.h"

namespace dance::wire {
namespace {

void begin_file(Type type, ByteWriter& out) { out.u8(static_cast<std::uint8_t>(type)); }

void write_file_name(const FileName& name, ByteWriter& out) {
  out.u8(name.slot.slot);
  out.u16(name.slot.generation);
  out.bytes(name.hash.bytes);
}

FileName read_file_name(ByteReader& in) {
  FileName name;
  name.slot.slot = in.u8();
  name.slot.generation = in.u16();
  const Bytes hash = in.bytes(name.hash.bytes.size());
  std::copy(hash.begin(), hash.end(), name.hash.bytes.begin());
  return name;
}

bool is_good_name(const FileName& name) {
  return name.slot.slot < kMaxGuestsPerRoom && name.hash.is_set();
}

std::size_t size_or_nothing(const ByteWriter& out) { return out.ok() ? out.size() : 0; }

}  // namespace

std::size_t build(const FileTerms& terms, std::span<std::uint8_t> buffer) {
  ByteWriter out(buffer);
  begin_file(Type::kFileTerms, out);
  out.u8(kFileTermsVersion);
  out.u32(terms.bytes_per_second);
  return size_or_nothing(out);
}

// What a later version says behind these is left out.
std::optional<FileTerms> parse_file_terms(Bytes body) {
  ByteReader in(body);
  const std::uint8_t version = in.u8();
  FileTerms terms;
  terms.bytes_per_second = in.u32();
  if (!in.ok() || version < kFileTermsVersion) return std::nullopt;
  return terms;
}

std::size_t build(const FileWant& want, std::span<std::uint8_t> buffer) {
  ByteWriter out(buffer);
  begin_file(Type::kFileWant, out);
  write_file_name(want.file, out);
  out.u16(want.first);
  out.u32(want.chunks);
  return size_or_nothing(out);
}

std::optional<FileWant> parse_file_want(Bytes body) {
  ByteReader in(body);
  FileWant want;
  want.file = read_file_name(in);
  want.first = in.u16();
  want.chunks = in.u32();
  if (!in.is_exhausted() || !is_good_name(want.file) || (want.chunks & 1) == 0 ||
      want.first + static_cast<std::size_t>(std::bit_width(want.chunks)) > kMaxFileChunks)
    return std::nullopt;
  return want;
}

std::size_t build(const FileChunk& chunk, std::span<std::uint8_t> buffer) {
  ByteWriter out(buffer);
  begin_file(Type::kFileChunk, out);
  write_file_name(chunk.file, out);
  out.u32(chunk.size_bytes);
  out.u16(chunk.index);
  out.bytes(chunk.data);
  return size_or_nothing(out);
}

std::optional<FileChunk> parse_file_chunk(Bytes body) {
  ByteReader in(body);
  FileChunk chunk;
  chunk.file = read_file_name(in);
  chunk.size_bytes = in.u32();
  chunk.index = in.u16();
  if (!in.ok() || !is_good_name(chunk.file) || chunk.size_bytes == 0 ||
      chunk.size_bytes > kMaxFileBytes || chunk.index >= chunks_of(chunk.size_bytes) ||
      in.remaining() != chunk_bytes(chunk.size_bytes, chunk.index))
    return std::nullopt;
  chunk.data = in.bytes(in.remaining());
  return chunk;
}

std::size_t build(const FileRefusal& refusal, std::span<std::uint8_t> buffer) {
  ByteWriter out(buffer);
  begin_file(Type::kFileRefusal, out);
  write_file_name(refusal.file, out);
  out.u8(static_cast<std::uint8_t>(refusal.cause));
  return size_or_nothing(out);
}

std::optional<FileRefusal> parse_file_refusal(Bytes body) {
  ByteReader in(body);
  FileRefusal refusal;
  refusal.file = read_file_name(in);
  const std::uint8_t cause = in.u8();
  refusal.cause = static_cast<FileRefusalCause>(cause);
  if (!in.is_exhausted() || !is_good_name(refusal.file) ||
      cause < static_cast<std::uint8_t>(FileRefusalCause::kNotOffered) ||
      cause > static_cast<std::uint8_t>(FileRefusalCause::kFull))
    return std::nullopt;
  return refusal;
}

}  // namespace dance::wire
