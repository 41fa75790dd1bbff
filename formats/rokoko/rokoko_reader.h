// Reads a datagram of Rokoko Studio's live stream: JSON v3, plain or in an LZ4 frame.
//
// Units/frames: as formats/rokoko/rokoko_frame.h.
// Ownership:    keeps its buffers and the frame, which is valid until the next read(). The JSON
//               reader allocates for each datagram: its token, keys and numbers as they come.
// Threads:      none inside; one owner.
// Failure:      read() says by a RokokoFault why a datagram is refused; never throws, never
//               recurses, and takes no more than kMostTextBytes of text out of a frame. A joint
//               with a missing, infinite or not unit value is absent; a name or a number of actors
//               beyond the bounds is a fault.
// Source:       see rokoko_frame.h.
#pragma once

#include <cstdint>
#include <memory>
#include <span>

#include "formats/lz4/lz4_frame.h"
#include "formats/rokoko/rokoko_frame.h"
#include "formats/rokoko/rokoko_writer.h"

namespace dance {

enum class RokokoFault : std::uint8_t {
  kNone,
  kNotLz4,         // an LZ4 frame that is damaged or becomes too long
  kNotJson,        // or too deep
  kOtherVersion,   // of the format: 2 and older have other keys
  kNoScene,        // no actors or no timestamp
  kTooManyActors,  // more than RokokoFrame::kMostActors
  kBadName,        // empty or too long
};
constexpr std::size_t kRokokoFaultCount = 7;
const char* text_of(RokokoFault fault);

class RokokoReader {
 public:
  // What as many actors as are read need, both hands of each.
  static constexpr std::size_t kMostTextBytes = RokokoWriter::kMostTextBytes;

  RokokoReader() : unpacker_(kMostTextBytes), frame_(std::make_unique<RokokoFrame>()) {}

  RokokoFault read(std::span<const std::uint8_t> datagram);
  const RokokoFrame& frame() const { return *frame_; }

 private:
  Lz4Unpacker unpacker_;
  std::unique_ptr<RokokoFrame> frame_;
};

}  // namespace dance
