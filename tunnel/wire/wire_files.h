// The datagrams in which avatars' files travel, built and parsed: what each side takes, which parts
// of a file are wanted, a part, and why there is none. docs/wire-format.md says them byte by byte.
//
// Units/frames: little-endian; files in chunks of kFileChunk bytes, the last one shorter.
// Ownership:    data are views of the caller's bytes.
// Threads:      none inside.
// Failure:      as in tunnel/wire/wire.h; nothing here allocates.
#pragma once

#include <bit>

#include "core/base/file_hash.h"
#include "core/bus/state_messages.h"
#include "tunnel/wire/wire.h"

namespace dance::wire {

constexpr std::size_t kFileChunk = 1024;
constexpr std::uint32_t kMaxFileBytes = kMaxAvatarFileBytes;
constexpr std::size_t kMaxFileChunks = kMaxFileBytes / kFileChunk;
constexpr std::size_t kChunksPerWant = 32;
constexpr std::uint8_t kFileTermsVersion = 1;

constexpr std::size_t chunks_of(std::uint32_t size_bytes) {
  return (size_bytes + kFileChunk - 1) / kFileChunk;
}
constexpr std::size_t chunk_bytes(std::uint32_t size_bytes, std::size_t index) {
  return std::min(kFileChunk, size_bytes - index * kFileChunk);
}

// Who says this knows the records below and the state of kind kAvatarFile.
struct FileTerms {
  std::uint32_t bytes_per_second = 0;  // that this side sends and takes at most; 0 = no files
};

// Whose file, and which.
struct FileName {
  Slot slot;
  FileHash hash;
  bool operator==(const FileName&) const = default;
};

struct FileWant {
  FileName file;
  std::uint16_t first = 0;
  std::uint32_t chunks = 1;  // bit i: chunk first + i; bit 0 is set

  bool has(std::size_t index) const {
    return index >= first && index - first < kChunksPerWant && (chunks >> (index - first) & 1) != 0;
  }
};

struct FileChunk {
  FileName file;
  std::uint32_t size_bytes = 0;  // of the file
  std::uint16_t index = 0;
  Bytes data;
};

enum class FileRefusalCause : std::uint8_t {
  kNotOffered = 1,  // the guest has chosen another, or its house no longer has it
  kNoFiles = 2,     // the guest's house sends no files
  kFull = 3,        // the server has no memory for it just now
};
struct FileRefusal {
  FileName file;
  FileRefusalCause cause = FileRefusalCause::kNotOffered;
};

// Of a chunk, in an inner datagram.
constexpr std::size_t kFileChunkHeader = 1 + 3 + 32 + 4 + 2;
static_assert(kFileChunkHeader + kFileChunk <= kMaxPlain);
// What a full chunk takes of a path, but for the headers of IP and UDP.
constexpr std::size_t kFileChunkCost = kFileChunkHeader + kFileChunk + kSealOverhead;

std::size_t build(const FileTerms& terms, std::span<std::uint8_t> out);
std::size_t build(const FileWant& want, std::span<std::uint8_t> out);
std::size_t build(const FileChunk& chunk, std::span<std::uint8_t> out);
std::size_t build(const FileRefusal& refusal, std::span<std::uint8_t> out);

std::optional<FileTerms> parse_file_terms(Bytes body);
std::optional<FileWant> parse_file_want(Bytes body);
std::optional<FileChunk> parse_file_chunk(Bytes body);
std::optional<FileRefusal> parse_file_refusal(Bytes body);

}  // namespace dance::wire
