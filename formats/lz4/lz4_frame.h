// LZ4 frames, as Rokoko Studio packs its datagrams into, with bounds on what comes out.
//
// Ownership:    a packer or unpacker keeps one buffer, made with it; results are views of that
//               until the next call.
// Threads:      none inside; one owner.
// Failure:      unpack() gives nullopt for what is not one whole frame, and for one that would
//               become longer than the bound: however much it claims, no more than the bound is
//               written. pack() gives nullopt for what becomes longer than the bound.
// Source:       LZ4 frame format 1.6.4, through liblz4.
#pragma once

#include <cstdint>
#include <memory>
#include <optional>
#include <span>
#include <string_view>
#include <vector>

struct LZ4F_dctx_s;

namespace dance {

// Of the first bytes: whether this is an LZ4 frame rather than a text.
bool begins_as_lz4_frame(std::span<const std::uint8_t> bytes);

class Lz4Unpacker {
 public:
  explicit Lz4Unpacker(std::size_t most_bytes);
  ~Lz4Unpacker();
  Lz4Unpacker(const Lz4Unpacker&) = delete;
  Lz4Unpacker& operator=(const Lz4Unpacker&) = delete;

  std::optional<std::string_view> unpack(std::span<const std::uint8_t> frame);

 private:
  LZ4F_dctx_s* context_ = nullptr;
  std::vector<char> text_;
};

class Lz4Packer {
 public:
  explicit Lz4Packer(std::size_t most_text_bytes);

  // The length of the text stands in the frame: Rokoko's plugin for Unity asks for it.
  std::optional<std::span<const std::uint8_t>> pack(std::string_view text, std::size_t most_bytes);

 private:
  std::vector<std::uint8_t> frame_;
};

}  // namespace dance
