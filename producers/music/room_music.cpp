#include "producers/music/room_music.h"

#include <algorithm>
#include <cmath>

#include "core/base/text/plain_text.h"

namespace dance {
namespace {

// Larger ones are audible between two houses; the link treats 3 ms as the same music.
constexpr double kTempoTolerance_s = 0.005;
// The message has to be right until the next one.
constexpr double kLookAhead_s = 1.5;

double steady_tempo_bpm(const Song& song) {
  const BeatGrid& grid = song.grid();
  const double beats = grid.last_beat() - grid.first_beat();
  return 60.0 * song.speed() * beats /
         (grid.time_of(grid.last_beat()) - grid.time_of(grid.first_beat()));
}

bool fits_tempo(const Music& music, const Song& song, MonoTime begin, double song_s) {
  const double line = music.beats_at(begin + Duration::seconds(song_s));
  return std::abs(line - song.beat_at(song_s)) * 60.0 / music.tempo_bpm <= kTempoTolerance_s;
}

}  // namespace

MusicTitle music_title(const std::string& path) {
  const std::size_t slash = path.find_last_of('/');
  std::string name = slash == std::string::npos ? path : path.substr(slash + 1);
  if (const std::size_t dot = name.find_last_of('.'); dot != std::string::npos && dot > 0)
    name.resize(dot);
  return shortened_title(name);
}

MusicTitle shortened_title(std::string_view text) {
  MusicTitle title;
  const std::string name = plain_text(text);
  // A cut within a UTF-8 character leaves no valid text: try one byte less.
  for (std::size_t size = std::min<std::size_t>(name.size(), 63); size > 0; --size)
    if (is_plain_text(name.substr(0, size)) && title.assign(name.substr(0, size))) return title;
  [[maybe_unused]] const bool fits = title.assign("music");
  return title;
}

const Music& RoomMusic::update(const Song& song, MonoTime begin, MonoTime now) {
  const double song_s = std::max(0.0, (now - begin).as_seconds());
  const bool holds = music_.playing && fits_tempo(music_, song, begin, song_s) &&
                     fits_tempo(music_, song, begin, song_s + kLookAhead_s);
  if (!holds) {
    const double from_s = song.time_of(std::ceil(song.beat_at(song_s)));
    music_.start_beats = song.beat_at(from_s);
    music_.start_time = begin + Duration::seconds(from_s);
    music_.beats_per_bar = std::max(song.beats_per_bar(), 1);
    music_.playing = true;
    music_.title = title_;
    music_.clock_id = clock_id_;
    // The mean tempo where the song keeps it, else the tempo up to the next message.
    music_.tempo_bpm = steady_tempo_bpm(song);
    if (!fits_tempo(music_, song, begin, song_s + kLookAhead_s))
      music_.tempo_bpm =
          60.0 * (song.beat_at(from_s + kLookAhead_s) - music_.start_beats) / kLookAhead_s;
    music_.tempo_bpm = std::clamp(music_.tempo_bpm, kLeastTempo_bpm, kMostTempo_bpm);
  }
  music_.time = now;
  return music_;
}

const Music& RoomMusic::update_stopped(double beats, MonoTime now) {
  music_.start_beats = beats;
  music_.start_time = now;
  music_.playing = false;
  music_.title = title_;
  music_.clock_id = clock_id_;
  music_.time = now;
  return music_;
}

MonoTime begin_of_room_music(const Music& music, const Song& song) {
  return music.start_time - Duration::seconds(song.time_of(music.start_beats));
}

Beat beat_of_room_music(const Music& music, MonoTime now) {
  Beat beat;
  beat.time = now;
  beat.clock_id = music.clock_id;
  beat.tempo_bpm = music.tempo_bpm;
  beat.beats_per_bar = music.beats_per_bar;
  beat.confidence = 1.0f;
  beat.playing = music.playing;
  beat.beat = music.beats_at(now);
  beat.beat_time = now;
  if (music.playing) {
    const double next = std::floor(beat.beat) + 1.0;
    beat.beat_time = now + Duration::seconds((next - beat.beat) * 60.0 / music.tempo_bpm);
    beat.beat = next;
  }
  return beat;
}

}  // namespace dance
