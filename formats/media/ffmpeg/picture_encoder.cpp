#include "formats/media/ffmpeg/picture_encoder.h"

extern "C" {
#include <libavutil/opt.h>
}

#include <algorithm>
#include <array>

#include "formats/media/ffmpeg/media_input.h"
#include "formats/media/ffmpeg/sound_encoder.h"

namespace dance {
namespace {

struct VideoFormat {
  const char* ending;
  const char* muxer;
  std::array<const char*, 3> encoders;  // the best first
  std::array<const char*, 2> sound_encoders;
};
constexpr std::array<VideoFormat, 3> kFormats{{
    {".mp4", "mp4", {"libx264", "mpeg4", nullptr}, {"aac", nullptr}},
    {".webm", "webm", {"libvpx-vp9", "libvpx", nullptr}, {"libopus", "libvorbis"}},
    {".mkv", "matroska", {"libx264", "libvpx-vp9", "mpeg4"}, {"libopus", "aac"}},
}};
constexpr VideoFormat kMeasured{
    ".mkv", "matroska", {"mjpeg", nullptr, nullptr}, {nullptr, nullptr}};

const AVCodec* encoder_for(const VideoFormat& format) {
  if (av_guess_format(format.muxer, nullptr, nullptr) == nullptr) return nullptr;
  for (const char* name : format.encoders)
    if (const AVCodec* codec = name != nullptr ? avcodec_find_encoder_by_name(name) : nullptr)
      return codec;
  return nullptr;
}

struct CloseOutput {
  void operator()(AVFormatContext* format) const {
    if (format->pb != nullptr) avio_closep(&format->pb);
    avformat_free_context(format);
  }
};

// Looks as on the screen, at a size that can be sent to a friend; Motion JPEG nearly as it was.
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
    codec.global_quality = (name == "mjpeg" ? 2 : 3) * FF_QP2LAMBDA;
  }
}

class AvVideoEncoder : public VideoEncoder {
 public:
  explicit AvVideoEncoder(const VideoWish& wish) : wish_(wish) {}

  Result<void> open(const VideoFormat& format, const AVCodec& codec) {
    name_ = codec.name;
    AVFormatContext* made = nullptr;
    if (const int error =
            avformat_alloc_output_context2(&made, nullptr, format.muxer, wish_.path.c_str());
        error < 0)
      return wrong(error);
    format_.reset(made);
    codec_.reset(avcodec_alloc_context3(&codec));
    stream_ = avformat_new_stream(format_.get(), nullptr);
    if (codec_ == nullptr || stream_ == nullptr) return wrong(AVERROR(ENOMEM));
    const AVRational rate = av_d2q(wish_.hz, 100'000);
    codec_->time_base = av_inv_q(rate);
    codec_->framerate = rate;
    codec_->gop_size = std::clamp(static_cast<int>(wish_.hz), 1, 300);
    set_pixels();
    if ((format_->oformat->flags & AVFMT_GLOBALHEADER) != 0)
      codec_->flags |= AV_CODEC_FLAG_GLOBAL_HEADER;
    set_quality(*codec_, name_);
    if (const int error = avcodec_open2(codec_.get(), &codec, nullptr); error < 0)
      return wrong(error);
    avcodec_parameters_from_context(stream_->codecpar, codec_.get());
    stream_->time_base = codec_->time_base;
    stream_->avg_frame_rate = rate;
    if (wish_.has_sound)
      if (auto opened = open_sound(format); !opened) return opened;
    if (const int error = avio_open(&format_->pb, wish_.path.c_str(), AVIO_FLAG_WRITE); error < 0)
      return wrong(error);
    if (const int error = avformat_write_header(format_.get(), nullptr); error < 0)
      return wrong(error);
    return make_frame();
  }

  Result<void> add(std::span<const std::uint8_t> pixels) override {
    const int stride_bytes = 3 * wish_.width_px;
    if (pixels.size() !=
        static_cast<std::size_t>(stride_bytes) * static_cast<std::size_t>(wish_.height_px))
      return fail(wish_.name + ": a picture has another size than the first");
    if (const int error = av_frame_make_writable(frame_.get()); error < 0) return wrong(error);
    const std::array<const std::uint8_t*, 1> rows{pixels.data()};
    const std::array<int, 1> stride{stride_bytes};
    sws_scale(scaler_.get(), rows.data(), stride.data(), 0, codec_->height, frame_->data,
              frame_->linesize);
    frame_->pts = next_++;
    if ((codec_->flags & AV_CODEC_FLAG_QSCALE) != 0) frame_->quality = codec_->global_quality;
    return encode(frame_.get());
  }

  Result<void> add_sound(std::span<const float> stereo) override { return sound_->add(stereo); }

  Result<void> finish() override {
    if (auto encoded = encode(nullptr); !encoded) return encoded;
    if (sound_)
      if (auto finished = sound_->finish(); !finished) return finished;
    if (const int error = av_write_trailer(format_.get()); error < 0) return wrong(error);
    if (const int error = avio_closep(&format_->pb); error < 0) return wrong(error);
    return {};
  }

  std::string encoder() const override { return name_; }
  std::string sound_encoder() const override { return sound_ ? sound_->name() : std::string(); }

 private:
  bool is_measured() const { return wish_.use == VideoUse::kToBeMeasured; }

  tl::unexpected<Error> wrong(int error) const {
    const std::string why = wish_.name + ": " + name_ + " cannot write it: " + ffmpeg_error(error);
    return fail(is_measured() ? why : why + "; formats here: " + encodable_formats());
  }

  Result<void> open_sound(const VideoFormat& format) {
    for (const char* name : format.sound_encoders) {
      if (name == nullptr || avcodec_find_encoder_by_name(name) == nullptr) continue;
      DANCE_TRY(sound_, SoundEncoder::create(name, wish_.name, *format_));
      return {};
    }
    return {};
  }

  void set_pixels() {
    codec_->width = wish_.width_px;
    codec_->height = wish_.height_px;
    codec_->color_range = AVCOL_RANGE_JPEG;
    codec_->pix_fmt = AV_PIX_FMT_YUVJ420P;
    if (is_measured()) return;
    codec_->width &= ~1;
    codec_->height &= ~1;
    codec_->color_range = AVCOL_RANGE_MPEG;
    codec_->pix_fmt = AV_PIX_FMT_YUV420P;
    codec_->colorspace = AVCOL_SPC_BT709;
    codec_->color_primaries = AVCOL_PRI_BT709;
    codec_->color_trc = AVCOL_TRC_BT709;
  }

  Result<void> make_frame() {
    const auto from = wish_.order == PixelOrder::kBgr ? AV_PIX_FMT_BGR24 : AV_PIX_FMT_RGB24;
    frame_.reset(av_frame_alloc());
    packet_.reset(av_packet_alloc());
    scaler_.reset(sws_getContext(
        codec_->width, codec_->height, from, codec_->width, codec_->height, codec_->pix_fmt,
        SWS_BICUBIC | SWS_ACCURATE_RND | SWS_FULL_CHR_H_INP, nullptr, nullptr, nullptr));
    if (!frame_ || !packet_ || !scaler_) return wrong(AVERROR(ENOMEM));
    // JPEG has BT.601 in full range, which is what FFmpeg takes its pixels for.
    const int* table = sws_getCoefficients(SWS_CS_ITU709);
    if (!is_measured())
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

  VideoWish wish_;
  std::string name_;  // of the encoder
  std::unique_ptr<AVFormatContext, CloseOutput> format_;
  FfmpegPtr<AVCodecContext> codec_;
  AVStream* stream_ = nullptr;
  FfmpegPtr<AVFrame> frame_;
  FfmpegPtr<AVPacket> packet_;
  FfmpegPtr<SwsContext> scaler_;
  std::unique_ptr<SoundEncoder> sound_;
  std::int64_t next_ = 0;
};

}  // namespace

std::string encodable_formats() {
  std::string all;
  for (const VideoFormat& format : kFormats)
    if (const AVCodec* codec = encoder_for(format))
      all += (all.empty() ? "" : ", ") + std::string(format.ending + 1) + " (" + codec->name + ")";
  return all.empty() ? "none; install an FFmpeg with libx264 or libvpx" : all;
}

Result<std::unique_ptr<VideoEncoder>> create_video_file(const VideoWish& wish) {
  quieten_ffmpeg();
  const VideoFormat* format = wish.use == VideoUse::kToBeMeasured ? &kMeasured : nullptr;
  if (format == nullptr)
    for (const VideoFormat& each : kFormats)
      if (wish.name.ends_with(each.ending)) format = &each;
  const AVCodec* codec = format != nullptr ? encoder_for(*format) : nullptr;
  if (codec == nullptr)
    return fail(wish.name + ": this machine cannot write such a video; it can write " +
                encodable_formats());
  auto made = std::make_unique<AvVideoEncoder>(wish);
  if (auto opened = made->open(*format, *codec); !opened)
    return tl::make_unexpected(opened.error());
  return made;
}

}  // namespace dance
