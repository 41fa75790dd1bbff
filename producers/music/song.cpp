#include "producers/music/song.h"

#include <algorithm>
#include <cmath>

namespace dance {
namespace {

// A round that exceeds its last whole bar by less than this ends with that bar.
constexpr double kSpare_beats = 0.25;

}  // namespace

Song::Song(BeatGrid grid, double length_s, bool loops)
    : grid_(std::move(grid)), length_s_(length_s), loops_(loops) {
  const double bar_beats = std::max(grid_.beats_per_bar(), 1);
  const double beats = grid_.beat_at(length_s_) - std::min(grid_.beat_at(0.0), 0.0);
  round_beats_ = std::max(1.0, std::ceil((beats - kSpare_beats) / bar_beats)) * bar_beats;
}

double Song::round_of(double file_s) const {
  return loops_ ? std::max(0.0, std::floor(file_s / length_s_)) : 0.0;
}

double Song::beat_at(double song_s) const {
  const double file_s = song_s * speed_;
  const double round = round_of(file_s);
  return round * round_beats_ + grid_.beat_at(file_s - round * length_s_);
}

double Song::time_of(double beat) const {
  if (!loops_) return grid_.time_of(beat) / speed_;
  // Beats after the end of the music, in its last bar, are where the next round begins.
  const double begin = std::min(grid_.beat_at(0.0), 0.0);
  const double round = std::max(0.0, std::floor((beat - begin) / round_beats_));
  const double in_round_s = grid_.time_of(beat - round * round_beats_);
  return (round * length_s_ + std::min(in_round_s, length_s_)) / speed_;
}

double Song::tempo_bpm(double song_s) const {
  const double file_s = song_s * speed_;
  const double round = round_of(file_s);
  return grid_.tempo_bpm(grid_.beat_at(file_s - round * length_s_)) * speed_;
}

Song::NextBeat Song::next_beat(double song_s) const {
  const double file_s = song_s * speed_;
  double round = round_of(file_s);
  double beat = std::floor(grid_.beat_at(file_s - round * length_s_)) + 1.0;
  double in_round_s = grid_.time_of(beat);
  // Rounding may have returned the same beat.
  if (in_round_s + round * length_s_ <= file_s) in_round_s = grid_.time_of(beat += 1.0);
  if (loops_ && in_round_s >= length_s_) {
    round += 1.0;
    beat = std::ceil(grid_.beat_at(0.0));
    in_round_s = grid_.time_of(beat);
  }
  return {beat + round * round_beats_, (in_round_s + round * length_s_) / speed_,
          grid_.tempo_bpm(beat) * speed_};
}

}  // namespace dance
