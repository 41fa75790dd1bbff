#include "bench/line/line_meter.h"

#include <algorithm>

namespace dance {
namespace {

// Two moments that differ by less are one: what a division rounds.
constexpr Duration kRounding = Duration::us(1);

}  // namespace

LineMeter::LineMeter(MonoTime begin, std::size_t most_poses)
    : begin_(begin), captured_(most_poses + 1), stage_(*Flow::make({"hold"})) {
  figures_.ages.reserve(most_poses);
  figures_.stage_ages.reserve(most_poses);
}

void LineMeter::sent(std::uint32_t sequence, MonoTime captured) {
  if (sequence == 0 || sequence >= captured_.size()) return;
  captured_[sequence] = captured;
  ++figures_.sent;
}

void LineMeter::look(std::optional<Duration> took, MonoTime now) {
  if (took && is_cut_) back_at_ = now + *took;
  if (took) last_took_ = *took;
  is_cut_ = !took;
}

void LineMeter::note_gap(Duration back, MonoTime now) {
  if (last_delivered_.is_set()) {
    const Duration gap = now - last_delivered_;
    const Duration to_pose = back_at_.is_set() ? std::max(now - back_at_, Duration()) : Duration();
    if (gap > figures_.worst_gap) {
      figures_.worst_gap = gap;
      figures_.worst_gap_is_over = true;
      figures_.worst_gap_to_pose = to_pose;
      figures_.worst_gap_round_trip = last_took_ + back;
    }
    if (gap >= kFreeze) figures_.slowest_after_gap = std::max(figures_.slowest_after_gap, to_pose);
  } else {
    figures_.has_first = true;
    figures_.first = now - begin_;
  }
  last_delivered_ = now;
  back_at_ = MonoTime();
}

void LineMeter::delivered(const Pose& pose, Duration back, MonoTime now) {
  if (pose.sequence >= captured_.size() || !captured_[pose.sequence].is_set()) return;
  if (pose.sequence <= newest_) ++figures_.older_delivered;
  newest_ = std::max(newest_, pose.sequence);
  note_gap(back, now);
  const MonoTime captured = captured_[pose.sequence];
  ++figures_.delivered;
  if (figures_.ages.size() < captured_.size()) figures_.ages.push_back(now - captured);

  const Flow::Counters before = stage_.counters();
  stage_.observe(pose, now);
  if (stage_.counters().restarts != before.restarts) known_count_ = 0;
  if (stage_.counters().refused == before.refused)
    known_[known_count_++ % kKnown] = {pose.capture_time, captured};
}

MonoTime LineMeter::captured_at(MonoTime mapped) const {
  const std::size_t held = std::min(known_count_, kKnown);
  const auto known = [&](std::size_t back) { return known_[(known_count_ - 1 - back) % kKnown]; };
  if (mapped >= known(0).mapped) return known(0).captured + (mapped - known(0).mapped);
  for (std::size_t back = 1; back < held; ++back) {
    const Known before = known(back), after = known(back - 1);
    if (mapped < before.mapped) continue;
    const double part =
        (mapped - before.mapped).as_seconds() / (after.mapped - before.mapped).as_seconds();
    return before.captured +
           Duration::seconds((after.captured - before.captured).as_seconds() * part);
  }
  return known(held - 1).captured;
}

// Ends the time for which the stage has shown the same.
void LineMeter::note_stillness(MonoTime now) {
  const Duration still = now - shown_since_;
  if (still < kFreeze) return;
  ++figures_.freezes;
  figures_.frozen += still;
}

void LineMeter::show(MonoTime now) {
  Pose pose;
  if (!stage_.sample(now, pose)) return;
  const MonoTime moment = captured_at(pose.capture_time);
  if (figures_.stage_ages.size() < captured_.size()) figures_.stage_ages.push_back(now - moment);
  if (!shown_.is_set()) {
    shown_since_ = now;
  } else if (moment > shown_) {
    note_stillness(now);
    shown_since_ = now;
  } else if (moment < shown_ - kRounding) {
    ++figures_.older_shown;
  }
  shown_ = moment;
}

void LineMeter::end_dance(MonoTime now) {
  if (shown_.is_set()) note_stillness(now);
  if (!last_delivered_.is_set() || now - last_delivered_ <= figures_.worst_gap) return;
  figures_.worst_gap = now - last_delivered_;
  figures_.worst_gap_is_over = false;
  figures_.worst_gap_to_pose = Duration();
}

LineFigures LineMeter::figures() const {
  LineFigures figures = figures_;
  std::sort(figures.ages.begin(), figures.ages.end());
  std::sort(figures.stage_ages.begin(), figures.stage_ages.end());
  return figures;
}

}  // namespace dance
