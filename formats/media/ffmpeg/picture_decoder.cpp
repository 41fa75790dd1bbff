#include "formats/media/ffmpeg/picture_decoder.h"

#include <cmath>
#include <cstring>

extern "C" {
#include <libavutil/display.h>
}

namespace dance {
namespace {

// What cameras, telephones and programs write; none that opens other files by name.
constexpr const char* kVideoContainers =
    "apng,asf,av1,avi,avs2,dirac,dv,flv,gif,h261,h263,h264,hevc,ivf,m4v,matroska,mjpeg,mov,mpeg,"
    "mpegts,mpegvideo,mxf,nut,obu,ogg,rm,smjpeg,vc1,wtv,yuv4mpegpipe";
constexpr StreamWish kVideoWish{AVMEDIA_TYPE_VIDEO, "video", "pictures",
                                kVideoContainers,   nullptr, 0};
constexpr int kMostDamagedPackets = 512;  // in a row
constexpr int kMostSide_px = 16384;

// "MJPG", or the codec's name where the container has no such mark.
std::string encoding_of(const AVCodecParameters& codec) {
  std::string mark;
  for (std::uint32_t rest = codec.codec_tag; rest != 0; rest >>= 8) {
    const char c = static_cast<char>(rest & 0xff);
    mark += c > ' ' && c <= '~' ? c : '?';
  }
  return mark.empty() ? avcodec_get_name(codec.codec_id) : mark;
}

int turn_of(const AVStream& stream) {
#if LIBAVFORMAT_VERSION_INT >= AV_VERSION_INT(60, 15, 100)
  const AVCodecParameters& codec = *stream.codecpar;
  const AVPacketSideData* data = av_packet_side_data_get(
      codec.coded_side_data, codec.nb_coded_side_data, AV_PKT_DATA_DISPLAYMATRIX);
  const std::uint8_t* matrix = data != nullptr ? data->data : nullptr;
#else
  const std::uint8_t* matrix = av_stream_get_side_data(&stream, AV_PKT_DATA_DISPLAYMATRIX, nullptr);
#endif
  if (matrix == nullptr) return 0;
  const double left_deg = av_display_rotation_get(reinterpret_cast<const std::int32_t*>(matrix));
  if (!std::isfinite(left_deg)) return 0;
  const int turn_deg = (static_cast<int>(std::lround(-left_deg)) % 360 + 360) % 360;
  return turn_deg % 90 == 0 ? turn_deg : 0;
}

}  // namespace

Result<std::unique_ptr<VideoDecoder>> PictureStream::open(const std::string& path) {
  std::unique_ptr<PictureStream> self(new PictureStream);
  DANCE_TRY(self->input_, FfmpegInput::open(path, kVideoWish, ".mp4"));
  DANCE_TRY(self->decoder_, self->input_->open_decoder());
  if (!self->packet_ || !self->decoded_ || !self->converted_) return fail("no memory");
  self->find_facts();
  return self;
}

void PictureStream::find_facts() {
  AVStream& stream = input_->stream();
  facts_.hz = av_q2d(av_guess_frame_rate(&input_->format(), &stream, nullptr));
  if (!std::isfinite(facts_.hz) || facts_.hz < 0.0) facts_.hz = 0.0;
  facts_.pictures = static_cast<double>(stream.nb_frames);
  if (stream.nb_frames <= 0) {
    const double whole_s = static_cast<double>(input_->format().duration) / AV_TIME_BASE;
    const double own_s = static_cast<double>(stream.duration) * av_q2d(stream.time_base);
    const double length_s = input_->format().duration > 0 ? whole_s : own_s;
    facts_.pictures = length_s > 0.0 ? std::floor(length_s * facts_.hz + 0.5) : 0.0;
  }
  facts_.turn_deg = turn_of(stream);
  facts_.encoding = encoding_of(*stream.codecpar);
}

bool PictureStream::step() {
  for (int damaged = 0; damaged < kMostDamagedPackets;) {
    int code = avcodec_receive_frame(decoder_.get(), decoded_.get());
    if (code == 0) return true;
    if (code == AVERROR_EOF) return false;
    if (code == AVERROR(EAGAIN)) {
      const auto more = input_->read(*packet_);
      // A file that is cut off ends as one that is whole: with what the decoder still holds.
      code = avcodec_send_packet(decoder_.get(), more.value_or(false) ? packet_.get() : nullptr);
      av_packet_unref(packet_.get());
      if (code >= 0 || code == AVERROR_EOF) continue;
    }
    ++damaged;
  }
  return false;
}

std::optional<double> PictureStream::time_s() const {
  const std::int64_t time = decoded_->best_effort_timestamp;
  if (time == AV_NOPTS_VALUE) return std::nullopt;
  return static_cast<double>(time) * av_q2d(input_->stream().time_base);
}

// For a picture of the decoded one's size. The scaler is made anew only when that changes:
// sws_getCachedContext() does it for each picture of full range, as JPEGs are, whose format it
// has rewritten in its own record.
bool PictureStream::make_room() {
  const AVFrame& from = *decoded_;
  AVFrame& to = *converted_;
  if (from.width < 1 || from.height < 1 || from.width > kMostSide_px || from.height > kMostSide_px)
    return false;
  if (to.width == from.width && to.height == from.height && scaled_from_ == from.format)
    return true;
  scaler_.reset(sws_getContext(from.width, from.height, static_cast<AVPixelFormat>(from.format),
                               from.width, from.height, AV_PIX_FMT_BGR24, SWS_BICUBIC, nullptr,
                               nullptr, nullptr));
  scaled_from_ = scaler_ ? from.format : AV_PIX_FMT_NONE;
  av_frame_unref(&to);
  to.format = AV_PIX_FMT_BGR24;
  to.width = from.width;
  to.height = from.height;
  if (av_frame_get_buffer(&to, 0) < 0) scaled_from_ = AV_PIX_FMT_NONE;
  return scaled_from_ != AV_PIX_FMT_NONE;
}

bool PictureStream::read(std::span<std::uint8_t> bgr) {
  const AVFrame& from = *decoded_;
  AVFrame& to = *converted_;
  if (!make_room()) return false;
  const auto row_bytes = std::size_t{3} * static_cast<std::size_t>(from.width);
  if (bgr.size() != row_bytes * static_cast<std::size_t>(from.height)) return false;
  if (sws_scale(scaler_.get(), from.data, from.linesize, 0, from.height, to.data, to.linesize) !=
      from.height)
    return false;
  for (int y = 0; y < from.height; ++y)
    std::memcpy(bgr.data() + static_cast<std::size_t>(y) * row_bytes,
                to.data[0] + static_cast<std::ptrdiff_t>(y) * to.linesize[0], row_bytes);
  return true;
}

}  // namespace dance
