#include "formats/media/ffmpeg/sound_decoder.h"

#include <algorithm>
#include <array>

extern "C" {
#include <libavutil/channel_layout.h>
}

namespace dance {
namespace {

// Without ASF: it does not say where its WMA sound begins.
constexpr const char* kSoundContainers =
    "aac,ac3,aiff,amr,ape,au,caf,eac3,flac,matroska,mov,mp3,mpeg,mpegts,ogg,tta,w64,wav,wv";
constexpr const char* kSoundCodecs =
    "aac,aac_latm,ac3,adpcm_ima_wav,adpcm_ms,alac,amrnb,amrwb,ape,eac3,flac,gsm_ms,mp1,mp1float,"
    "mp2,mp2float,mp3,mp3float,opus,"
    "pcm_alaw,pcm_f32be,pcm_f32le,pcm_f64be,pcm_f64le,pcm_mulaw,pcm_s16be,pcm_s16le,pcm_s24be,"
    "pcm_s24le,pcm_s32be,pcm_s32le,pcm_s8,pcm_u8,tta,vorbis,wavpack";
constexpr StreamWish kSoundWish{AVMEDIA_TYPE_AUDIO, "music",      "sound",
                                kSoundContainers,   kSoundCodecs, 1};

constexpr AVRational kMicroseconds = {1, AV_TIME_BASE};
constexpr int kMostBadPackets = 64;
constexpr int kMostDecoded_frames = 1 << 20;
// Decoders that begin in the middle need some packets before what they give is right; the second
// is for containers that find their way roughly.
constexpr std::array<std::int64_t, 2> kPreroll_s = {1, 10};
// So far it is quicker to read on than to seek.
constexpr int kReadOn_s = 2;
// Of the preroll at least this part has to be there in truth.
constexpr int kSettledPart = 5;
constexpr int kLastPart_s = 10;
// What the container left out is silence where it is longer than a fiftieth of a second: shorter is
// how coarsely it counts.
constexpr int kGapsPerSecond = 50;
constexpr int kLongestGap_s = 60;  // longer is a damaged time

// A time that can be reckoned with; not each packet has one.
bool is_time(std::int64_t time) {
  constexpr std::int64_t kMostTime = std::int64_t{1} << 60;
  return time > -kMostTime && time < kMostTime;  // AV_NOPTS_VALUE is below
}
constexpr std::int64_t kDiscarded_frames = 4096;

// Reads a tag of the file, else of its audio stream: Ogg keeps its tags there.
std::string tag_of(const FfmpegInput& input, const char* name) {
  for (const AVDictionary* tags : {input.format().metadata, input.stream().metadata})
    if (const AVDictionaryEntry* tag = av_dict_get(tags, name, nullptr, 0))
      return std::string(tag->value).substr(0, kMostTag_bytes);
  return "";
}

}  // namespace

Result<std::unique_ptr<AudioDecoder>> FfmpegDecoder::open(const std::string& path) {
  std::unique_ptr<FfmpegDecoder> self(new FfmpegDecoder(path));
  if (auto opened = self->rewind(); !opened) return tl::make_unexpected(opened.error());
  DANCE_TRY(const bool has_sound, self->decode());
  if (!has_sound) return fail("there is no sound in it; copy it again");
  self->format_.rate_hz = self->decoded_->sample_rate;
  self->format_.channels = self->decoded_->ch_layout.nb_channels;
  self->first_time_ = self->decoded_->pts;
  self->tags_ = {tag_of(*self->input_, "title"), tag_of(*self->input_, "artist")};
  if (auto found = self->find_length(); !found) return tl::make_unexpected(found.error());
  return self;
}

Result<void> FfmpegDecoder::rewind() {
  decoder_.reset();
  DANCE_TRY(input_, FfmpegInput::open(path_, kSoundWish, other_audio_format(path_)));
  DANCE_TRY(decoder_, input_->open_decoder());
  converter_.reset();
  samples_.clear();
  used_ = silent_ = 0;
  at_frame_ = 0;
  bad_packets_ = 0;
  needs_place_ = false;
  return {};
}

// The last part is decoded: what containers say of their length is estimated from the bit rate in
// some, and has the encoder's delay or padding in it in others.
Result<void> FfmpegDecoder::find_length() {
  const std::int64_t said_us = input_->format().duration;
  format_.length_frames = kMostAudio_frames + 1;
  bool is_there = false;
  if (said_us > 0) {
    const std::int64_t said_frames = frame_of(said_us, kMicroseconds);
    if (said_frames > kMostAudio_frames) return fail("longer than 12 hours; cut it");
    const std::int64_t last_part_frames = std::int64_t{kLastPart_s} * format_.rate_hz;
    is_there = enter(said_frames, last_part_frames);
  }
  // Or the whole, where there is no way to the last part.
  if (!is_there)
    if (auto begun = rewind(); !begun) return begun;
  auto reached = discard_until(format_.length_frames);
  if (!reached) return fail("damaged at its end (" + reached.error().what + "); copy it again");
  format_.length_frames = at_frame_;
  // An M4A cuts off the padding of its last packet so.
  const AVStream& sound = input_->stream();
  if (sound.duration > 0 &&
      input_->format().duration_estimation_method != AVFMT_DURATION_FROM_BITRATE)
    format_.length_frames =
        std::min(format_.length_frames, frame_of(sound.duration, sound.time_base));
  return rewind();
}

std::int64_t FfmpegDecoder::frame_of(std::int64_t time, AVRational unit) const {
  return av_rescale_q(time, unit, AVRational{1, format_.rate_hz});
}

Result<std::size_t> FfmpegDecoder::read(std::span<float> interleaved) {
  const auto channels = static_cast<std::size_t>(format_.channels);
  if (at_frame_ >= format_.length_frames) return 0;
  while (silent_ + samples_.size() / channels - used_ == 0) {
    DANCE_TRY(const bool more, next_samples());
    if (!more) return 0;
  }
  std::size_t frames = std::min(interleaved.size() / channels,
                                static_cast<std::size_t>(format_.length_frames - at_frame_));
  if (silent_ > 0) {
    frames = std::min(frames, silent_);
    std::fill_n(interleaved.begin(), frames * channels, 0.0f);
    silent_ -= frames;
  } else {
    frames = std::min(frames, samples_.size() / channels - used_);
    std::copy_n(samples_.begin() + static_cast<std::ptrdiff_t>(used_ * channels), frames * channels,
                interleaved.begin());
    used_ += frames;
  }
  at_frame_ += static_cast<std::int64_t>(frames);
  return frames;
}

// One more decoded_; false = the end.
Result<bool> FfmpegDecoder::decode() {
  for (;;) {
    int code = avcodec_receive_frame(decoder_.get(), decoded_.get());
    if (code == 0) {
      bad_packets_ = 0;
      return true;
    }
    if (code == AVERROR_EOF) return false;
    if (code == AVERROR(EAGAIN)) {
      DANCE_TRY(const bool more, input_->read(*packet_));
      code = avcodec_send_packet(decoder_.get(), more ? packet_.get() : nullptr);
      av_packet_unref(packet_.get());
      if (code >= 0 || code == AVERROR_EOF) continue;
    }
    if (++bad_packets_ > kMostBadPackets) return fail(ffmpeg_error(code));
    needs_place_ = true;
  }
}

// More samples_, at their place in the song; false = the end.
Result<bool> FfmpegDecoder::next_samples() {
  DANCE_TRY(const bool more, decode());
  if (!more) return false;
  if (auto converted = convert(); !converted) return tl::make_unexpected(converted.error());
  const auto frame = decoded_frame();
  if (!frame) return true;
  const std::int64_t missing = std::min(*frame, format_.length_frames) - at_frame_;
  if (missing > std::int64_t{kLongestGap_s} * format_.rate_hz) return true;
  if (missing > format_.rate_hz / kGapsPerSecond || (needs_place_ && missing > 0))
    silent_ = static_cast<std::size_t>(missing);
  else if (needs_place_)
    used_ = static_cast<std::size_t>(std::min<std::int64_t>(
        -missing, static_cast<std::int64_t>(samples_.size()) / format_.channels));
  needs_place_ = false;
  return true;
}

// decoded_ to samples_, whatever it is sampled as: a file may change half-way.
Result<void> FfmpegDecoder::convert() {
  const AVFrame& from = *decoded_;
  const int channels = from.ch_layout.nb_channels;
  if (channels < 1 || channels > kMostAudioChannels || from.sample_rate < kLeastAudioRate_hz ||
      from.sample_rate > kMostAudioRate_hz || from.nb_samples > kMostDecoded_frames)
    return fail(std::to_string(channels) + " channels at " + std::to_string(from.sample_rate) +
                " samples a second cannot be played");
  const Sampling sampling{from.format, from.sample_rate, channels};
  if (!converter_ || sampling != sampling_)
    if (auto made = make_converter(sampling); !made) return made;
  const int room = swr_get_out_samples(converter_.get(), from.nb_samples);
  samples_.resize(static_cast<std::size_t>(std::max(room, 0)) *
                  static_cast<std::size_t>(format_.channels));
  auto* out = reinterpret_cast<std::uint8_t*>(samples_.data());
  const int frames =
      swr_convert(converter_.get(), &out, room,
                  const_cast<const std::uint8_t**>(from.extended_data), from.nb_samples);
  if (frames < 0) return fail(ffmpeg_error(frames));
  samples_.resize(static_cast<std::size_t>(frames) * static_cast<std::size_t>(format_.channels));
  used_ = 0;
  return {};
}

Result<void> FfmpegDecoder::make_converter(const Sampling& from) {
  // Channels by their number: where a loudspeaker stands is not asked here.
  AVChannelLayout in{};
  AVChannelLayout out{};
  av_channel_layout_default(&in, from.channels);
  av_channel_layout_default(&out, format_.channels);
  SwrContext* made = nullptr;
  int code =
      swr_alloc_set_opts2(&made, &out, AV_SAMPLE_FMT_FLT, format_.rate_hz, &in,
                          static_cast<AVSampleFormat>(from.samples), from.rate_hz, 0, nullptr);
  converter_.reset(made);
  if (code >= 0) code = swr_init(made);
  if (code < 0) return fail(ffmpeg_error(code));
  sampling_ = from;
  return {};
}

Result<void> FfmpegDecoder::seek(std::int64_t frame) {
  if (frame < at_frame_ || frame - at_frame_ > std::int64_t{kReadOn_s} * format_.rate_hz) {
    const bool is_there = std::any_of(
        kPreroll_s.begin(), kPreroll_s.end(),
        [&](std::int64_t preroll_s) { return enter(frame, preroll_s * format_.rate_hz); });
    if (!is_there)
      if (auto begun = rewind(); !begun) return begun;
  }
  return discard_until(frame);
}

// Whether the container has a way to somewhere before that frame, and says where that is.
bool FfmpegDecoder::enter(std::int64_t frame, std::int64_t preroll_frames) {
  if (!is_time(first_time_) || frame <= preroll_frames) return false;
  const std::int64_t from_first = av_rescale_q(
      frame - preroll_frames, AVRational{1, format_.rate_hz}, input_->stream().time_base);
  if (!input_->seek(first_time_ + from_first)) return false;
  avcodec_flush_buffers(decoder_.get());
  converter_.reset();
  silent_ = 0;
  // The first packet may need one before it, and not each has a time.
  for (int packets = 0; packets < kMostBadPackets; ++packets) {
    if (!decode().value_or(false)) return false;
    const auto at = decoded_frame();
    if (!at) continue;
    at_frame_ = *at;
    needs_place_ = false;
    return at_frame_ >= 0 && at_frame_ <= frame - preroll_frames / kSettledPart &&
           convert().has_value();
  }
  return false;
}

// Where in the song decoded_ is, by its container.
std::optional<std::int64_t> FfmpegDecoder::decoded_frame() const {
  if (!is_time(decoded_->pts) || !is_time(first_time_)) return std::nullopt;
  return frame_of(decoded_->pts - first_time_, input_->stream().time_base);
}

// To that frame, or to the end where it comes first.
Result<void> FfmpegDecoder::discard_until(std::int64_t frame) {
  std::vector<float> discarded(static_cast<std::size_t>(kDiscarded_frames * format_.channels));
  while (at_frame_ < frame) {
    const auto wanted = std::min(frame - at_frame_, kDiscarded_frames) * format_.channels;
    DANCE_TRY(const std::size_t frames,
              read(std::span(discarded).first(static_cast<std::size_t>(wanted))));
    if (frames == 0) break;
  }
  return {};
}

}  // namespace dance
