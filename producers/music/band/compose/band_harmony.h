// Chords and scales of the house band, and the chord loops of its styles.
//
// Units/frames: semitones; pitch classes are 0 to 11, 0 is C.
#pragma once

#include <cstdint>
#include <span>
#include <vector>

#include "producers/music/band/band_song.h"
#include "producers/music/band/compose/band_form.h"

namespace dance {

enum class BandChordKind : std::uint8_t {
  kMajor,
  kMinor,
  kSeventh,
  kMinorSeventh,
  kMajorSeventh,
  kSixth,
  kMinorSixth,
  kHalfDiminished,
  kDiminished
};

struct BandChord {
  int root = 0;  // pitch class
  BandChordKind kind = BandChordKind::kMajor;

  // Tones from the root upwards: root, third, fifth, and the fourth tone of kinds that have one.
  std::span<const std::uint8_t> tones() const;
  bool has(int key) const;
  bool operator==(const BandChord&) const = default;
};

// The chord tone nearest to this key; of two, the lower.
int nearest_tone(const BandChord& chord, int key);
// The key of a pitch class within an octave from `lowest` on.
int key_from(int pitch_class, int lowest);

// The key and mode of a song, and its chord at each beat.
class BandHarmony {
 public:
  BandHarmony(BandStyle style, std::uint32_t seed, std::span<const BandPart> form);

  const BandChord& chord_at(int beat) const;  // the last one beyond the end
  // The scale that fits the key and the chord there.
  std::vector<int> scale_at(int beat, int low_key, int high_key) const;

 private:
  int tonic_;
  bool minor_;
  std::vector<BandChord> chords_;  // by beat
};

}  // namespace dance
