#include "producers/music/decode/sndfile_decoder.h"

#include <sndfile.h>

#include <algorithm>
#include <array>
#include <cstdio>
#include <cstring>
#include <memory>
#include <vector>

namespace dance {
namespace {

constexpr std::int64_t kDiscardedBlock_frames = 4096;

struct CloseSndfile {
  void operator()(SNDFILE* file) const { sf_close(file); }
};
using SndfilePtr = std::unique_ptr<SNDFILE, CloseSndfile>;

std::uint32_t little_endian(const unsigned char* bytes) {
  return bytes[0] | bytes[1] << 8 | bytes[2] << 16 | static_cast<std::uint32_t>(bytes[3]) << 24;
}

// A WAV file without a length in its header, because its recorder was killed. The header is read
// with the length that the file has.
class UnfinishedWav {
 public:
  static std::unique_ptr<UnfinishedWav> open(const std::string& path) {
    std::unique_ptr<UnfinishedWav> wav(new UnfinishedWav);
    wav->file_.reset(std::fopen(path.c_str(), "rbe"));
    return wav->file_ && wav->find_data() ? std::move(wav) : nullptr;
  }

  SndfilePtr open_decoder(SF_INFO& info) {
    SF_VIRTUAL_IO io{};
    io.get_filelen = [](void* self) { return of(self).size_; };
    io.seek = [](sf_count_t offset, int whence, void* self) -> sf_count_t {
      if (fseeko(of(self).file_.get(), offset, whence) != 0) return -1;
      return ftello(of(self).file_.get());
    };
    io.read = [](void* out, sf_count_t count, void* self) { return of(self).read(out, count); };
    io.write = [](const void*, sf_count_t, void*) -> sf_count_t { return 0; };
    io.tell = [](void* self) -> sf_count_t { return ftello(of(self).file_.get()); };
    std::rewind(file_.get());
    return SndfilePtr(sf_open_virtual(&io, SFM_READ, &info, this));
  }

 private:
  struct CloseFile {
    void operator()(std::FILE* file) const { std::fclose(file); }
  };
  static UnfinishedWav& of(void* self) { return *static_cast<UnfinishedWav*>(self); }

  // The chunk of samples; false in a file that is no WAV, or whose length is told.
  bool find_data() {
    constexpr std::size_t kMostHead_bytes = std::size_t{1} << 20;
    std::vector<unsigned char> head(kMostHead_bytes);
    head.resize(std::fread(head.data(), 1, head.size(), file_.get()));
    if (fseeko(file_.get(), 0, SEEK_END) != 0) return false;
    size_ = ftello(file_.get());
    if (head.size() < 12 || std::memcmp(head.data(), "RIFF", 4) != 0 ||
        std::memcmp(head.data() + 8, "WAVE", 4) != 0)
      return false;
    for (std::size_t at = 12; at + 8 <= head.size();) {
      const std::uint32_t bytes = little_endian(head.data() + at + 4);
      if (std::memcmp(head.data() + at, "data", 4) == 0) {
        length_at_ = static_cast<std::int64_t>(at) + 4;
        const std::int64_t behind = size_ - length_at_ - 4;
        return bytes == 0 && behind > 0 && behind < std::int64_t{1} << 32;
      }
      at += 8 + static_cast<std::size_t>(bytes) + bytes % 2;
    }
    return false;
  }

  sf_count_t read(void* out, sf_count_t count) {
    const std::int64_t at = ftello(file_.get());
    auto* const bytes = static_cast<unsigned char*>(out);
    const auto got = static_cast<std::int64_t>(
        std::fread(bytes, 1, static_cast<std::size_t>(count), file_.get()));
    const auto put = [&](std::int64_t place, std::int64_t value) {
      for (std::int64_t i = 0; i < 4; ++i)
        if (place + i >= at && place + i < at + got)
          bytes[place + i - at] = static_cast<unsigned char>(value >> (8 * i));
    };
    put(4, size_ - 8);
    put(length_at_, size_ - length_at_ - 4);
    return got;
  }

  std::unique_ptr<std::FILE, CloseFile> file_;
  std::int64_t size_ = 0;
  std::int64_t length_at_ = 0;
};

class SndfileDecoder : public AudioDecoder {
 public:
  explicit SndfileDecoder(std::string path) : path_(std::move(path)) {}

  Result<void> open() {
    if (auto opened = reopen(); !opened) return opened;
    // libsndfile says the largest number, or 0, of a file whose length it does not know.
    const bool is_known = format_.length_frames > 0 && format_.length_frames <= kMostAudio_frames;
    if (is_known) return {};
    if (format_.length_frames == 0) {
      wav_ = UnfinishedWav::open(path_);
      if (!wav_) return {};
      if (auto opened = reopen(); !opened) return opened;
      return {};
    }
    if (format_.channels < 1 || format_.channels > kMostAudioChannels) return {};
    has_length_ = false;
    if (auto counted = discard_until(kMostAudio_frames + 1); !counted) return counted;
    const std::int64_t length_frames = at_frame_;
    if (auto opened = reopen(); !opened) return opened;
    format_.length_frames = length_frames;
    return {};
  }

  AudioFormat format() const override { return format_; }
  AudioTags tags() const override { return tags_; }

  Result<std::size_t> read(std::span<float> interleaved) override {
    const auto frames =
        static_cast<sf_count_t>(interleaved.size() / static_cast<std::size_t>(format_.channels));
    const sf_count_t read = sf_readf_float(file_.get(), interleaved.data(), frames);
    if (read < 0 || sf_error(file_.get()) != SF_ERR_NO_ERROR) return fail(sf_strerror(file_.get()));
    at_frame_ += read;
    return static_cast<std::size_t>(read);
  }

  // A file that cannot seek is decoded again up to the frame. In files of unknown length,
  // libsndfile's seek ends at a wrong frame.
  Result<void> seek(std::int64_t frame) override {
    if (is_seekable_ && has_length_ && sf_seek(file_.get(), frame, SEEK_SET) == frame) {
      at_frame_ = frame;
      return {};
    }
    const bool has_failed = is_seekable_ && has_length_;
    is_seekable_ = false;
    if (frame < at_frame_ || has_failed)
      if (auto opened = reopen(); !opened) return opened;
    return discard_until(frame);
  }

 private:
  Result<void> reopen() {
    const std::int64_t length_frames = format_.length_frames;
    SF_INFO info{};
    file_ = wav_ ? wav_->open_decoder(info) : SndfilePtr(sf_open(path_.c_str(), SFM_READ, &info));
    if (!file_) return fail(sf_strerror(nullptr));
    format_ = {info.samplerate, info.channels, info.frames};
    tags_ = {tag(SF_STR_TITLE), tag(SF_STR_ARTIST)};
    if (!has_length_) format_.length_frames = length_frames;
    is_seekable_ = is_seekable_ && info.seekable != 0;
    at_frame_ = 0;
    return {};
  }

  std::string tag(int kind) const {
    const char* text = sf_get_string(file_.get(), kind);
    return text ? std::string(text, strnlen(text, kMostTag_bytes)) : std::string();
  }

  // Reads up to that frame, or to the end of the file if it comes first.
  Result<void> discard_until(std::int64_t frame) {
    std::vector<float> discarded(
        static_cast<std::size_t>(kDiscardedBlock_frames * format_.channels));
    while (at_frame_ < frame) {
      const std::int64_t wanted =
          std::min(frame - at_frame_, kDiscardedBlock_frames) * format_.channels;
      DANCE_TRY(const std::size_t frames,
                read(std::span(discarded).first(static_cast<std::size_t>(wanted))));
      if (frames == 0) break;
    }
    return {};
  }

  std::string path_;
  std::unique_ptr<UnfinishedWav> wav_;  // outlives the decoder that reads it
  SndfilePtr file_;
  AudioFormat format_;
  AudioTags tags_;
  std::int64_t at_frame_ = 0;
  bool has_length_ = true;
  bool is_seekable_ = true;
};

}  // namespace

Result<std::unique_ptr<AudioDecoder>> open_with_sndfile(const std::string& path) {
  auto decoder = std::make_unique<SndfileDecoder>(path);
  if (auto opened = decoder->open(); !opened) return tl::make_unexpected(opened.error());
  return decoder;
}

}  // namespace dance
