// Decodes the pictures of a video file with FFmpeg.
//
// Units/frames: as VideoDecoder; times of the container are in units of its time base.
// Ownership:    owns the open file and one decoded picture.
// Threads:      FFmpeg's own; one owner.
// Failure:      as VideoDecoder. Packets that cannot be decoded are left out, very many in a row
//               are the end.
#pragma once

#include "formats/media/ffmpeg/media_input.h"
#include "formats/media/video_decoder.h"

namespace dance {

class PictureStream : public VideoDecoder {
 public:
  static Result<std::unique_ptr<VideoDecoder>> open(const std::string& path);

  const VideoFacts& facts() const override { return facts_; }
  bool step() override;
  std::optional<double> time_s() const override;
  VideoSize size() const override { return {decoded_->width, decoded_->height}; }
  bool read(std::span<std::uint8_t> bgr) override;

 private:
  PictureStream() = default;
  void find_facts();
  bool make_room();

  std::unique_ptr<FfmpegInput> input_;
  FfmpegPtr<AVCodecContext> decoder_;
  FfmpegPtr<AVPacket> packet_{av_packet_alloc()};
  FfmpegPtr<AVFrame> decoded_{av_frame_alloc()};
  FfmpegPtr<AVFrame> converted_{av_frame_alloc()};  // in blue, green, red; its rows are aligned
  FfmpegPtr<SwsContext> scaler_;
  int scaled_from_ = AV_PIX_FMT_NONE;  // the format that the scaler was made for
  VideoFacts facts_;
};

}  // namespace dance
