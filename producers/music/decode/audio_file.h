// A file of music, read block by block. libsndfile decodes WAV, FLAC, Ogg Vorbis, Opus and MP3;
// the media module (FFmpeg) decodes what libsndfile cannot: M4A, WebM, an Ogg file with a cover
// picture, films. It is loaded when such a file comes.
//
// Units/frames: samples are -1 to 1 at rate_hz(); a frame is one sample of each channel. mono is
//               the mean of all channels.
// Ownership:    owns the open file and one block of it.
// Threads:      none inside; one owner. Reads the file on the caller's thread.
// Failure:      an Error names the file and the cure. A file that turns out damaged half-way ends
//               there with an Error.
#pragma once

#include <memory>
#include <string>
#include <vector>

#include "formats/media/audio_decoder.h"

namespace dance {

class AudioFile {
 public:
  static Result<AudioFile> open(const std::string& path);

  const std::string& path() const { return path_; }
  // "Quimbara - Celia Cruz", from the file's tags; "" where they name no title.
  std::string title() const;
  double rate_hz() const { return format_.rate_hz; }
  int channels() const { return format_.channels; }
  std::int64_t length_frames() const { return format_.length_frames; }
  double length_s() const { return static_cast<double>(length_frames()) / rate_hz(); }
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
  AudioFile(std::string path, std::unique_ptr<AudioDecoder> decoder);
  Result<std::size_t> read_block(std::size_t most_frames);

  std::string path_;
  std::unique_ptr<AudioDecoder> decoder_;
  AudioFormat format_;
  std::int64_t at_frame_ = 0;
  std::vector<float> block_;  // interleaved, as the file has it
};

}  // namespace dance
