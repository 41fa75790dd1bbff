// A file of music, read block by block: WAV, FLAC, Ogg Vorbis, Opus, MP3 and what else libsndfile
// knows.
//
// Units/frames: samples are -1 to 1 at rate_hz(); a frame is one sample of each channel. mono is
//               the mean of all channels.
// Ownership:    owns the open file and one block of it.
// Threads:      none inside; one owner. Reads the file on the caller's thread.
// Failure:      an Error names the file and the cure. A file that turns out damaged half-way ends
//               there with an Error.
#pragma once

#include <cstdint>
#include <memory>
#include <span>
#include <string>
#include <vector>

#include "core/base/result.h"

namespace dance {

class AudioFile {
 public:
  static Result<AudioFile> open(const std::string& path);
  AudioFile(AudioFile&&) noexcept;
  AudioFile& operator=(AudioFile&&) noexcept;
  ~AudioFile();

  double rate_hz() const { return rate_hz_; }
  int channels() const { return channels_; }
  std::int64_t length_frames() const { return length_frames_; }
  double length_s() const { return static_cast<double>(length_frames_) / rate_hz_; }
  // The next frame that is read.
  std::int64_t at_frame() const { return at_frame_; }

  // Fill what they are given, but for the last block; 0 = the end.
  Result<std::size_t> read(std::span<float> mono);
  // Left and right in turns; a file of one channel is on both, of more than two as mono is. Returns
  // frames.
  Result<std::size_t> read_stereo(std::span<float> interleaved);
  // To a frame within the file.
  Result<void> seek(std::int64_t frame);

 private:
  struct Handle;
  AudioFile();
  Result<std::size_t> read_block(std::size_t most_frames);

  std::unique_ptr<Handle> handle_;
  std::string path_;
  double rate_hz_ = 0.0;
  int channels_ = 0;
  std::int64_t length_frames_ = 0;
  std::int64_t at_frame_ = 0;
  std::vector<float> block_;  // interleaved, as the file has it
};

}  // namespace dance
