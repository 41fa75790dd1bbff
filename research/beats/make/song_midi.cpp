#include <algorithm>
#include <cmath>
#include <string_view>

#include "research/beats/make/song_maker.h"

namespace dance {
namespace {

constexpr std::uint32_t kTicksASecond = 1000;

void put_text(std::vector<std::uint8_t>& out, std::string_view text) {
  out.insert(out.end(), text.begin(), text.end());
}

void put_big_endian(std::vector<std::uint8_t>& out, std::uint32_t number, int bytes) {
  for (int i = bytes - 1; i >= 0; --i) out.push_back(static_cast<std::uint8_t>(number >> 8 * i));
}

// Seven bits a byte; all but the last have the eighth set.
void put_length(std::vector<std::uint8_t>& out, std::uint32_t number) {
  for (int shift = 28; shift > 0; shift -= 7)
    if (number >> shift != 0)
      out.push_back(static_cast<std::uint8_t>(0x80 | (number >> shift & 127)));
  out.push_back(static_cast<std::uint8_t>(number & 127));
}

struct MidiEvent {
  std::uint32_t tick;
  std::uint8_t status;
  std::uint8_t key;
  std::uint8_t loudness;  // 0 ends a tone
};

}  // namespace

std::vector<std::uint8_t> write_midi(const MadeSong& song) {
  std::vector<MidiEvent> events;
  for (const SongNote& note : song.notes) {
    const auto tick = [](double t) {
      return static_cast<std::uint32_t>(std::lround(t * kTicksASecond));
    };
    const auto status = static_cast<std::uint8_t>(0x90 | note.channel);
    const auto key = static_cast<std::uint8_t>(note.key);
    events.push_back({tick(note.start_s), status, key, static_cast<std::uint8_t>(note.loudness)});
    events.push_back({tick(note.start_s + note.length_s), status, key, 0});
  }
  std::stable_sort(events.begin(), events.end(), [](const MidiEvent& a, const MidiEvent& b) {
    return a.tick != b.tick ? a.tick < b.tick : a.loudness < b.loudness;
  });

  std::vector<std::uint8_t> track;
  put_big_endian(track, 0x00ff5103, 4);  // a quarter note lasts a second
  put_big_endian(track, 1'000'000, 3);
  for (std::size_t channel = 0; channel < song.programs.size(); ++channel) {
    track.push_back(0);
    track.push_back(static_cast<std::uint8_t>(0xc0 | channel));
    track.push_back(static_cast<std::uint8_t>(song.programs[channel]));
  }
  std::uint32_t now = 0;
  for (const MidiEvent& event : events) {
    put_length(track, event.tick - now);
    now = event.tick;
    track.insert(track.end(), {event.status, event.key, event.loudness});
  }
  put_big_endian(track, 0x00ff2f00, 4);

  std::vector<std::uint8_t> file;
  put_text(file, "MThd");
  put_big_endian(file, 6, 4);
  put_big_endian(file, 0, 2);
  put_big_endian(file, 1, 2);
  put_big_endian(file, kTicksASecond, 2);
  put_text(file, "MTrk");
  put_big_endian(file, static_cast<std::uint32_t>(track.size()), 4);
  file.insert(file.end(), track.begin(), track.end());
  return file;
}

}  // namespace dance
