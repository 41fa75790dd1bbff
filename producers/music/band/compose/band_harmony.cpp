#include "producers/music/band/compose/band_harmony.h"

#include <algorithm>
#include <array>

#include "core/base/assert.h"
#include "core/base/random.h"
#include "producers/music/band/compose/band_loops.h"

namespace dance {
namespace {

using enum BandChordKind;

constexpr std::array<std::uint8_t, 3> kMajorTones{0, 4, 7};
constexpr std::array<std::uint8_t, 3> kMinorTones{0, 3, 7};
constexpr std::array<std::uint8_t, 4> kSeventhTones{0, 4, 7, 10};
constexpr std::array<std::uint8_t, 4> kMinorSeventhTones{0, 3, 7, 10};
constexpr std::array<std::uint8_t, 4> kMajorSeventhTones{0, 4, 7, 11};
constexpr std::array<std::uint8_t, 4> kSixthTones{0, 4, 7, 9};
constexpr std::array<std::uint8_t, 4> kMinorSixthTones{0, 3, 7, 9};
constexpr std::array<std::uint8_t, 4> kHalfDiminishedTones{0, 3, 6, 10};
constexpr std::array<std::uint8_t, 4> kDiminishedTones{0, 3, 6, 9};

constexpr std::array<int, 7> kMajorScale{0, 2, 4, 5, 7, 9, 11};
constexpr std::array<int, 7> kMinorScale{0, 2, 3, 5, 7, 8, 10};

std::span<const std::uint8_t> tones_of(BandChordKind kind) {
  switch (kind) {
    case kMajor:
      return kMajorTones;
    case kMinor:
      return kMinorTones;
    case kSeventh:
      return kSeventhTones;
    case kMinorSeventh:
      return kMinorSeventhTones;
    case kMajorSeventh:
      return kMajorSeventhTones;
    case kSixth:
      return kSixthTones;
    case kMinorSixth:
      return kMinorSixthTones;
    case kHalfDiminished:
      return kHalfDiminishedTones;
    case kDiminished:
      return kDiminishedTones;
  }
  return kMajorTones;
}

const BandLoop& pick(std::span<const BandLoop> loops, bool minor, Random& random) {
  // A tango may change its mode in the chorus; the other styles keep theirs if they can.
  std::vector<const BandLoop*> fitting;
  for (const BandLoop& loop : loops)
    if (loop.minor == minor) fitting.push_back(&loop);
  if (fitting.empty()) return loops[random.below(loops.size())];
  return *fitting[random.below(fitting.size())];
}

void append_bars(const BandLoop& loop, int tonic, int beats, int beats_per_bar,
                 std::vector<BandChord>& chords) {
  const std::size_t end = chords.size() + static_cast<std::size_t>(beats);
  while (chords.size() < end)
    for (const BandLoopChord& chord : loop.chords)
      for (int i = 0; i < chord.halves * beats_per_bar / 2 && chords.size() < end; ++i)
        chords.push_back({(tonic + chord.step) % 12, chord.kind});
}

}  // namespace

std::span<const std::uint8_t> BandChord::tones() const { return tones_of(kind); }

bool BandChord::has(int key) const {
  const int above = ((key - root) % 12 + 12) % 12;
  const auto all = tones();
  return std::find(all.begin(), all.end(), above) != all.end();
}

int nearest_tone(const BandChord& chord, int key) {
  for (int distance = 0; distance < 12; ++distance) {
    if (chord.has(key - distance)) return key - distance;
    if (chord.has(key + distance)) return key + distance;
  }
  return key;
}

int key_from(int pitch_class, int lowest) {
  return lowest + ((pitch_class - lowest) % 12 + 12) % 12;
}

BandHarmony::BandHarmony(BandStyle style, std::uint32_t seed, std::span<const BandPart> form) {
  Random random(seed ^ 0x6b657973U);
  constexpr std::array kTonics{0, 2, 4, 5, 7, 9, 10};
  tonic_ = kTonics[random.below(kTonics.size())];
  const BandLoops loops = loops_of(style);
  const BandLoop& verse = loops.verse[random.below(loops.verse.size())];
  minor_ = verse.minor;
  const BandLoop& chorus = pick(loops.chorus, minor_, random);
  const int bar_beats = beats_per_bar(style);
  for (const BandPart& part : form) {
    const bool of_verse = part.kind == BandPartKind::kVerse || part.kind == BandPartKind::kIntro;
    append_bars(of_verse ? verse : chorus, tonic_, part.bars * bar_beats, bar_beats, chords_);
  }
  // It ends at home.
  const BandChord home{tonic_, minor_ ? kMinor : kMajor};
  const auto last_bars = static_cast<std::size_t>(2 * bar_beats);
  DANCE_ASSERT(chords_.size() > last_bars, chords_.size());
  std::fill(chords_.end() - static_cast<std::ptrdiff_t>(last_bars),
            chords_.end() - static_cast<std::ptrdiff_t>(bar_beats),
            BandChord{(tonic_ + 7) % 12, kSeventh});
  std::fill(chords_.end() - static_cast<std::ptrdiff_t>(bar_beats), chords_.end(), home);
}

const BandChord& BandHarmony::chord_at(int beat) const {
  return chords_[std::min(static_cast<std::size_t>(std::max(beat, 0)), chords_.size() - 1)];
}

std::vector<int> BandHarmony::scale_at(int beat, int low_key, int high_key) const {
  const BandChord& chord = chord_at(beat);
  const auto& scale = minor_ ? kMinorScale : kMajorScale;
  std::vector<int> keys;
  for (int key = low_key; key <= high_key; ++key) {
    const int degree = ((key - tonic_) % 12 + 12) % 12;
    bool in_scale = std::find(scale.begin(), scale.end(), degree) != scale.end();
    // A tone of the scale half a tone beside one of the chord that is not of the scale gives way.
    if (in_scale && !chord.has(key))
      for (const int beside : {key - 1, key + 1}) {
        const int other = ((beside - tonic_) % 12 + 12) % 12;
        if (chord.has(beside) && std::find(scale.begin(), scale.end(), other) == scale.end())
          in_scale = false;
      }
    if (in_scale || chord.has(key)) keys.push_back(key);
  }
  return keys;
}

}  // namespace dance
