#include "producers/music/band/compose/band_patterns.h"

#include <algorithm>

namespace dance {
namespace {

// Notes end a bit early, so that the begin of the next one is heard.
constexpr int kGap_ticks = 3;

struct Onset {
  int tick;
  int length_ticks;
  char letter;
};

// f(onset) for each letter that is neither a dot nor a dash.
template <class F>
void for_each_onset(BandSpan span, std::string_view pattern, const F& f) {
  const int steps = static_cast<int>(pattern.size());
  const int count = (span.end - span.begin) / kEighth_ticks;
  const auto letter_at = [&](int step) { return pattern[static_cast<std::size_t>(step % steps)]; };
  for (int step = 0; step < count; ++step) {
    if (letter_at(step) == '.' || letter_at(step) == '-') continue;
    int held = 1;
    while (held < steps && letter_at(step + held) == '-') ++held;
    f(Onset{span.begin + step * kEighth_ticks, held * kEighth_ticks - kGap_ticks, letter_at(step)});
  }
}

int tone_above(const BandChord& chord, int lowest, int number) {
  for (int key = lowest; key < lowest + 48; ++key)
    if (chord.has(key) && --number == 0) return key;
  return lowest;
}

int bass_key(const BandWriter& writer, const Onset& onset, int lowest) {
  const int bar = onset.tick / writer.bar_ticks();
  const BandChord& chord = writer.chord_at(onset.tick);
  const auto tones = chord.tones();
  const int root = key_from(chord.root, lowest);
  const int next = key_from(writer.chord_at((bar + 1) * writer.bar_ticks()).root, lowest);
  switch (onset.letter) {
    case '3':
      return root + tones[1];
    case '5':
      return root + tones[2] > lowest + 12 ? root + tones[2] - 12 : root + tones[2];
    case '7':
      return root + tones[std::min<std::size_t>(3, tones.size() - 1)];
    case '8':
      return root + 12;
    case 'n':
      return next;
    case 'a':
      return next - 1;
    default:
      return root;
  }
}

void write_hits(BandWriter& writer, BandSpan span, std::string_view pattern,
                std::span<const BandVoice> voices) {
  for (const BandVoice voice : voices) {
    const bool bass = voice == BandVoice::kBass || voice == BandVoice::kUprightBass;
    if (bass)
      write_bass(writer, span, voice, pattern, 31, 104);
    else
      write_chords(writer, span, voice, pattern, voice == BandVoice::kTrombone ? 52 : 60,
                   voice == BandVoice::kPiano ? 4 : 2, 96);
  }
}

}  // namespace

BandSpan groove_of(const BandWriter& writer, const BandPart& part) {
  return {writer.begin_of(part), writer.groove_end_of(part)};
}

BandSpan beat_of(const BandWriter& writer, const BandPart& part) {
  const bool ends = part.kind == BandPartKind::kEnding;
  return {writer.begin_of(part), ends ? writer.groove_end_of(part) : writer.end_of(part)};
}

void write_bass(BandWriter& writer, BandSpan span, BandVoice voice, std::string_view pattern,
                int lowest, int velocity) {
  for_each_onset(span, pattern, [&](const Onset& onset) {
    const bool on_one = onset.tick % writer.bar_ticks() == 0;
    writer.note(onset.tick, onset.length_ticks, voice, bass_key(writer, onset, lowest),
                velocity + (on_one ? 6 : 0));
  });
}

void write_chords(BandWriter& writer, BandSpan span, BandVoice voice, std::string_view pattern,
                  int lowest, int count, int velocity) {
  for_each_onset(span, pattern, [&](const Onset& onset) {
    const BandChord& chord = writer.anticipated_chord_at(onset.tick);
    for (int i = 1; i <= count; ++i)
      writer.note(onset.tick, onset.length_ticks, voice, tone_above(chord, lowest, i),
                  onset.letter == 'X' ? velocity + 14 : velocity);
  });
}

void write_arpeggio(BandWriter& writer, BandSpan span, BandVoice voice, std::string_view pattern,
                    int lowest, int velocity, bool octaves) {
  for_each_onset(span, pattern, [&](const Onset& onset) {
    const BandChord& chord = writer.anticipated_chord_at(onset.tick);
    const int key = tone_above(chord, lowest, onset.letter - '0');
    const int accent = onset.tick % kBeat_ticks == 0 ? 8 : -8;
    writer.note(onset.tick, onset.length_ticks, voice, key, velocity + accent);
    if (octaves) writer.note(onset.tick, onset.length_ticks, voice, key + 12, velocity + accent);
  });
}

void write_pad(BandWriter& writer, BandSpan span, BandVoice voice, int lowest, int count,
               int velocity) {
  for (int tick = span.begin; tick < span.end; tick += writer.bar_ticks())
    writer.chord(tick, writer.bar_ticks() - kGap_ticks, voice, lowest, count, velocity);
}

void write_stops(BandWriter& writer, std::string_view pattern, std::span<const BandVoice> voices) {
  for (const BandPart& part : writer.form()) {
    const BandSpan stop{writer.groove_end_of(part), writer.end_of(part)};
    if (part.ends_in_break) write_hits(writer, stop, pattern, voices);
    if (part.kind == BandPartKind::kEnding) write_hits(writer, stop, "x----...", voices);
  }
}

}  // namespace dance
