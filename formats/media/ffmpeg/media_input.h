// One compressed stream in a local file, sound or pictures, packet by packet, through FFmpeg's
// demuxers.
//
// A crafted file cannot reach beyond itself: FFmpeg is given the bytes of this one file and no
// name, opens nothing by URL, and may use the containers and codecs of the wish only.
//
// Units/frames: times are in units of stream().time_base.
// Ownership:    owns the open file.
// Threads:      none inside; one owner. Reads the file on the caller's thread.
// Failure:      an Error says what is wrong; how much is read before the next packet is bounded.
#pragma once

extern "C" {
#include <libavcodec/avcodec.h>
#include <libavformat/avformat.h>
#include <libswresample/swresample.h>
#include <libswscale/swscale.h>
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
  void operator()(SwsContext* scaler) const { sws_freeContext(scaler); }
};

template <class T>
using FfmpegPtr = std::unique_ptr<T, FfmpegFree>;

std::string ffmpeg_error(int code);

// For the process: what goes wrong is told by Errors, not by lines on the terminal; and no block of
// memory is larger than a header may ask for.
void quieten_ffmpeg();

struct StreamWish {
  AVMediaType type;
  const char* kind;        // for people: "music"
  const char* stream;      // "sound"
  const char* containers;  // names of FFmpeg's demuxers, with commas between
  const char* codecs;      // of its decoders; nullptr: any
  int threads;             // 0: as many as processors
};

class FfmpegInput {
 public:
  // `cure`: what to make of a file that cannot be read, ".flac".
  static Result<std::unique_ptr<FfmpegInput>> open(const std::string& path, const StreamWish& wish,
                                                   const std::string& cure);
  FfmpegInput(const FfmpegInput&) = delete;
  FfmpegInput& operator=(const FfmpegInput&) = delete;
  ~FfmpegInput();

  // Ready to decode, from the first packet on.
  Result<FfmpegPtr<AVCodecContext>> open_decoder() const;
  AVStream& stream() const { return *stream_; }
  AVFormatContext& format() const { return *format_; }
  // The next packet of the stream; false = the end.
  Result<bool> read(AVPacket& packet);
  // To a packet at that time or before it; false where the container has no way there.
  bool seek(std::int64_t time);

 private:
  FfmpegInput(const StreamWish& wish, std::string cure) : wish_(wish), cure_(std::move(cure)) {}
  static int read_bytes(void* input, std::uint8_t* bytes, int size);
  static std::int64_t seek_bytes(void* input, std::int64_t offset, int whence);

  StreamWish wish_;
  std::string cure_;
  int file_ = -1;
  std::int64_t may_read_bytes_ = 0;
  FfmpegPtr<AVIOContext> io_;
  FfmpegPtr<AVFormatContext> format_;
  const AVCodec* codec_ = nullptr;
  AVStream* stream_ = nullptr;
};

}  // namespace dance
