#include "producers/music/decode/sndfile_decoder.h"

#include <sndfile.h>

namespace dance {
namespace {

class SndfileDecoder : public AudioDecoder {
 public:
  SndfileDecoder(SNDFILE* file, const SF_INFO& info)
      : file_(file), format_{info.samplerate, info.channels, info.frames} {}
  SndfileDecoder(const SndfileDecoder&) = delete;
  SndfileDecoder& operator=(const SndfileDecoder&) = delete;
  ~SndfileDecoder() override { sf_close(file_); }

  AudioFormat format() const override { return format_; }

  Result<std::size_t> read(std::span<float> interleaved) override {
    const auto frames =
        static_cast<sf_count_t>(interleaved.size() / static_cast<std::size_t>(format_.channels));
    const sf_count_t read = sf_readf_float(file_, interleaved.data(), frames);
    if (read < 0 || sf_error(file_) != SF_ERR_NO_ERROR) return fail(sf_strerror(file_));
    return static_cast<std::size_t>(read);
  }

  Result<void> seek(std::int64_t frame) override {
    if (sf_seek(file_, frame, SEEK_SET) != frame) return fail(sf_strerror(file_));
    return {};
  }

 private:
  SNDFILE* file_;
  AudioFormat format_;
};

}  // namespace

Result<std::unique_ptr<AudioDecoder>> open_with_sndfile(const std::string& path) {
  SF_INFO info{};
  SNDFILE* file = sf_open(path.c_str(), SFM_READ, &info);
  if (!file) return fail(sf_strerror(nullptr));
  return std::make_unique<SndfileDecoder>(file, info);
}

}  // namespace dance
