#include "producers/music/audio_file.h"

#include <sndfile.h>
#include <sys/stat.h>

#include <algorithm>
#include <cerrno>
#include <cmath>
#include <cstring>

namespace dance {
namespace {

constexpr std::size_t kAudioBlock_frames = 4096;
constexpr int kMostAudioChannels = 32;
constexpr int kLeastAudioRate_hz = 4000;
constexpr int kMostAudioRate_hz = 768000;
// Twelve hours at 48 kHz: what a header claims beyond is a lie or no song.
constexpr std::int64_t kMostAudio_frames = std::int64_t{12} * 3600 * 48000;

// Damaged floating-point files may hold anything.
float clean(float sample) { return std::isfinite(sample) ? sample : 0.0f; }

}  // namespace

struct AudioFile::Handle {
  ~Handle() {
    if (file) sf_close(file);
  }
  SNDFILE* file = nullptr;
};

AudioFile::AudioFile() = default;
AudioFile::AudioFile(AudioFile&&) noexcept = default;
AudioFile& AudioFile::operator=(AudioFile&&) noexcept = default;
AudioFile::~AudioFile() = default;

Result<AudioFile> AudioFile::open(const std::string& path) {
  struct stat status {};
  if (::stat(path.c_str(), &status) != 0)
    return fail(path + ": " + (errno == ENOENT ? "no such file" : std::strerror(errno)));
  // A pipe would be waited for.
  if (!S_ISREG(status.st_mode)) return fail(path + ": no regular file; name a file of music");
  AudioFile audio;
  audio.path_ = path;
  audio.handle_ = std::make_unique<Handle>();
  SF_INFO info{};
  audio.handle_->file = sf_open(path.c_str(), SFM_READ, &info);
  if (!audio.handle_->file)
    return fail(path + ": no music that can be read here (" + sf_strerror(nullptr) +
                "); convert it to .ogg, .flac or .wav");
  if (info.channels < 1 || info.channels > kMostAudioChannels)
    return fail(path + ": " + std::to_string(info.channels) + " channels; at most " +
                std::to_string(kMostAudioChannels) + ": convert it to stereo");
  if (info.samplerate < kLeastAudioRate_hz || info.samplerate > kMostAudioRate_hz)
    return fail(path + ": " + std::to_string(info.samplerate) +
                " samples a second; convert it to 44100 or 48000");
  if (info.frames < 1) return fail(path + ": empty; copy it again");
  if (info.frames > kMostAudio_frames) return fail(path + ": longer than 12 hours; cut it");
  audio.rate_hz_ = info.samplerate;
  audio.channels_ = info.channels;
  audio.length_frames_ = info.frames;
  audio.block_.resize(kAudioBlock_frames * static_cast<std::size_t>(info.channels));
  return audio;
}

Result<std::size_t> AudioFile::read_block(std::size_t most_frames) {
  const std::size_t frames = std::min(most_frames, kAudioBlock_frames);
  const sf_count_t read =
      sf_readf_float(handle_->file, block_.data(), static_cast<sf_count_t>(frames));
  if (read < 0 || sf_error(handle_->file) != SF_ERR_NO_ERROR)
    return fail(path_ + ": damaged after " +
                std::to_string(static_cast<int>(static_cast<double>(at_frame_) / rate_hz_)) +
                " s (" + sf_strerror(handle_->file) + "); copy it again");
  at_frame_ += read;
  return static_cast<std::size_t>(read);
}

Result<std::size_t> AudioFile::read(std::span<float> mono) {
  std::size_t done = 0;
  const auto channels = static_cast<std::size_t>(channels_);
  while (done < mono.size()) {
    DANCE_TRY(const std::size_t frames, read_block(mono.size() - done));
    if (frames == 0) break;
    for (std::size_t i = 0; i < frames; ++i) {
      float sum = 0.0f;
      for (std::size_t c = 0; c < channels; ++c) sum += clean(block_[i * channels + c]);
      mono[done + i] = sum / static_cast<float>(channels);
    }
    done += frames;
  }
  return done;
}

Result<std::size_t> AudioFile::read_stereo(std::span<float> interleaved) {
  std::size_t done = 0;
  const std::size_t wanted = interleaved.size() / 2;
  const auto channels = static_cast<std::size_t>(channels_);
  while (done < wanted) {
    DANCE_TRY(const std::size_t frames, read_block(wanted - done));
    if (frames == 0) break;
    for (std::size_t i = 0; i < frames; ++i) {
      float left = clean(block_[i * channels]);
      float right = left;
      if (channels == 2) right = clean(block_[i * 2 + 1]);
      if (channels > 2) {
        for (std::size_t c = 1; c < channels; ++c) left += clean(block_[i * channels + c]);
        right = left /= static_cast<float>(channels);
      }
      interleaved[2 * (done + i)] = left;
      interleaved[2 * (done + i) + 1] = right;
    }
    done += frames;
  }
  return done;
}

Result<void> AudioFile::seek(std::int64_t frame) {
  const std::int64_t target = std::clamp<std::int64_t>(frame, 0, length_frames_);
  if (sf_seek(handle_->file, target, SEEK_SET) != target)
    return fail(path_ + ": no way to frame " + std::to_string(target) + " (" +
                sf_strerror(handle_->file) + "); convert it to .ogg or .flac");
  at_frame_ = target;
  return {};
}

}  // namespace dance
