#include "viewer/replay/export/video_file.h"

extern "C" {
#include <libavcodec/avcodec.h>
#include <libavformat/avformat.h>
#include <libavutil/opt.h>
#include <libswscale/swscale.h>
}

#include <algorithm>
#include <array>
#include <filesystem>
#include <vector>

#include "core/program/part_file.h"

namespace dance {
namespace {

struct VideoFormat {
  const char* ending;
  const char* muxer;
  std::array<const char*, 3> encoders;  // the best first
};
constexpr std::array<VideoFormat, 3> kFormats{{
    {"mp4", "mp4", {"libx264", "mpeg4", nullptr}},
    {"webm", "webm", {"libvpx-vp9", "libvpx", nullptr}},
    {"mkv", "matroska", {"libx264", "libvpx-vp9", "mpeg4"}},
}};

const AVCodec* encoder_for(const VideoFormat& format) {
  if (av_guess_format(format.muxer, nullptr, nullptr) == nullptr) return nullptr;
  for (const char* name : format.encoders)
    if (const AVCodec* codec = name != nullptr ? avcodec_find_encoder_by_name(name) : nullptr)
      return codec;
  return nullptr;
}

std::string reason(int error) {
  std::array<char, AV_ERROR_MAX_STRING_SIZE> text{};
  av_strerror(error, text.data(), text.size());
  return text.data();
}

struct FreeFormat {
  void operator()(AVFormatContext* format) const {
    if (format->pb != nullptr) avio_closep(&format->pb);
    avformat_free_context(format);
  }
};
struct FreeCodec {
  void operator()(AVCodecContext* codec) const { avcodec_free_context(&codec); }
};
struct FreeFrame {
  void operator()(AVFrame* frame) const { av_frame_free(&frame); }
};
struct FreePacket {
  void operator()(AVPacket* packet) const { av_packet_free(&packet); }
};
struct FreeScaler {
  void operator()(SwsContext* scaler) const { sws_freeContext(scaler); }
};

// Looks as on the screen, at a size that can be sent to a friend.
void set_quality(AVCodecContext& codec, const std::string& name) {
  const auto set = [&](const char* key, const char* value) {
    av_opt_set(codec.priv_data, key, value, 0);
  };
  if (name == "libx264") {
    set("crf", "18");
    set("preset", "medium");
  } else if (name.starts_with("libvpx")) {
    set("crf", "24");
    set("deadline", "good");
    set("cpu-used", "4");
    codec.bit_rate = 0;
    if (name == "libvpx") codec.bit_rate = 8'000'000;
  } else {
    codec.flags |= AV_CODEC_FLAG_QSCALE;
    codec.global_quality = 3 * FF_QP2LAMBDA;
  }
}

class AvVideoFile : public VideoFile {
 public:
  explicit AvVideoFile(std::string path) : path_(std::move(path)) {}

  Result<void> open(const VideoFormat& format, const AVCodec& codec, int width_px, int height_px,
                    double hz) {
    name_ = codec.name;
    DANCE_TRY(part_, PartFile::create(path_));
    AVFormatContext* made = nullptr;
    if (const int error =
            avformat_alloc_output_context2(&made, nullptr, format.muxer, part_->path().c_str());
        error < 0)
      return wrong(error);
    format_.reset(made);
    codec_.reset(avcodec_alloc_context3(&codec));
    stream_ = avformat_new_stream(format_.get(), nullptr);
    if (codec_ == nullptr || stream_ == nullptr) return wrong(AVERROR(ENOMEM));
    const AVRational rate = av_d2q(hz, 100'000);
    codec_->width = width_px & ~1;
    codec_->height = height_px & ~1;
    codec_->pix_fmt = AV_PIX_FMT_YUV420P;
    codec_->time_base = av_inv_q(rate);
    codec_->framerate = rate;
    codec_->gop_size = std::clamp(static_cast<int>(hz), 1, 300);
    codec_->color_range = AVCOL_RANGE_MPEG;
    codec_->colorspace = AVCOL_SPC_BT709;
    codec_->color_primaries = AVCOL_PRI_BT709;
    codec_->color_trc = AVCOL_TRC_BT709;
    if ((format_->oformat->flags & AVFMT_GLOBALHEADER) != 0)
      codec_->flags |= AV_CODEC_FLAG_GLOBAL_HEADER;
    set_quality(*codec_, name_);
    if (const int error = avcodec_open2(codec_.get(), &codec, nullptr); error < 0)
      return wrong(error);
    avcodec_parameters_from_context(stream_->codecpar, codec_.get());
    stream_->time_base = codec_->time_base;
    stream_->avg_frame_rate = rate;
    if (const int error = avio_open(&format_->pb, part_->path().c_str(), AVIO_FLAG_WRITE);
        error < 0)
      return wrong(error);
    if (const int error = avformat_write_header(format_.get(), nullptr); error < 0)
      return wrong(error);
    return make_frame();
  }

  Result<void> add(const Picture& picture) override {
    if (picture.width_px < codec_->width || picture.height_px < codec_->height)
      return fail(path_ + ": a picture is smaller than the others; keep the size while exporting");
    if (const int error = av_frame_make_writable(frame_.get()); error < 0) return wrong(error);
    const std::array<const std::uint8_t*, 1> rows{picture.rgb.data()};
    const std::array<int, 1> stride{3 * picture.width_px};
    sws_scale(scaler_.get(), rows.data(), stride.data(), 0, codec_->height, frame_->data,
              frame_->linesize);
    frame_->pts = next_++;
    if (name_ == "mpeg4") frame_->quality = codec_->global_quality;
    return encode(frame_.get());
  }

  Result<void> finish() override {
    if (auto encoded = encode(nullptr); !encoded) return encoded;
    if (const int error = av_write_trailer(format_.get()); error < 0) return wrong(error);
    const int error = avio_closep(&format_->pb);
    if (error < 0) return wrong(error);
    return part_->keep();
  }

  std::string encoder() const override { return name_; }

 private:
  tl::unexpected<Error> wrong(int error) const {
    return fail(path_ + ": " + name_ + " cannot write it: " + reason(error) +
                "; formats here: " + video_formats_here());
  }

  Result<void> make_frame() {
    frame_.reset(av_frame_alloc());
    packet_.reset(av_packet_alloc());
    scaler_.reset(sws_getContext(codec_->width, codec_->height, AV_PIX_FMT_RGB24, codec_->width,
                                 codec_->height, codec_->pix_fmt,
                                 SWS_BICUBIC | SWS_ACCURATE_RND | SWS_FULL_CHR_H_INP, nullptr,
                                 nullptr, nullptr));
    if (!frame_ || !packet_ || !scaler_) return wrong(AVERROR(ENOMEM));
    const int* table = sws_getCoefficients(SWS_CS_ITU709);
    sws_setColorspaceDetails(scaler_.get(), table, 1, table, 0, 0, 1 << 16, 1 << 16);
    frame_->format = codec_->pix_fmt;
    frame_->width = codec_->width;
    frame_->height = codec_->height;
    if (const int error = av_frame_get_buffer(frame_.get(), 0); error < 0) return wrong(error);
    return {};
  }

  // nullptr ends it.
  Result<void> encode(const AVFrame* frame) {
    if (const int error = avcodec_send_frame(codec_.get(), frame); error < 0) return wrong(error);
    for (;;) {
      const int error = avcodec_receive_packet(codec_.get(), packet_.get());
      if (error == AVERROR(EAGAIN) || error == AVERROR_EOF) return {};
      if (error < 0) return wrong(error);
      packet_->duration = 1;
      av_packet_rescale_ts(packet_.get(), codec_->time_base, stream_->time_base);
      packet_->stream_index = stream_->index;
      if (const int written = av_interleaved_write_frame(format_.get(), packet_.get()); written < 0)
        return wrong(written);
    }
  }

  std::string path_, name_;
  std::unique_ptr<PartFile> part_;
  std::unique_ptr<AVFormatContext, FreeFormat> format_;
  std::unique_ptr<AVCodecContext, FreeCodec> codec_;
  AVStream* stream_ = nullptr;
  std::unique_ptr<AVFrame, FreeFrame> frame_;
  std::unique_ptr<AVPacket, FreePacket> packet_;
  std::unique_ptr<SwsContext, FreeScaler> scaler_;
  std::int64_t next_ = 0;
};

}  // namespace

std::string video_formats_here() {
  std::string all;
  for (const VideoFormat& format : kFormats)
    if (const AVCodec* codec = encoder_for(format))
      all += (all.empty() ? "" : ", ") + std::string(format.ending) + " (" + codec->name + ")";
  return all.empty() ? "none; install an FFmpeg with libx264 or libvpx" : all;
}

Result<std::unique_ptr<VideoFile>> VideoFile::create(const std::string& path, int width_px,
                                                     int height_px, double hz) {
  av_log_set_level(AV_LOG_ERROR);
  const std::string ending = std::filesystem::path(path).extension().string();
  const auto format = std::find_if(kFormats.begin(), kFormats.end(), [&](const VideoFormat& each) {
    return ending == "." + std::string(each.ending);
  });
  const AVCodec* codec = format != kFormats.end() ? encoder_for(*format) : nullptr;
  if (codec == nullptr)
    return fail(path + ": this machine cannot write such a video; it can write " +
                video_formats_here());
  auto file = std::make_unique<AvVideoFile>(path);
  if (auto opened = file->open(*format, *codec, width_px, height_px, hz); !opened)
    return tl::make_unexpected(opened.error());
  return file;
}

}  // namespace dance
