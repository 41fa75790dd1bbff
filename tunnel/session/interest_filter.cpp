#include "tunnel/session/interest_filter.h"

#include <algorithm>

#include "core/base/sequence.h"
#include "tunnel/session/state_replicator.h"

namespace dance {

void InterestRequest::begin(std::uint8_t default_divider) {
  list_.default_divider = default_divider;
  list_.entries.clear();
  list_.voices = {};
  acked_ = list_.version;
}

bool InterestRequest::change(const wire::InterestList& wanted) {
  if (wanted.default_divider == list_.default_divider && wanted.voices == list_.voices &&
      std::equal(wanted.entries.begin(), wanted.entries.end(), list_.entries.begin(),
                 list_.entries.end()))
    return false;
  const std::uint32_t version = next_version(list_.version);
  list_ = wanted;
  list_.version = version;
  return true;
}

void InterestRequest::take_ack(std::uint32_t version) {
  // The server took something for a later list of ours: ours must be later still.
  if (list_.version == 0 || is_newer_sequence(version, list_.version))
    list_.version = next_version(version);
  if (version == list_.version) acked_ = version;
}

bool InterestFilter::set_divider(std::uint8_t divider, std::uint32_t stream) {
  const Share before = share();
  divider_ = divider;
  const Share after = share();
  if (before == Share::kNone) frames_.clear();  // what it has is old
  if (before == after || after == Share::kNone) return false;
  // Who had everything has what base frames refer to; all others begin with an intra frame.
  if (after == Share::kBase && before == Share::kAll && frames_.is_of(stream)) return false;
  awaits_intra_ = true;
  return after != Share::kIntra || before == Share::kNone;
}

bool InterestFilter::admits(const wire::Record& record, const Counts& counts) const {
  if (divider_ == 0) return false;
  // What a message means is not known: whether the others can do without it neither.
  if (record.kind == wire::RecordKind::kChannel) return true;
  if (record.kind == wire::RecordKind::kHands) return counts.hands % divider_ == 0;
  if (awaits_intra_) return record.is_intra;
  if (share() == Share::kAll) return true;
  if (share() == Share::kIntra) return record.is_intra && record.sequence - last_sent_ >= divider_;
  // The sender's base frames come as often as the most eager wants them: of those each 2^n-th, the
  // same for all who want so many.
  const std::uint8_t wanted = spacing_log2(divider_);
  const std::uint8_t told = counts.base_log2;
  const std::uint32_t each = wanted > told && told != 0 ? 1u << (wanted - told) : 1;
  return record.is_base && counts.base_frames % each == 0;
}

bool InterestFilter::take(const wire::Record& record, const Counts& counts) {
  const bool goes = admits(record, counts);
  if (record.kind != wire::RecordKind::kPose) return goes;
  if (goes) {
    awaits_intra_ = false;
    last_sent_ = record.sequence;
  } else {
    ++left_out_;
    last_left_out_ = static_cast<std::uint16_t>(record.sequence);
    tells_left_out_ = true;
  }
  return goes;
}

void InterestFilter::tell_left_out(wire::Record& record) {
  if (record.kind != wire::RecordKind::kPose || !tells_left_out_) return;
  if (frames_.is_of(record.stream) &&
      static_cast<std::int16_t>(frames_.newest() - last_left_out_) > 0) {
    tells_left_out_ = false;
    return;
  }
  record.counts_left_out = true;
  record.left_out = left_out_;
}

}  // namespace dance
