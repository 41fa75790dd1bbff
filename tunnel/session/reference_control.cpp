#include "tunnel/session/reference_control.h"

#include <algorithm>
#include <utility>

namespace dance {
namespace {

constexpr Duration kAckStands = Duration::s(1);
constexpr Duration kIntraStands = Duration::ms(2500);
// Captures further apart are a gap, and say nothing about how long a frame is.
constexpr Duration kLongestFrame = Duration::ms(200);
// Frames: as far back as a codec may refer.
constexpr std::uint16_t kLongestReach = 63;

}  // namespace

void ReferenceControl::begin(PoseEncoder& encoder) {
  told_ = policy_.current();
  encoder.set_references(told_);
  sent_frames_.clear();
  acked_frames_.clear();
  base_acked_frames_.clear();
  base_log2_ = 0;
  intra_log2_ = kFewestIntra_log2;
  far_since_ = MonoTime();
  requests_seen_ = 0;
  refreshed_at_ = MonoTime();
}

void ReferenceControl::restart(PoseEncoder& encoder, std::uint16_t stream) {
  encoder.restart();
  stream_ = stream;
  sent_frames_.clear();
  acked_frames_.clear();
  base_acked_frames_.clear();
}

void ReferenceControl::note_capture(MonoTime capture) {
  const Duration since = capture - last_capture_;
  if (last_capture_.is_set() && since > Duration() && since < kLongestFrame)
    frame_ += (since - frame_) / 16;
  last_capture_ = capture;
}

// An intra frame now and then, lest a loss that nobody told of be missed for long. Frames that all
// have need none.
void ReferenceControl::refresh(PoseEncoder& encoder, Duration intra_period, MonoTime now) {
  if (intra_period <= Duration()) return;
  const bool is_safe = policy_.current() == References::kAcknowledged && acked_at_.is_set() &&
                       now - acked_at_ < kAckStands;
  if (!refreshed_at_.is_set() || is_safe) {
    refreshed_at_ = now;
  } else if (now - refreshed_at_ >= intra_period) {
    encoder.request_intra();
    refreshed_at_ = now;
  }
}

bool ReferenceControl::prepare(PoseEncoder& encoder, MonoTime capture, Duration intra_period,
                               MonoTime now) {
  note_capture(capture);
  refresh(encoder, intra_period, now);
  const References references =
      acked_at_.is_set() ? policy_.while_silent_for(now - acked_at_, frame_) : policy_.current();
  if (references != told_) {
    told_ = references;
    encoder.set_references(references);
  }
  // For receivers who get only some frames, and for those who come later: the server keeps the
  // newest intra frame. Counted, as sequences may leave some out.
  const bool is_base = base_log2_ != 0 && sent_ % (1u << base_log2_) == 0;
  if (is_base) encoder.request_base();
  const bool is_old = intra_at_.is_set() && now - intra_at_ > kIntraStands;
  if (is_old || since_intra_ + 1 >= 1u << intra_log2_) encoder.request_refresh();
  return is_base;
}

void ReferenceControl::note_sent(std::uint32_t sequence, bool is_intra, MonoTime now) {
  sent_frames_.add(stream_, static_cast<std::uint16_t>(sequence));
  last_sequence_ = sequence;
  ++sent_;
  ++since_intra_;
  if (!is_intra) return;
  since_intra_ = 0;
  intra_at_ = now;
  refreshed_at_ = now;
}

bool ReferenceControl::take(const wire::GuestFeedback& about, const PathStats& path,
                            PoseEncoder& encoder, MonoTime now) {
  const bool is_asked = about.intra_frames != requests_seen_;
  if (is_asked) {
    requests_seen_ = about.intra_frames;
    encoder.request_intra();
    refreshed_at_ = now;
    ++intra_asked_;
  }
  // The encoder is told with the next frame.
  if (path.is_known) policy_.update(path.loss, path.in_a_row, path.round_trip, frame_, now);
  base_log2_ = about.base_log2;
  intra_log2_ = about.intra_log2;
  if (about.restarts == static_cast<std::uint8_t>(stream_)) acknowledge(about, encoder, now);
  note_distance(about, now);
  return is_asked;
}

// Who is sent every pose acknowledges others than base frames too. With nobody like that both
// acknowledgements are the same (ReceiverSummary::fill()).
void ReferenceControl::note_distance(const wire::GuestFeedback& about, MonoTime now) {
  const bool is_far = about.base_log2 != 0 && about.has_acked && about.has_base_acked &&
                      about.newest_acked == about.newest_base_acked &&
                      about.acked_before == about.base_acked_before;
  if (!is_far)
    far_since_ = MonoTime();
  else if (!far_since_.is_set())
    far_since_ = now;
}

// Only what was sent, and each once.
template <class Tell>
void ReferenceControl::each_new(std::uint16_t newest, std::uint16_t before, FrameWindow& told,
                                Tell tell) const {
  for (int back = 16; back >= 0; --back) {
    if (back > 0 && (before >> (back - 1) & 1) == 0) continue;
    const auto sequence = static_cast<std::uint16_t>(newest - back);
    if (!sent_frames_.has(sequence) || told.has(sequence)) continue;
    told.add(stream_, sequence);
    tell(last_sequence_ - static_cast<std::uint16_t>(last_sequence_ - sequence));
  }
}

void ReferenceControl::acknowledge(const wire::GuestFeedback& about, PoseEncoder& encoder,
                                   MonoTime now) {
  if (about.has_acked)
    each_new(about.newest_acked, about.acked_before, acked_frames_, [&](std::uint32_t sequence) {
      ++acked_;
      acked_at_ = now;
      encoder.acknowledged(sequence);
    });
  if (about.has_base_acked)
    each_new(about.newest_base_acked, about.base_acked_before, base_acked_frames_,
             [&](std::uint32_t sequence) { encoder.base_acknowledged(sequence); });
}

void ReceiverSummary::intersect(const FrameWindow& frames, bool& has_some, FrameWindow& common) {
  if (std::exchange(has_some, true))
    common.intersect(frames);
  else
    common = frames;
}

// Who has nothing of late asks for an intra frame; the others need not do without references.
bool ReceiverSummary::is_of_late(const FrameWindow& frames) const {
  return has_any_ && frames.is_of(stream_) &&
         static_cast<std::uint16_t>(newest_ - frames.newest()) <= kLongestReach;
}

void ReceiverSummary::add(std::uint8_t divider, const FrameWindow& frames) {
  const Share share = share_of(divider);
  CommonFrames one;
  if (share == Share::kBase) one.base_log2 = spacing_log2(divider);
  if (share == Share::kIntra) one.intra_log2 = spacing_log2(divider);
  one.has_full = share == Share::kAll && is_of_late(frames);
  one.has_base = one.has_full || (share == Share::kBase && is_of_late(frames));
  one.full = one.base = frames;
  add(one);
}

void ReceiverSummary::add(const CommonFrames& others) {
  if (others.base_log2 != 0)
    common_.base_log2 =
        common_.base_log2 == 0 ? others.base_log2 : std::min(common_.base_log2, others.base_log2);
  common_.intra_log2 = std::min(common_.intra_log2, others.intra_log2);
  // Receivers who all have something may have nothing in common.
  const auto counts = [this](const FrameWindow& frames) {
    return frames.bits() == 0 || is_of_late(frames);
  };
  if (others.has_full && counts(others.full))
    intersect(others.full, common_.has_full, common_.full);
  if (others.has_base && counts(others.base))
    intersect(others.base, common_.has_base, common_.base);
}

void ReceiverSummary::fill(wire::GuestFeedback& about) const {
  about.base_log2 = common_.base_log2;
  about.intra_log2 = common_.intra_log2;
  // With nobody who gets all, there is nothing that only those have.
  const FrameWindow& newest = common_.has_full ? common_.full : common_.base;
  about.has_acked = has_any_ && newest.is_of(stream_);
  if (about.has_acked) {
    about.newest_acked = newest.newest();
    about.acked_before = static_cast<std::uint16_t>(newest.bits() >> 1);
  }
  about.has_base_acked = common_.base_log2 != 0 && has_any_ && common_.base.is_of(stream_);
  if (about.has_base_acked) {
    about.newest_base_acked = common_.base.newest();
    about.base_acked_before = static_cast<std::uint16_t>(common_.base.bits() >> 1);
  }
}

}  // namespace dance
