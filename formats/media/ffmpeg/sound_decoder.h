// Decodes the sound of a file with FFmpeg. A seek is exact to the container's unit of time: one
// sample in most, a millisecond in WebM.
//
// Units/frames: as AudioDecoder; times of the container are in units of its time base.
// Ownership:    owns the open file and the frames of one packet.
// Threads:      none inside; one owner.
// Failure:      as AudioDecoder. A packet that cannot be decoded is silence of its length, many in
//               a row are an Error.
#pragma once

#include <optional>
#include <vector>

#include "formats/media/audio_decoder.h"
#include "formats/media/ffmpeg/media_input.h"

namespace dance {

class FfmpegDecoder : public AudioDecoder {
 public:
  static Result<std::unique_ptr<AudioDecoder>> open(const std::string& path);

  AudioFormat format() const override { return format_; }
  Result<std::size_t> read(std::span<float> interleaved) override;
  Result<void> seek(std::int64_t frame) override;
  AudioTags tags() const override { return tags_; }

 private:
  // How the decoder gives out its samples.
  struct Sampling {
    int samples = AV_SAMPLE_FMT_NONE;
    int rate_hz = 0;
    int channels = 0;
    bool operator==(const Sampling&) const = default;
  };

  explicit FfmpegDecoder(std::string path) : path_(std::move(path)) {}
  Result<void> rewind();
  Result<void> find_length();
  std::int64_t frame_of(std::int64_t time, AVRational unit) const;
  std::optional<std::int64_t> decoded_frame() const;
  Result<bool> decode();
  Result<bool> next_samples();
  Result<void> convert();
  Result<void> make_converter(const Sampling& from);
  bool enter(std::int64_t frame, std::int64_t preroll_frames);
  Result<void> discard_until(std::int64_t frame);

  std::string path_;
  std::unique_ptr<FfmpegInput> input_;
  FfmpegPtr<AVCodecContext> decoder_;
  FfmpegPtr<AVPacket> packet_{av_packet_alloc()};
  FfmpegPtr<AVFrame> decoded_{av_frame_alloc()};
  FfmpegPtr<SwrContext> converter_;  // from sampling_ to interleaved floats of format_
  Sampling sampling_;
  AudioFormat format_;
  AudioTags tags_;
  std::int64_t first_time_ = AV_NOPTS_VALUE;  // of frame 0, in the container
  std::int64_t at_frame_ = 0;                 // the next one read
  std::size_t silent_ = 0;                    // frames of silence that come first,
  std::vector<float> samples_;                // then these,
  std::size_t used_ = 0;                      // of which so many frames have been read
  int bad_packets_ = 0;                       // in a row
  bool needs_place_ = false;  // packets are missing: the next samples' time says how many
};

}  // namespace dance
