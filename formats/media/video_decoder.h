// Decodes the pictures of one video file, one behind the other: the interface that the media module
// implements.
//
// Units/frames: times in seconds as the file counts them. Pixels are blue, green, red, a byte each,
//               rows from the top, as they are stored: turn_deg says how they stand upright.
// Ownership:    owns the open file.
// Threads:      FFmpeg decodes on threads of its own; one owner.
// Failure:      step() is false at the end, and where the rest is too damaged; read() where
//               this one picture cannot be converted.
#pragma once

#include <cstddef>
#include <cstdint>
#include <optional>
#include <span>
#include <string>

namespace dance {

struct VideoFacts {
  double hz = 0.0;        // 0: unknown
  double pictures = 0.0;  // as many as the file says it has; 0: unknown
  int turn_deg = 0;       // clockwise: 0, 90, 180 or 270
  std::string encoding;   // for people: "MJPG", "avc1", "vp9"
};

struct VideoSize {
  int width_px = 0;
  int height_px = 0;
};

class VideoDecoder {
 public:
  virtual ~VideoDecoder() = default;
  virtual const VideoFacts& facts() const = 0;
  // To the next picture, to the first at the beginning.
  virtual bool step() = 0;
  // Of the picture where it stands: when it is shown, where the file says so,
  virtual std::optional<double> time_s() const = 0;
  // its size,
  virtual VideoSize size() const = 0;
  // and its pixels, into width × height × 3 bytes.
  virtual bool read(std::span<std::uint8_t> bgr) = 0;
};

}  // namespace dance
