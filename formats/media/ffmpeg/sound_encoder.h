// Encodes the sound of a video file with FFmpeg: one more stream of the file.
//
// Units/frames: interleaved stereo at kVideoSoundRate_hz, -1 to 1.
// Ownership:    owns the encoder; the file is the caller's and outlives it.
// Threads:      none inside; one owner.
// Failure:      an Error names the file and the reason.
#pragma once

#include <memory>
#include <span>
#include <string>
#include <vector>

#include "core/base/result.h"
#include "formats/media/ffmpeg/media_input.h"

namespace dance {

class SoundEncoder {
 public:
  // `encoder` is FFmpeg's name of an available encoder; `name` names the file in errors. Call it
  // before the header of the file is written.
  static Result<std::unique_ptr<SoundEncoder>> create(const std::string& encoder,
                                                      const std::string& name,
                                                      AVFormatContext& file);

  Result<void> add(std::span<const float> stereo);
  // Call it before the file's trailer is written.
  Result<void> finish();
  // "aac"
  std::string name() const { return encoder_; }

 private:
  SoundEncoder(std::string encoder, std::string name, AVFormatContext& file)
      : encoder_(std::move(encoder)), name_(std::move(name)), file_(file) {}
  tl::unexpected<Error> wrong(int error) const;
  Result<void> open();
  Result<void> encode_samples(std::span<const float> stereo);
  Result<void> encode(const AVFrame* frame);

  std::string encoder_;
  std::string name_;
  AVFormatContext& file_;
  FfmpegPtr<AVCodecContext> codec_;
  FfmpegPtr<AVFrame> frame_;
  FfmpegPtr<AVPacket> packet_;
  AVStream* stream_ = nullptr;
  std::vector<float> pending_;  // less than a frame of the encoder
  std::int64_t next_ = 0;
};

}  // namespace dance
