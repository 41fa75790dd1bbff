// Decodes one music file: the interface that libsndfile and FFmpeg implement for AudioFile.
//
// Units/frames: samples are -1 to 1, interleaved; a frame is one sample of each channel. Frame 0 is
//               the first one that is meant to be heard: encoder delay is skipped.
// Ownership:    owns the open file.
// Threads:      none inside; one owner. Reads the file on the caller's thread.
// Failure:      an Error says what is wrong, and leaves it to AudioFile to name file and cure.
#pragma once

#include <cstddef>
#include <cstdint>
#include <span>
#include <string>

#include "core/base/result.h"

namespace dance {

// What any decoder accepts; more is a damaged or hostile header, or no music.
constexpr int kMostAudioChannels = 32;
constexpr int kLeastAudioRate_hz = 4000;
constexpr int kMostAudioRate_hz = 768000;
constexpr std::int64_t kMostAudio_frames = std::int64_t{12} * 3600 * 48000;  // 12 hours at 48 kHz

struct AudioFormat {
  int rate_hz = 0;
  int channels = 0;
  std::int64_t length_frames = 0;
};

// Longer tags are cut.
constexpr std::size_t kMostTag_bytes = 256;

struct AudioTags {
  std::string title;
  std::string artist;
};

class AudioDecoder {
 public:
  virtual ~AudioDecoder() = default;
  virtual AudioFormat format() const = 0;
  // Whole frames, at most as many as fit; 0 = the end.
  virtual Result<std::size_t> read(std::span<float> interleaved) = 0;
  // 0 to length_frames: the next frame that is read.
  virtual Result<void> seek(std::int64_t frame) = 0;
  // The file's tags; empty where it has none. As the file has them: unchecked text.
  virtual AudioTags tags() const { return {}; }
};

// What to convert a file to that cannot be read: not to what its name says it is already.
inline std::string other_audio_format(const std::string& path) {
  return path.ends_with(".flac") ? ".wav" : ".flac";
}

}  // namespace dance
