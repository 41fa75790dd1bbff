// The compressed sound in a local file, packet by packet, through FFmpeg's demuxers.
//
// A crafted file cannot reach beyond itself: FFmpeg is given the bytes of this one file and no
// name, opens nothing by URL, and may use the listed containers and codecs only, none of them for
// pictures.
//
// Units/frames: times are in units of sound().time_base.
// Ownership:    owns the open file.
// Threads:      none inside; one owner. Reads the file on the caller's thread.
// Failure:      an Error says what is wrong; how much is read before the next packet is bounded.
#pragma once

extern "C" {
#include <libavcodec/avcodec.h>
#include <libavformat/avformat.h>
#include <libswresample/swresample.h>
}

#include <memory>
#include <string>

#include "core/base/result.h"

namespace dance {

struct FfmpegFree {
  void operator()(AVFormatContext* context) const { avformat_close_input(&context); }
  void operator()(AVCodecContext* context) const { avcodec_free_context(&context); }
  void operator()(AVFrame* frame) const { av_frame_free(&frame); }
  void operator()(AVPacket* packet) const { av_packet_free(&packet); }
  void operator()(AVIOContext* io) const;
  void operator()(SwrContext* converter) const { swr_free(&converter); }
};

template <class T>
using FfmpegPtr = std::unique_ptr<T, FfmpegFree>;

std::string ffmpeg_error(int code);

class FfmpegInput {
 public:
  static Result<std::unique_ptr<FfmpegInput>> open(const std::string& path);
  FfmpegInput(const FfmpegInput&) = delete;
  FfmpegInput& operator=(const FfmpegInput&) = delete;
  ~FfmpegInput();

  // Ready to decode, from the first packet on.
  Result<FfmpegPtr<AVCodecContext>> open_decoder() const;
  const AVStream& sound() const { return *sound_; }
  const AVFormatContext& format() const { return *format_; }
  // The next packet of sound; false = the end.
  Result<bool> read(AVPacket& packet);
  // To a packet at that time or before it; false where the container has no way there.
  bool seek(std::int64_t time);

 private:
  FfmpegInput() = default;
  static int read_bytes(void* input, std::uint8_t* bytes, int size);
  static std::int64_t seek_bytes(void* input, std::int64_t offset, int whence);

  int file_ = -1;
  std::int64_t may_read_bytes_ = 0;
  FfmpegPtr<AVIOContext> io_;
  FfmpegPtr<AVFormatContext> format_;
  const AVCodec* codec_ = nullptr;
  AVStream* sound_ = nullptr;
};

}  // namespace dance
