// VideoMode: a mode that a camera offers (encoding, size, rate), and the choice among them.
//
// Units/frames: pixels, hertz; the interval between pictures as the fraction of a second that the
//               driver says, since drivers compare it so.
// Ownership:    plain values.
// Threads:      none inside; pure functions.
// Failure:      choose_mode() says what was asked for, what there is and what to ask for instead.
#pragma once

#include <cstdint>
#include <optional>
#include <span>
#include <string>

#include "core/base/result.h"

namespace dance {

struct VideoMode {
  std::uint32_t fourcc = 0;
  int width_px = 0;
  int height_px = 0;
  std::uint32_t interval_numerator = 0;  // 0: the driver does not say how fast it is
  std::uint32_t interval_denominator = 0;

  double hz() const {
    return interval_numerator == 0 ? 0.0
                                   : static_cast<double>(interval_denominator) / interval_numerator;
  }
  bool operator==(const VideoMode&) const = default;
};

// The requested mode; fields that are not set are chosen: 1280×720, or what is nearest to it, as
// fast as it goes up to 60 Hz.
struct CameraWish {
  std::optional<int> width_px;
  std::optional<int> height_px;
  std::optional<double> hz;
  std::string encoding;  // "YUYV", "NV12", "MJPG", "GREY"; "" for any
  int max_height_px =
      0;  // MJPG above it is decoded at a half, a quarter or an eighth; 0: at full size
};

// "YUYV" of the four bytes that name it, without blanks at the end.
std::string text_of_fourcc(std::uint32_t fourcc);

// Whether pictures of this encoding can be read.
bool is_readable(std::uint32_t fourcc);

// Size first, then rate, then the encoding that is cheapest to decode and loses least. Without a
// requested size, one that comes at less than 24 Hz loses to the next nearest that does not.
Result<VideoMode> choose_mode(std::span<const VideoMode> modes, const CameraWish& wish);

// "1280x720 MJPG at 30 Hz".
std::string text_of(const VideoMode& mode);
// "1280x720 at up to 60 Hz", "height 480 NV12 at 50 Hz".
std::string text_of(const CameraWish& wish);

}  // namespace dance
