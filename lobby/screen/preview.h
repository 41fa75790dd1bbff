// What the You screen asks of a camera and of a sound check, and shows: pictures as they come, and
// advice in words. Who looks and listens is another's (lobby/checks/).
//
// Units/frames: rows from the top, RGB, 8 bit; levels from 0 to 1.
// Ownership:    a Preview refers to memory of its source, valid until the next picture().
// Threads:      called by the drawing thread alone; none of it waits.
// Failure:      start() says what is wrong, and the cure; later troubles are advice.
#pragma once

#include <cstdint>
#include <span>
#include <string>

#include "core/base/result.h"
#include "viewer/words/texts.h"

namespace dance {

struct Preview {
  int width_px = 0;
  int height_px = 0;
  std::span<const std::uint8_t> rgb;
};

class CameraPreview {
 public:
  virtual ~CameraPreview() = default;
  virtual Result<void> start(const std::string& device) = 0;
  virtual void stop() = 0;
  // True where another one came since it was asked last.
  virtual bool picture(Preview& picture) = 0;
  virtual std::span<const Text> advice() const = 0;
};

}  // namespace dance
