#include "formats/media/ffmpeg/sound_encoder.h"

#include <algorithm>

#include "formats/media/video_encoder.h"

extern "C" {
#include <libavutil/channel_layout.h>
}

namespace dance {
namespace {

constexpr int kChannels = 2;
// At these rates music sounds like the original.
constexpr std::int64_t kAac_bits_per_s = 192'000;
constexpr std::int64_t kOther_bits_per_s = 160'000;

}  // namespace

Result<std::unique_ptr<SoundEncoder>> SoundEncoder::create(const std::string& encoder,
                                                           const std::string& name,
                                                           AVFormatContext& file) {
  std::unique_ptr<SoundEncoder> made(new SoundEncoder(encoder, name, file));
  if (auto opened = made->open(); !opened) return tl::make_unexpected(opened.error());
  return made;
}

tl::unexpected<Error> SoundEncoder::wrong(int error) const {
  return fail(name_ + ": " + encoder_ + " cannot write its sound: " + ffmpeg_error(error));
}

Result<void> SoundEncoder::open() {
  const AVCodec* const codec = avcodec_find_encoder_by_name(encoder_.c_str());
  if (codec == nullptr) return wrong(AVERROR_ENCODER_NOT_FOUND);
  codec_.reset(avcodec_alloc_context3(codec));
  stream_ = avformat_new_stream(&file_, nullptr);
  frame_.reset(av_frame_alloc());
  packet_.reset(av_packet_alloc());
  if (!codec_ || stream_ == nullptr || !frame_ || !packet_) return wrong(AVERROR(ENOMEM));
  const bool is_opus = encoder_ == "libopus";
  codec_->sample_rate = kVideoSoundRate_hz;
  codec_->sample_fmt = is_opus ? AV_SAMPLE_FMT_FLT : AV_SAMPLE_FMT_FLTP;
  codec_->time_base = AVRational{1, kVideoSoundRate_hz};
  codec_->bit_rate = encoder_ == "aac" ? kAac_bits_per_s : kOther_bits_per_s;
  av_channel_layout_default(&codec_->ch_layout, kChannels);
  if ((file_.oformat->flags & AVFMT_GLOBALHEADER) != 0)
    codec_->flags |= AV_CODEC_FLAG_GLOBAL_HEADER;
  if (const int error = avcodec_open2(codec_.get(), codec, nullptr); error < 0) return wrong(error);
  avcodec_parameters_from_context(stream_->codecpar, codec_.get());
  stream_->time_base = codec_->time_base;
  if (codec_->frame_size <= 0) return wrong(AVERROR_PATCHWELCOME);
  frame_->format = codec_->sample_fmt;
  frame_->sample_rate = codec_->sample_rate;
  frame_->nb_samples = codec_->frame_size;
  av_channel_layout_default(&frame_->ch_layout, kChannels);
  if (const int error = av_frame_get_buffer(frame_.get(), 0); error < 0) return wrong(error);
  return {};
}

Result<void> SoundEncoder::add(std::span<const float> stereo) {
  pending_.insert(pending_.end(), stereo.begin(), stereo.end());
  const auto step = static_cast<std::size_t>(kChannels * codec_->frame_size);
  std::size_t used = 0;
  for (; pending_.size() - used >= step; used += step)
    if (auto encoded = encode_samples(std::span(pending_).subspan(used, step)); !encoded)
      return encoded;
  pending_.erase(pending_.begin(), pending_.begin() + static_cast<std::ptrdiff_t>(used));
  return {};
}

Result<void> SoundEncoder::finish() {
  if (!pending_.empty())
    if (auto encoded = encode_samples(pending_); !encoded) return encoded;
  pending_.clear();
  return encode(nullptr);
}

// `stereo` holds one frame of the encoder; only the last may be shorter.
Result<void> SoundEncoder::encode_samples(std::span<const float> stereo) {
  frame_->nb_samples = codec_->frame_size;
  if (const int error = av_frame_make_writable(frame_.get()); error < 0) return wrong(error);
  const std::size_t frames = stereo.size() / kChannels;
  if (codec_->sample_fmt == AV_SAMPLE_FMT_FLT) {
    std::copy(stereo.begin(), stereo.end(), reinterpret_cast<float*>(frame_->data[0]));
  } else {
    for (std::size_t channel = 0; channel < kChannels; ++channel) {
      auto* const to = reinterpret_cast<float*>(frame_->data[channel]);
      for (std::size_t i = 0; i < frames; ++i) to[i] = stereo[kChannels * i + channel];
    }
  }
  frame_->nb_samples = static_cast<int>(frames);
  frame_->pts = next_;
  next_ += frame_->nb_samples;
  return encode(frame_.get());
}

// nullptr flushes the encoder.
Result<void> SoundEncoder::encode(const AVFrame* frame) {
  if (const int error = avcodec_send_frame(codec_.get(), frame); error < 0) return wrong(error);
  for (;;) {
    const int error = avcodec_receive_packet(codec_.get(), packet_.get());
    if (error == AVERROR(EAGAIN) || error == AVERROR_EOF) return {};
    if (error < 0) return wrong(error);
    av_packet_rescale_ts(packet_.get(), codec_->time_base, stream_->time_base);
    packet_->stream_index = stream_->index;
    if (const int written = av_interleaved_write_frame(&file_, packet_.get()); written < 0)
      return wrong(written);
  }
}

}  // namespace dance
