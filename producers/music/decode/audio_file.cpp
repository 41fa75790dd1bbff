#include "producers/music/decode/audio_file.h"

#include <sys/stat.h>

#include <algorithm>
#include <cerrno>
#include <cmath>
#include <cstring>

#include "core/base/text/plain_text.h"
#include "formats/media/confined_decoders.h"
#include "formats/media/media_module.h"
#include "producers/music/decode/sndfile_decoder.h"

namespace dance {
namespace {

constexpr std::size_t kAudioBlock_frames = 4096;

// Damaged floating-point files may hold anything.
float clean(float sample) { return std::isfinite(sample) ? sample : 0.0f; }

std::string trimmed_tag(const std::string& tag) {
  const std::string text = plain_text(tag);
  const std::size_t begin = text.find_first_not_of(' ');
  if (begin == std::string::npos) return "";
  return text.substr(begin, text.find_last_not_of(' ') + 1 - begin);
}

Result<std::unique_ptr<AudioDecoder>> open_with_module(const std::string& path) {
  const auto module = media_module();
  if (!module)
    return fail("libsndfile cannot read it. " + module.error().what + "; or convert it to " +
                other_audio_format(path));
  return open_confined([&] { return (*module)->open_sound(path); });
}

}  // namespace

AudioFile::AudioFile(std::string path, std::unique_ptr<AudioDecoder> decoder)
    : path_(std::move(path)), decoder_(std::move(decoder)), format_(decoder_->format()) {}

Result<AudioFile> AudioFile::open(const std::string& path) {
  struct stat status {};
  if (::stat(path.c_str(), &status) != 0)
    return fail(path + ": " + (errno == ENOENT ? "no such file" : std::strerror(errno)));
  // A pipe would be waited for.
  if (!S_ISREG(status.st_mode)) return fail(path + ": no regular file; name a file of music");
  auto decoder = open_confined([&] { return open_with_sndfile(path); });
  const bool is_empty = decoder && (*decoder)->format().length_frames < 1;
  if (!decoder || is_empty) {
    // An empty one stays so where the module cannot read it either.
    auto other = open_with_module(path);
    if (other || !decoder) decoder = std::move(other);
  }
  if (!decoder) return fail(path + ": " + decoder.error().what);
  AudioFile audio(path, std::move(*decoder));
  const AudioFormat& format = audio.format_;
  if (format.channels < 1 || format.channels > kMostAudioChannels)
    return fail(path + ": " + std::to_string(format.channels) + " channels; at most " +
                std::to_string(kMostAudioChannels) + ": convert it to stereo");
  if (format.rate_hz < kLeastAudioRate_hz || format.rate_hz > kMostAudioRate_hz)
    return fail(path + ": " + std::to_string(format.rate_hz) +
                " samples a second; convert it to 44100 or 48000");
  if (format.length_frames < 1) return fail(path + ": empty; copy it again");
  if (format.length_frames > kMostAudio_frames)
    return fail(path + ": longer than 12 hours; cut it");
  audio.block_.resize(kAudioBlock_frames * static_cast<std::size_t>(format.channels));
  return audio;
}

std::string AudioFile::title() const {
  const AudioTags tags = decoder_->tags();
  const std::string title = trimmed_tag(tags.title), artist = trimmed_tag(tags.artist);
  return title.empty() || artist.empty() ? title : title + " - " + artist;
}

Result<std::size_t> AudioFile::read_block(std::size_t most_frames) {
  const std::size_t frames = std::min(most_frames, kAudioBlock_frames);
  const auto read =
      decoder_->read(std::span(block_).first(frames * static_cast<std::size_t>(format_.channels)));
  if (!read)
    return fail(path_ + ": damaged after " +
                std::to_string(static_cast<int>(static_cast<double>(at_frame_) / rate_hz())) +
                " s (" + read.error().what + "); copy it again");
  at_frame_ += static_cast<std::int64_t>(*read);
  return *read;
}

Result<std::size_t> AudioFile::read(std::span<float> mono) {
  std::size_t done = 0;
  const auto channels = static_cast<std::size_t>(format_.channels);
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
  const auto channels = static_cast<std::size_t>(format_.channels);
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
  const std::int64_t target = std::clamp<std::int64_t>(frame, 0, length_frames());
  if (const auto found = decoder_->seek(target); !found)
    return fail(path_ + ": cannot go to frame " + std::to_string(target) + " (" +
                found.error().what + "); convert it to " + other_audio_format(path_));
  at_frame_ = target;
  return {};
}

}  // namespace dance
