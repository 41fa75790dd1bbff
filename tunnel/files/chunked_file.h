// ChunkedFile: a file that comes in chunks, in any order: its bytes, and which are here. Memory is
// taken a block at a time as chunks come, so that neither a claimed size costs anything nor a large
// file a long moment.
//
// Units/frames: chunks of wire::kFileChunk bytes.
// Ownership:    owns the bytes; movable.
// Threads:      none inside.
// Failure:      put() is false for a chunk that is here already.
#pragma once

#include <array>
#include <memory>
#include <vector>

#include "tunnel/wire/wire_files.h"

namespace dance {

class ChunkedFile {
 public:
  static constexpr std::size_t kChunksPerBlock = 64;
  static constexpr std::size_t kBlock = kChunksPerBlock * wire::kFileChunk;

  ChunkedFile() = default;
  explicit ChunkedFile(std::uint32_t size_bytes)
      : size_bytes_(size_bytes),
        blocks_((chunks() + kChunksPerBlock - 1) / kChunksPerBlock),
        here_(blocks_.size(), 0),
        missing_(chunks()) {}

  std::uint32_t size_bytes() const { return size_bytes_; }
  std::size_t chunks() const { return wire::chunks_of(size_bytes_); }
  std::size_t missing() const { return missing_; }
  // Of memory that is taken so far.
  std::size_t held_bytes() const { return held_bytes_; }
  // Whether put() of that chunk takes more.
  bool needs_block(std::size_t index) const { return !blocks_[index / kChunksPerBlock]; }
  bool is_whole() const { return missing_ == 0; }
  bool has(std::size_t index) const {
    DANCE_ASSERT(index < chunks() && !here_.empty(), index, chunks());
    return (here_[index / kChunksPerBlock] >> (index % kChunksPerBlock) & 1) != 0;
  }
  // The first chunk from `index` on that is not here; chunks() = none.
  std::size_t next_missing(std::size_t index) const {
    while (index < chunks() && has(index))
      index = ~here_[index / kChunksPerBlock] == 0 ? (index / kChunksPerBlock + 1) * kChunksPerBlock
                                                   : index + 1;
    return std::min(index, chunks());
  }

  // `data` has the length of that chunk.
  bool put(std::size_t index, wire::Bytes data) {
    DANCE_ASSERT(index < chunks(), index, chunks());
    DANCE_ASSERT(data.size() == wire::chunk_bytes(size_bytes_, index), data.size());
    if (has(index)) return false;
    auto& block = blocks_[index / kChunksPerBlock];
    if (!block) {
      block = std::make_unique<Block>();
      held_bytes_ += kBlock;
    }
    std::copy(data.begin(), data.end(),
              block->begin() + (index % kChunksPerBlock) * wire::kFileChunk);
    here_[index / kChunksPerBlock] |= std::uint64_t{1} << (index % kChunksPerBlock);
    --missing_;
    return true;
  }
  // Of a chunk that is here.
  wire::Bytes chunk(std::size_t index) const {
    DANCE_ASSERT(has(index), index);
    return {blocks_[index / kChunksPerBlock]->data() + (index % kChunksPerBlock) * wire::kFileChunk,
            wire::chunk_bytes(size_bytes_, index)};
  }

  std::size_t blocks() const { return blocks_.size(); }
  bool has_block(std::size_t block) const {
    const std::size_t end = std::min((block + 1) * kChunksPerBlock, chunks());
    return next_missing(block * kChunksPerBlock) >= end;
  }
  // Of one that is here whole.
  wire::Bytes block(std::size_t block) const {
    return {blocks_[block]->data(), std::min(kBlock, size_bytes_ - block * kBlock)};
  }

 private:
  using Block = std::array<std::uint8_t, kBlock>;

  std::uint32_t size_bytes_ = 0;
  std::vector<std::unique_ptr<Block>> blocks_;
  std::vector<std::uint64_t> here_;  // a bit for each chunk
  std::size_t missing_ = 0;
  std::size_t held_bytes_ = 0;
};

}  // namespace dance
