#include "voice/playout/voice_playout.h"

#include <algorithm>

#include "core/base/sequence.h"
#include "voice/codec/voice_packet.h"
#include "voice/playout/time_stretch.h"

namespace dance {
namespace {

constexpr auto kMostFramesSigned = static_cast<std::int64_t>(VoicePlayout::kMostFrames);
// Concealment has faded out after that.
constexpr int kMostConcealed = 12;
// Sound is asked for in bursts of a few milliseconds.
constexpr Duration kPullJitter = Duration::ms(4);
// Stretching begins outside of this.
constexpr double kTooEarly_ms = 3.0;
constexpr double kTooLate_ms = 8.0;
constexpr double kFarOff_ms = 40.0;
// More than that is left out instead of played quicker.
constexpr double kSkip_ms = 250.0;
constexpr double kSmoothing = 1.0 / 8.0;
constexpr double kMostBurst_ms = 200.0;
constexpr int kStrangersRestart = 20;
// On a line that loses packets the next one is waited for, as late as it came the last times, so
// that the copy in it is there; chosen with `dance bench voice` over recorded lines.
constexpr double kCopyWeight = 1.0 / 500.0;
constexpr double kManyCopies = 0.003;
constexpr double kFewCopies = 0.001;
constexpr double kCopyWaitDecay = 0.9985;
constexpr double kMostForCopy_ms = 40.0;
constexpr double kOriginSmoothing = 1.0 / 64.0;
// As long as the packets that are kept, with room for jitter.
constexpr Duration kMostDelay = Duration::s(4);

Duration duration_of_samples(std::size_t samples) {
  return Duration::seconds(static_cast<double>(samples) / kVoiceRate_hz);
}

}  // namespace

std::int64_t VoicePlayout::unwrapped(std::uint32_t sequence) {
  if (!newest_sequence_) {
    newest_sequence_ = sequence;
    newest_ = kMostFramesSigned;
    next_ = newest_;
  }
  return newest_ + sequence_ahead(*newest_sequence_, sequence);
}

// A sender that was started again counts from anywhere.
void VoicePlayout::restart() {
  decoder_->reset();
  for (Slot& slot : slots_) slot.frame = -1;
  newest_sequence_.reset();
  delays_ = ArrivalDelays();
  has_origin_ = false;
  is_speaking_ = false;
  strangers_in_a_row_ = 0;
  concealed_in_a_row_ = 0;
  copies_share_ = 0.0;
  waits_for_copies_ = false;
  copies_wait_ms_ = 0.0;
}

void VoicePlayout::forget() {
  restart();
  counters_ = Counters();
  delay_.reset();
  heard_delay_.reset();
  line_.fill(0.0f);
  ready_ = 0;
}

void VoicePlayout::put(const Voice& voice, MonoTime arrival) {
  ++counters_.received;
  std::int64_t frame = unwrapped(voice.sequence);
  // Left out silence may be long: told from a restart by the capture time.
  const auto since = [&] {
    return has_origin_ ? (voice.capture_time - (capture_origin_ + kVoiceFrame * frame)).as_ms()
                       : 0.0;
  };
  if (frame <= newest_ - kMostFramesSigned || std::abs(since()) > 500.0) {
    ++counters_.late;
    if (++strangers_in_a_row_ < kStrangersRestart) return;
    restart();
    frame = unwrapped(voice.sequence);
  }
  strangers_in_a_row_ = 0;
  Slot& slot = slots_[static_cast<std::size_t>(frame) % kMostFrames];
  if (slot.frame == frame) {
    ++counters_.duplicate;
    return;
  }
  note_gap(frame, arrival);
  if (frame > newest_) {
    newest_ = frame;
    newest_sequence_ = voice.sequence;
  }
  if (!has_origin_) capture_origin_ = voice.capture_time - kVoiceFrame * frame;
  has_origin_ = true;
  capture_origin_ += Duration::seconds(since() * 1e-3 * kOriginSmoothing);
  delays_.add(frame, arrival);
  // Frames that were never played and are overwritten: too much has gathered.
  if (frame - next_ >= kMostFramesSigned) skip_to(frame - kMostFramesSigned + 1);
  if (frame < next_) {
    ++counters_.late;
    return;
  }
  slot.frame = frame;
  slot.size = static_cast<std::uint8_t>(voice.size_bytes);
  slot.data = voice.data;
}

// Silence is left out, and is no gap.
void VoicePlayout::note_gap(std::int64_t frame, MonoTime arrival) {
  const Slot* before = find(newest_);
  const bool is_behind_gap =
      frame > newest_ + 1 && before != nullptr && !is_silence(before->packet());
  copies_share_ += kCopyWeight * ((is_behind_gap ? 1.0 : 0.0) - copies_share_);
  if (copies_share_ > kManyCopies) waits_for_copies_ = true;
  if (copies_share_ < kFewCopies) waits_for_copies_ = false;
  copies_wait_ms_ *= kCopyWaitDecay;
  if (!is_behind_gap || !delays_.is_known()) return;
  // When the frame before it would have come, that is by one frame longer than its own.
  const double late_ms = (arrival - delays_.quickest(frame - 1)).as_ms();
  copies_wait_ms_ = std::max(copies_wait_ms_, late_ms + kTooEarly_ms);
}

const VoicePlayout::Slot* VoicePlayout::find(std::int64_t frame) const {
  const Slot& slot = slots_[static_cast<std::size_t>(frame) % kMostFrames];
  return slot.frame == frame ? &slot : nullptr;
}

std::optional<std::int64_t> VoicePlayout::oldest_from(std::int64_t frame) const {
  if (!newest_sequence_) return std::nullopt;
  for (std::int64_t i = std::max(frame, newest_ - kMostFramesSigned + 1); i <= newest_; ++i)
    if (find(i) != nullptr) return i;
  return std::nullopt;
}

Duration VoicePlayout::wanted_margin(MonoTime now, MonoTime heard) const {
  // The margin is kept on average, of frames that are asked for one behind the other.
  const double burst_ms = std::max(0.0, burst_ms_ - kVoiceFrame.as_ms());
  double wait_ms = delays_.wait().as_ms();
  // A frame is decoded as soon as its first sample is asked for, behind those that are ready.
  if (waits_for_copies_)
    wait_ms = std::clamp(copies_wait_ms_ + duration_of_samples(ready_).as_ms(), wait_ms,
                         wait_ms + kMostForCopy_ms);
  const Duration jitter =
      kPullJitter + Duration::seconds(1e-3 * (wait_ms + 0.5 * std::min(burst_ms, kMostBurst_ms)));
  if (!delay_ || !has_origin_) return jitter;
  // heard − captured = delay, with what is ahead of the frame on its way to the ear.
  const Duration on_line = delays_.quickest(0) - capture_origin_;
  return std::max(jitter, std::min(*delay_, kMostDelay) - on_line - (heard - now));
}

Duration VoicePlayout::margin(MonoTime now) const {
  return now + duration_of_samples(ready_) - delays_.quickest(next_);
}

std::optional<Duration> VoicePlayout::delay() const { return heard_delay_; }

void VoicePlayout::pull(MonoTime now, MonoTime heard, std::span<float> samples) {
  // In parts that the buffer holds.
  while (samples.size() > kVoiceFrameSamples) {
    pull(now, heard, samples.first(kVoiceFrameSamples));
    samples = samples.subspan(kVoiceFrameSamples);
    heard += kVoiceFrame;
  }
  note_burst(now, samples.size());
  while (ready_ < samples.size()) produce(now, heard);
  const auto begin = line_.begin() + kHistory;
  const auto count = static_cast<std::ptrdiff_t>(samples.size());
  std::copy(begin, begin + count, samples.begin());
  std::move(line_.begin() + count, begin + static_cast<std::ptrdiff_t>(ready_), line_.begin());
  ready_ -= samples.size();
}

// What a sound server asks for at once: the last of it has to be there as early as the first.
void VoicePlayout::note_burst(MonoTime now, std::size_t samples) {
  if (now != pulled_) {
    burst_ms_ = std::max(burst_now_ms_, burst_ms_ + kSmoothing * (burst_now_ms_ - burst_ms_));
    burst_now_ms_ = 0.0;
    pulled_ = now;
  }
  burst_now_ms_ += duration_of_samples(samples).as_ms();
}

void VoicePlayout::produce(MonoTime now, MonoTime heard) {
  if (!is_speaking_) return produce_silence(now, heard);
  const std::size_t before = ready_;
  keep_time(now, heard);
  if (!is_speaking_ || ready_ > before) return;
  heard_delay_ = heard + duration_of_samples(ready_) - (capture_origin_ + kVoiceFrame * next_);
  if (find(next_) != nullptr || leave_out_gap(now, heard))
    produce_frame();
  else
    produce_lost();
}

// Until speech has come, and its moment has.
void VoicePlayout::produce_silence(MonoTime now, MonoTime heard) {
  const auto oldest = oldest_from(next_);
  if (oldest) {
    const std::int64_t before = next_;
    next_ = *oldest;
    const Duration early = wanted_margin(now, heard) - margin(now);
    if (early <= Duration()) {
      is_speaking_ = true;
      concealed_in_a_row_ = 0;
      margin_error_ms_ = 0.0;
      return;
    }
    next_ = before;
    // To the sample, where it begins within this frame.
    if (early < kVoiceFrame) {
      const VoiceFrame silence{};
      const auto count = static_cast<std::size_t>(early.as_seconds() * kVoiceRate_hz) + 1;
      return append(std::span(silence).first(std::min(count, silence.size())));
    }
  }
  append(VoiceFrame{});
}

void VoicePlayout::produce_frame() {
  const Slot& slot = *find(next_);
  VoiceFrame frame;
  const bool is_good = decoder_->decode(slot.packet(), frame);
  ++counters_.played;
  if (!is_good) ++counters_.concealed;
  concealed_in_a_row_ = 0;
  const bool ends = is_silence(slot.packet());
  ++next_;
  append(frame);
  if (ends && find(next_) == nullptr) is_speaking_ = false;
}

void VoicePlayout::produce_lost() {
  VoiceFrame frame;
  const Slot* after = find(next_ + 1);
  const bool is_recovered = after != nullptr && decoder_->decode_lost(after->packet(), frame);
  if (after == nullptr) decoder_->conceal(frame);
  ++counters_.played;
  ++(is_recovered ? counters_.recovered : counters_.concealed);
  append(frame);
  // Where nothing at all has come it may yet: the frame is waited for, which makes the delay
  // longer. After a while there is no more to make up.
  const bool is_gap = oldest_from(next_).has_value();
  if (is_gap) ++next_;
  if (++concealed_in_a_row_ >= kMostConcealed && !is_gap) is_speaking_ = false;
}

// What did not come is not made up where more has gathered behind it than is needed. True: there is
// a frame now.
bool VoicePlayout::leave_out_gap(MonoTime now, MonoTime heard) {
  const auto oldest = oldest_from(next_);
  if (!oldest) return false;
  const Duration excess = margin(now) - wanted_margin(now, heard);
  const std::int64_t frames = std::min(excess.count_ns() / kVoiceFrame.count_ns(), *oldest - next_);
  if (frames > 0) skip_to(next_ + frames);
  return next_ == *oldest;
}

void VoicePlayout::append(std::span<const float> samples) {
  const std::size_t count = std::min(samples.size(), kAhead - ready_);
  std::copy_n(samples.begin(), count,
              line_.begin() + static_cast<std::ptrdiff_t>(kHistory + ready_));
  ready_ += count;
}

void VoicePlayout::skip_to(std::int64_t frame) {
  if (frame <= next_) return;
  counters_.skipped += static_cast<std::uint64_t>(frame - next_);
  next_ = frame;
}

// Stretches where the margin is not what is wanted.
void VoicePlayout::keep_time(MonoTime now, MonoTime heard) {
  const Duration wanted = wanted_margin(now, heard);
  const double error_ms = (margin(now) - wanted).as_ms();
  margin_error_ms_ += kSmoothing * (error_ms - margin_error_ms_);
  if (error_ms > kSkip_ms && !delay_) {
    skip_to(next_ + static_cast<std::int64_t>(error_ms / kVoiceFrame.as_ms()));
    margin_error_ms_ = 0.0;
    return;
  }
  const bool is_late = margin_error_ms_ > kTooLate_ms && error_ms > 0.0;
  const bool is_early = margin_error_ms_ < -kTooEarly_ms && error_ms < 0.0;
  if (!is_late && !is_early) return;
  // Two more frames, if they are there: the longest period fits in.
  for (int i = 0; i < 2 && find(next_) != nullptr && is_speaking_; ++i) produce_frame();
  const auto ready = std::span(line_).subspan(kHistory, ready_);
  const bool must = std::abs(margin_error_ms_) > kFarOff_ms;
  if (is_late) {
    const std::size_t gone = shorten(ready, must);
    std::move(ready.begin() + static_cast<std::ptrdiff_t>(gone), ready.end(), ready.begin());
    ready_ -= gone;
    counters_.shortened_samples += gone;
    margin_error_ms_ -= duration_of_samples(gone).as_ms();
    return;
  }
  std::array<float, kLongestPeriod> more;
  const std::size_t count = lengthen(std::span(line_).first(kHistory), ready, more, must);
  if (count == 0 || ready_ + count > kAhead) return;
  std::move_backward(ready.begin(), ready.end(), ready.end() + static_cast<std::ptrdiff_t>(count));
  std::copy_n(more.begin(), count, ready.begin());
  ready_ += count;
  counters_.lengthened_samples += count;
  margin_error_ms_ += duration_of_samples(count).as_ms();
}

}  // namespace dance
