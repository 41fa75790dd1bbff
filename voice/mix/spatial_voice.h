// SpatialVoice: puts one mono voice where its dancer stands: the nearer ear hears it louder and
// earlier, and a distant one is quieter. What changes does so smoothly.
//
// Units/frames: azimuth in radians, 0 ahead, positive to the left, as headings are; metres; samples
//               at 48 kHz, stereo interleaved.
// Ownership:    plain value, no heap.
// Threads:      none inside.
// Failure:      none; without a place a voice is ahead, at a metre.
// Source:       delay between the ears: R. Woodworth's formula for a sphere, head radius 87.5 mm.
#pragma once

#include <array>
#include <cstddef>
#include <span>

namespace dance {

class SpatialVoice {
 public:
  void set_place(float azimuth_rad, float distance_m);
  void set_volume(float volume) { volume_ = volume; }
  // Adds the voice to `stereo`, which has two samples for each of `mono`.
  void mix(std::span<const float> mono, std::span<float> stereo);

 private:
  // For each ear, left first.
  struct Ear {
    float gain = 0.7f;
    float delay = 0.0f;  // samples
  };
  static constexpr std::size_t kHistory = 64;  // more than the head delays
  static constexpr float kSmoothing = 1.0f / 960.0f;

  float late(float delay) const;

  std::array<Ear, 2> wanted_{};
  std::array<Ear, 2> ears_{};
  float volume_ = 1.0f;
  float volume_now_ = 1.0f;
  std::array<float, kHistory> history_{};
  std::size_t newest_ = 0;
};

}  // namespace dance
