// MusicSource: the sound of a piece of music, from any of its frames on.
//
// Units/frames: frames at rate_hz(), from the music's begin; stereo samples are interleaved.
// Failure:      read() fails where the music is damaged.
#pragma once

#include <cstdint>
#include <span>

#include "core/base/result.h"

namespace dance {

class MusicSource {
 public:
  virtual ~MusicSource() = default;
  virtual double rate_hz() const = 0;
  // Fills `interleaved` from this frame on, with silence before the music and after it.
  virtual Result<void> read(std::int64_t frame, std::span<float> interleaved) = 0;
  // This frame is read next: a source that computes its sound does a small part of that now.
  virtual void prepare(std::int64_t /*frame*/) {}
  virtual void set_loops(bool /*loops*/) {}
  // 1 = as it is. A source that cannot change its speed ignores this.
  virtual void set_speed(double /*speed*/) {}
};

}  // namespace dance
