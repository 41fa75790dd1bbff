// BandWriter: the form, the harmony and the seed of a song, and the list of its notes in ticks, to
// which the styles add.
//
// Units/frames: kBeat_ticks to a beat; an eighth is 24 ticks. In swing the second eighth of each
//               beat comes at two thirds of it.
// Failure:      notes that begin outside the song are left out.
#pragma once

#include <cstdint>
#include <span>
#include <string_view>
#include <vector>

#include "core/base/random.h"
#include "producers/music/band/band_note.h"
#include "producers/music/band/band_song.h"
#include "producers/music/band/compose/band_form.h"
#include "producers/music/band/compose/band_harmony.h"

namespace dance {

constexpr int kBeat_ticks = 48;
constexpr int kEighth_ticks = 24;

struct BandSheetNote {
  int tick = 0;
  int length_ticks = 0;
  BandVoice voice = BandVoice::kClave;
  int key = 0;
  int velocity = 0;
};

class BandWriter {
 public:
  BandWriter(BandStyle style, std::uint32_t seed);

  BandStyle style() const { return style_; }
  std::span<const BandPart> form() const { return form_; }
  const BandHarmony& harmony() const { return harmony_; }
  int bar_beats() const { return beats_per_bar(style_); }
  int bar_ticks() const { return bar_beats() * kBeat_ticks; }
  int bars() const { return form_.back().first_bar + form_.back().bars; }
  int begin_of(const BandPart& part) const { return part.first_bar * bar_ticks(); }
  int end_of(const BandPart& part) const { return begin_of(part) + part.bars * bar_ticks(); }
  // The part's groove ends here: before its break, and before the last bar of the song.
  int groove_end_of(const BandPart& part) const;
  const BandChord& chord_at(int tick) const { return harmony_.chord_at(tick / kBeat_ticks); }
  // Notes on the last eighth of a bar belong to the next bar's chord.
  const BandChord& anticipated_chord_at(int tick) const;
  // Always the same numbers for a purpose, whatever else is drawn.
  Random random_for(std::uint32_t purpose) const;

  // Velocities are those of the loudest parts; softer parts lower them, and each note differs.
  void note(int tick, int length_ticks, BandVoice voice, int key, int velocity);
  // Writes `count` notes of the chord, from `lowest` upwards.
  void chord(int tick, int length_ticks, BandVoice voice, int lowest, int count, int velocity);
  // One stroke per letter, over and over, from tick to tick. A dot rests; band_writer.cpp lists
  // the letters.
  void strokes(int begin, int end, BandVoice voice, std::string_view steps,
               int step_ticks = kEighth_ticks, int loudness_percent = 100);

  std::vector<BandSheetNote> take_sheet() { return std::move(sheet_); }

 private:
  int loudness_percent_at(int tick) const;
  int swung(int tick) const;

  BandStyle style_;
  std::uint32_t seed_;
  std::vector<BandPart> form_;
  BandHarmony harmony_;
  Random touch_;
  std::vector<BandSheetNote> sheet_;
};

// Returns the notes of a whole song, ordered by voice, not by time.
std::vector<BandSheetNote> compose(BandWriter& writer);

}  // namespace dance
