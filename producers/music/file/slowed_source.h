// SlowedSource: plays another source slower or faster at its own pitch: overlapping windows of the
// music, each moved by up to 8 ms to where it continues the window before (WSOLA).
//
// Units/frames: frames as they are heard: music frame n is heard at n / speed, within 8 ms.
// Ownership:    owns the source.
// Failure:      as the source's.
#pragma once

#include <memory>
#include <vector>

#include "producers/music/music_source.h"

namespace dance {

class SlowedSource : public MusicSource {
 public:
  static constexpr double kWindow_s = 0.040;
  static constexpr double kSearch_s = 0.008;

  explicit SlowedSource(std::unique_ptr<MusicSource> source);

  double rate_hz() const override { return source_->rate_hz(); }
  Result<void> read(std::int64_t frame, std::span<float> interleaved) override;
  void set_loops(bool loops) override;
  // Within the bounds of music_speed.h; at 1 the samples are the source's own.
  void set_speed(double speed) override;

 private:
  Result<void> make_piece(std::int64_t piece);
  Result<void> add_window(std::int64_t piece, std::int64_t begin);
  Result<void> buffer(std::int64_t begin, std::int64_t end);
  std::int64_t begin_of_window(std::int64_t piece) const;
  float likeness(const std::vector<float>& wanted, std::int64_t frame) const;
  std::int64_t best_begin(std::int64_t nominal) const;
  float mono(std::int64_t frame) const;

  std::unique_ptr<MusicSource> source_;
  double speed_ = 1.0;
  std::int64_t half_;    // frames of half a window, and of one piece
  std::int64_t search_;  // frames
  std::int64_t stride_;  // of what is compared: some 11 kHz are enough
  std::vector<float> fade_;
  std::int64_t piece_ = 0;  // number of the piece that made_ holds
  bool is_made_ = false;
  std::int64_t last_begin_ = 0;  // of the last window, in the music
  std::vector<float> made_;      // stereo: the last window's first half over the tail before it
  std::vector<float> tail_;      // stereo: the second half of the last window
  std::int64_t buffer_begin_ = 0;
  std::vector<float> buffer_;  // stereo: the music around the last window
};

}  // namespace dance
