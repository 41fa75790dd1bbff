#include "producers/music/room/band_set.h"

#include <algorithm>
#include <cmath>

#include "core/base/random.h"

namespace dance {
namespace {

constexpr double kRate = kBandRate_hz;

double seconds_of(std::int64_t frames) { return static_cast<double>(frames) / kRate; }

}  // namespace

std::string band_title(BandStyle style) { return "House band: " + std::string(name_of(style)); }

std::uint32_t next_band_seed(std::uint32_t seed) {
  return static_cast<std::uint32_t>(Random(seed).next_u64() >> 32);
}

BandSong band_song_of(const RoomSong& song) {
  BandSong band;
  band.style = static_cast<BandStyle>(song.style);
  band.seed = song.seed;
  for (int i = 0; i < song.tempo_count; ++i) {
    const auto at = static_cast<std::size_t>(i);
    [[maybe_unused]] const bool fits =
        band.tempi.try_push({song.tempo_bar[at], song.tempo_centi_bpm[at]});
  }
  return band;
}

bool BandSet::set(const RoomSong& song) {
  if (!dance::is_valid(song)) return false;
  const BandSong band = band_song_of(song);
  if (!dance::is_valid(band)) return false;
  if (is_set() && is_same_song(song, first_)) return true;
  first_ = song;
  parts_.clear();
  append(band);
  return true;
}

void BandSet::append(const BandSong& song) {
  const std::vector<std::int64_t> bars = BandScore::bar_begins(song);
  const std::int64_t last_bar_frames = bars.back() - bars[bars.size() - 2];
  const double bar_count = static_cast<double>(bars.size() - 1);
  Part part;
  part.song = song;
  part.begin_beat = first_.start_beat;
  if (!parts_.empty()) {
    const Part& last = parts_.back();
    part.number = last.number + 1;
    part.begin_frame = last.end_frame;
    part.begin_beat = last.end_beat;
  }
  // In the rest the tempo of the last bar goes on.
  part.end_frame = part.begin_frame + bars.back() + kRest_bars * last_bar_frames;
  part.end_beat = part.begin_beat + (bar_count + kRest_bars) * dance::beats_per_bar(song.style);
  parts_.push_back(std::move(part));
  if (parts_.size() > kMostParts) parts_.pop_front();
}

const BandSet::Part& BandSet::part_at(std::int64_t frame) {
  if (frame < parts_.front().begin_frame && parts_.front().number > 0) {
    parts_.clear();
    append(band_song_of(first_));
  }
  while (frame >= parts_.back().end_frame && parts_.back().number < kMostSongs) {
    const BandSong& last = parts_.back().song;
    BandSong next;
    next.style = last.style;
    next.seed = next_band_seed(last.seed);
    [[maybe_unused]] const bool fits =
        next.tempi.try_push({0, last.tempi[last.tempi.size() - 1].centi_bpm});
    append(next);
  }
  const auto found = std::find_if(parts_.begin(), parts_.end(),
                                  [&](const Part& part) { return frame < part.end_frame; });
  Part& part = found == parts_.end() ? parts_.back() : *found;
  if (part.score == nullptr)
    part.score = std::make_shared<const BandScore>(BandScore::make(part.song));
  return part;
}

double BandSet::beat_at(double set_s) {
  const Part& part = part_at(static_cast<std::int64_t>(std::floor(set_s * kRate)));
  return part.begin_beat + part.score->grid().beat_at(set_s - seconds_of(part.begin_frame));
}

Song::NextBeat BandSet::next_beat(double set_s) {
  const Part& part = part_at(static_cast<std::int64_t>(std::floor(set_s * kRate)));
  const double begin_s = seconds_of(part.begin_frame);
  const BeatGrid& grid = part.score->grid();
  double beat = std::floor(grid.beat_at(set_s - begin_s)) + 1.0;
  // Rounding may have returned the same beat.
  if (begin_s + grid.time_of(beat) <= set_s) beat += 1.0;
  return {part.begin_beat + beat, begin_s + grid.time_of(beat), grid.tempo_bpm(beat)};
}

int BandSet::beats_per_bar() { return dance::beats_per_bar(static_cast<BandStyle>(first_.style)); }

RoomSong BandSet::song_from(const Part& part, MonoTime begin) const {
  RoomSong song = first_;
  const BandSong& band = part.song;
  song.start_time = begin + Duration::seconds(seconds_of(part.begin_frame));
  song.start_beat =
      static_cast<std::int32_t>(std::min(part.begin_beat, double{RoomSong::kLastBeat}));
  song.seed = band.seed;
  song.tempo_count = static_cast<int>(band.tempi.size());
  song.tempo_bar = {};
  song.tempo_centi_bpm = {};
  for (std::size_t i = 0; i < band.tempi.size(); ++i) {
    song.tempo_bar[i] = band.tempi[i].bar;
    song.tempo_centi_bpm[i] = band.tempi[i].centi_bpm;
  }
  return song;
}

}  // namespace dance
