#include "viewer/replay/replay_player.h"

#include <algorithm>
#include <array>
#include <cmath>
#include <vector>

namespace dance {
namespace {

constexpr std::array kSpeeds{0.1, 0.25, 0.5, 0.75, 1.0, 1.5, 2.0, 3.0, 4.0};
constexpr double kSlowestFrames_hz = 5.0;
constexpr double kFastestFrames_hz = 480.0;
// Where a repetition begins: everybody has come by then.
constexpr Duration kFirstFrames = Duration::ms(20);
constexpr Duration kShortestLoop = Duration::ms(100);
// "Back one beat", pressed soon after a beat, is the one before.
constexpr Duration kOnTheMark = Duration::ms(120);

// As most guests have them, while they dance.
double frame_hz_of(const ReplayIndex& index) {
  std::vector<double> rates;
  for (std::size_t i = 0; i < index.guests.size(); ++i) {
    const ReplayIndex::Guest& guest = index.guests[i];
    Duration danced = guest.last - guest.first;
    for (const ReplayIndex::Gap& gap : index.gaps)
      if (gap.guest == i) danced = danced - (gap.end - gap.begin);
    if (guest.poses > 1 && danced > Duration())
      rates.push_back(static_cast<double>(guest.poses - 1) / danced.as_seconds());
  }
  if (rates.empty()) return 60.0;
  std::nth_element(rates.begin(), rates.begin() + static_cast<std::ptrdiff_t>(rates.size() / 2),
                   rates.end());
  return std::clamp(rates[rates.size() / 2], kSlowestFrames_hz, kFastestFrames_hz);
}

}  // namespace

bool is_bar(const ReplayIndex::WholeBeat& beat) {
  return beat.beats_per_bar > 0 && std::fmod(beat.beat, beat.beats_per_bar) == 0.0;
}

ReplayPlayer::ReplayPlayer(std::shared_ptr<const ReplayIndex> index)
    : index_(std::move(index)), position_(index_->begin), frame_hz_(frame_hz_of(*index_)) {}

void ReplayPlayer::advance(Duration passed) {
  if (!is_playing_ || passed <= Duration()) return;
  const MonoTime begin = loops_ ? range_begin() : index_->begin;
  const MonoTime end = loops_ ? range_end() : index_->end;
  const bool was_inside = position_ <= end;
  position_ += Duration::seconds(passed.as_seconds() * speed_);
  if (position_ <= end || (!was_inside && position_ <= index_->end)) return;
  const Duration length = end - begin;
  Duration over = position_ - end;
  if (length > Duration())
    over = Duration::ns(over.count_ns() % length.count_ns());
  else
    over = Duration();
  position_ = begin + std::max(over, std::min(kFirstFrames, length));
}

void ReplayPlayer::go_to(MonoTime moment) {
  position_ = std::clamp(moment, index_->begin, index_->end);
}

void ReplayPlayer::step_frames(int frames) {
  is_playing_ = false;
  jump(Duration::seconds(frames / frame_hz_));
}

void ReplayPlayer::jump_marks(int count, bool bars) {
  const auto& beats = index_->beats;
  const auto is_mark = [&](const ReplayIndex::WholeBeat& beat) { return !bars || is_bar(beat); };
  for (; count > 0; --count) {
    const auto next = std::find_if(beats.begin(), beats.end(), [&](const auto& beat) {
      return beat.time > position_ + Duration::ms(1) && is_mark(beat);
    });
    if (next == beats.end()) return;
    go_to(next->time);
  }
  for (; count < 0; ++count) {
    const Duration near = is_playing_ ? kOnTheMark : Duration::ms(1);
    const auto last = std::find_if(beats.rbegin(), beats.rend(), [&](const auto& beat) {
      return beat.time < position_ - near && is_mark(beat);
    });
    if (last == beats.rend()) return;
    go_to(last->time);
  }
}

void ReplayPlayer::change_speed(int steps) {
  const auto nearest = std::min_element(kSpeeds.begin(), kSpeeds.end(), [&](double a, double b) {
    return std::abs(a - speed_) < std::abs(b - speed_);
  });
  const auto at = std::clamp<std::ptrdiff_t>(nearest - kSpeeds.begin() + steps, 0,
                                             static_cast<std::ptrdiff_t>(kSpeeds.size()) - 1);
  speed_ = kSpeeds[static_cast<std::size_t>(at)];
}

void ReplayPlayer::set_speed(double speed) { speed_ = std::clamp(speed, kSlowest, kFastest); }

void ReplayPlayer::set_loop_begin() {
  loop_begin_ = std::max(index_->begin, std::min(position_, index_->end - kShortestLoop));
  if (loop_end_ && *loop_end_ < *loop_begin_ + kShortestLoop) loop_end_.reset();
  loops_ = true;
}

void ReplayPlayer::set_loop_end() {
  loop_end_ = std::min(index_->end, std::max(position_, index_->begin + kShortestLoop));
  if (loop_begin_ && *loop_end_ < *loop_begin_ + kShortestLoop) loop_begin_.reset();
  loops_ = true;
}

void ReplayPlayer::clear_loop() {
  loop_begin_.reset();
  loop_end_.reset();
  loops_ = false;
}

}  // namespace dance
