#include "producers/music/band/compose/band_writer.h"

#include <algorithm>
#include <array>

namespace dance {
namespace {

struct Stroke {
  BandVoice voice;
  char letter;
  std::uint8_t key;
  std::uint8_t velocity;
};

// Capitals are accents.
constexpr std::array kStrokes{
    Stroke{BandVoice::kClave, 'x', 75, 100},
    Stroke{BandVoice::kBell, 'X', 56, 104},
    Stroke{BandVoice::kBell, 'x', 56, 84},
    Stroke{BandVoice::kBell, 'o', 56, 48},
    // Heel, tip, slap, open and low.
    Stroke{BandVoice::kCongas, 'h', 64, 34},
    Stroke{BandVoice::kCongas, 't', 62, 40},
    Stroke{BandVoice::kCongas, 's', 62, 100},
    Stroke{BandVoice::kCongas, 'o', 63, 74},
    Stroke{BandVoice::kCongas, 'O', 63, 112},
    Stroke{BandVoice::kCongas, 'l', 64, 80},
    Stroke{BandVoice::kBongos, 'X', 60, 104},
    Stroke{BandVoice::kBongos, 'x', 60, 70},
    Stroke{BandVoice::kBongos, 'l', 61, 92},
    // On the shell; the two drums; the cymbal.
    Stroke{BandVoice::kTimbales, 'X', 37, 98},
    Stroke{BandVoice::kTimbales, 'x', 37, 66},
    Stroke{BandVoice::kTimbales, 'o', 65, 104},
    Stroke{BandVoice::kTimbales, 'l', 66, 104},
    Stroke{BandVoice::kTimbales, 'c', 49, 84},
    Stroke{BandVoice::kShaker, 'X', 70, 108},
    Stroke{BandVoice::kShaker, 'x', 70, 46},
    Stroke{BandVoice::kGuiro, 'L', 74, 92},
    Stroke{BandVoice::kGuiro, 'x', 73, 70},
    Stroke{BandVoice::kDrums, 'k', 36, 100},
    Stroke{BandVoice::kDrums, 'f', 36, 66},
    Stroke{BandVoice::kDrums, 's', 38, 96},
    Stroke{BandVoice::kDrums, 'g', 38, 40},
    Stroke{BandVoice::kDrums, 'r', 51, 78},
    Stroke{BandVoice::kDrums, 'R', 51, 98},
    Stroke{BandVoice::kDrums, 'p', 42, 86},
    Stroke{BandVoice::kDrums, 'c', 49, 90},
    Stroke{BandVoice::kTambora, 'l', 41, 104},
    Stroke{BandVoice::kTambora, 'o', 43, 92},
    Stroke{BandVoice::kTambora, 'x', 37, 72},
    Stroke{BandVoice::kTambora, 'X', 37, 98},
};

const Stroke* find_stroke(BandVoice voice, char letter) {
  const auto found = std::find_if(kStrokes.begin(), kStrokes.end(), [&](const Stroke& stroke) {
    return stroke.voice == voice && stroke.letter == letter;
  });
  return found != kStrokes.end() ? &*found : nullptr;
}

}  // namespace

BandWriter::BandWriter(BandStyle style, std::uint32_t seed)
    : style_(style),
      seed_(seed),
      form_(band_form(style, seed)),
      harmony_(style, seed, form_),
      touch_(seed ^ 0x746f7563U) {}

int BandWriter::groove_end_of(const BandPart& part) const {
  const bool stops = part.ends_in_break || part.kind == BandPartKind::kEnding;
  return end_of(part) - (stops ? bar_ticks() : 0);
}

const BandChord& BandWriter::anticipated_chord_at(int tick) const {
  const bool last_eighth = tick % bar_ticks() == bar_ticks() - kEighth_ticks;
  return chord_at(last_eighth ? tick + kEighth_ticks : tick);
}

Random BandWriter::random_for(std::uint32_t purpose) const {
  return Random((std::uint64_t{purpose} << 32) ^ seed_);
}

int BandWriter::loudness_percent_at(int tick) const {
  const int bar = tick / bar_ticks();
  for (const BandPart& part : form_) {
    if (bar >= part.first_bar + part.bars) continue;
    switch (part.kind) {
      case BandPartKind::kIntro:
        return 88;
      case BandPartKind::kVerse:
        return 86 + 2 * std::min(part.round, 2);
      case BandPartKind::kChorus:
        return 94 + 2 * std::min(part.round, 2);
      case BandPartKind::kRiff:
        return 98;
      case BandPartKind::kSolo:
        return 92;
      case BandPartKind::kEnding:
        return 98;
    }
  }
  return 90;
}

int BandWriter::swung(int tick) const {
  if (style_ != BandStyle::kSwing) return tick;
  const int in_beat = tick % kBeat_ticks;
  const int begin = tick - in_beat;
  if (in_beat <= kEighth_ticks) return begin + in_beat * 4 / 3;
  return begin + 32 + (in_beat - kEighth_ticks) * 2 / 3;
}

void BandWriter::note(int tick, int length_ticks, BandVoice voice, int key, int velocity) {
  const int touch = static_cast<int>(touch_.below(9)) - 4;
  if (tick < 0 || tick >= bars() * bar_ticks() || key < 0 || key > 127) return;
  const int loud = velocity * loudness_percent_at(tick) / 100 + touch;
  const int begin = swung(tick);
  const int end = std::max(swung(tick + length_ticks), begin + 1);
  sheet_.push_back({begin, end - begin, voice, key, std::clamp(loud, 1, 127)});
}

void BandWriter::chord(int tick, int length_ticks, BandVoice voice, int lowest, int count,
                       int velocity) {
  const BandChord& harmony = anticipated_chord_at(tick);
  for (int key = lowest; count > 0 && key < lowest + 24; ++key)
    if (harmony.has(key)) {
      note(tick, length_ticks, voice, key, velocity);
      --count;
    }
}

void BandWriter::strokes(int begin, int end, BandVoice voice, std::string_view steps,
                         int step_ticks, int loudness_percent) {
  std::size_t step = 0;
  for (int tick = begin; tick < end; tick += step_ticks, ++step)
    if (const Stroke* stroke = find_stroke(voice, steps[step % steps.size()]))
      note(tick, step_ticks, voice, stroke->key, stroke->velocity * loudness_percent / 100);
}

}  // namespace dance
