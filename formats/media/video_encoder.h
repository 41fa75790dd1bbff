// Encodes pictures, and sound beside them, into one video file: the interface that the media module
// implements.
//
// Units/frames: sRGB, a byte a colour, rows from the top; all pictures of one size. Sound is
//               interleaved stereo at kVideoSoundRate_hz, -1 to 1, and begins with the first
//               picture.
// Ownership:    owns encoder and file; an existing file is written over. The pixels are the
//               caller's.
// Threads:      none inside but the encoder's own; one owner.
// Failure:      an Error names the file and the reason; the file is then incomplete and stays.
#pragma once

#include <cstddef>
#include <cstdint>
#include <span>
#include <string>

#include "core/base/result.h"

namespace dance {

constexpr int kVideoSoundRate_hz = 48000;

enum class VideoUse : std::uint8_t {
  // Small, by the best encoder that there is for the name's ending: .mp4, .webm or .mkv. An odd
  // last row or column is left out.
  kToBeSeen,
  // Each picture for itself, nearly as it was: Motion JPEG in Matroska, which can be read up to
  // where a crash ended it.
  kToBeMeasured,
};

enum class PixelOrder : std::uint8_t { kRgb, kBgr };

struct VideoWish {
  std::string path;  // of the file
  std::string name;  // what people call it, and errors too
  VideoUse use = VideoUse::kToBeSeen;
  PixelOrder order = PixelOrder::kRgb;
  int width_px = 0;
  int height_px = 0;
  double hz = 0.0;
  bool has_sound = false;  // ignored for VideoUse::kToBeMeasured
};

class VideoEncoder {
 public:
  virtual ~VideoEncoder() = default;
  // width × height × 3 bytes of the wish.
  virtual Result<void> add(std::span<const std::uint8_t> pixels) = 0;
  // Call it in turns with add(): the file holds pictures and sound of a moment side by side. Needs
  // a sound_encoder().
  virtual Result<void> add_sound(std::span<const float> stereo) = 0;
  virtual Result<void> finish() = 0;
  // For people: "libx264".
  virtual std::string encoder() const = 0;
  // "aac"; empty if the wish has no sound, or FFmpeg has no sound encoder for such a file.
  virtual std::string sound_encoder() const = 0;
};

}  // namespace dance
