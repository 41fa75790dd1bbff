#include <array>

#include "producers/music/band/compose/band_melody.h"
#include "producers/music/band/compose/band_styles.h"

namespace dance {
namespace {

using Kind = BandPartKind;

constexpr BandRhythms kTangoSong{{"x-x-x-x-x---x---", "..xxx-x-x---....", "x---xxx-x---x---",
                                  ".xxxx---.xxxx---", "x--xx-x-x---....", "x-xxx-x-x-xxx---"},
                                 {"x-x-x-x-x-------", "xxx-x-x-x-------", "x---x-x-x-------"}};
constexpr BandRhythms kTangoStrings{{"x-------x-----x-", "x-----x-x-------", "x---x---x-------",
                                     "x-----x-x---x---", "x---x-x-x-------", "..x---x-x-------"},
                                    {"x---x---x-------", "x-----x-x-------", "x-x-x---x-------"}};

constexpr std::array kAllTango{BandVoice::kUprightBass, BandVoice::kPiano, BandVoice::kBandoneon,
                               BandVoice::kStrings};

// Marcato: short strokes on the four beats, the first and the third louder. Bass and piano are the
// drums of a tango.
void write_marcato(BandWriter& writer, BandSpan span) {
  write_bass(writer, span, BandVoice::kUprightBass, "1.5.1.5.1.5.1.a.", 33, 102);
  write_chords(writer, span, BandVoice::kPiano, "X.x.X.x.", 55, 4, 72);
  write_bass(writer, span, BandVoice::kPiano, "1...1...", 33, 70);
  // Strings pluck with them.
  write_chords(writer, span, BandVoice::kGuitar, "X.x.X.x.", 52, 3, 62);
}

// Síncopa: the accent comes before the second beat.
void write_sincopa(BandWriter& writer, BandSpan span) {
  write_bass(writer, span, BandVoice::kUprightBass, "11-.5.1.", 33, 102);
  write_chords(writer, span, BandVoice::kPiano, "xX-.X.x.", 55, 4, 74);
  write_bass(writer, span, BandVoice::kPiano, "1...1...", 33, 70);
  write_chords(writer, span, BandVoice::kGuitar, "X...X.x.", 52, 3, 62);
}

void write_tango_rhythm(BandWriter& writer, const BandPart& part) {
  const BandSpan groove = groove_of(writer, part);
  const int bar = writer.bar_ticks();
  for (int tick = groove.begin; tick < groove.end; tick += bar) {
    const int number = (tick - groove.begin) / bar;
    const bool sincopa = part.kind == Kind::kChorus ? number % 4 == 1 : number % 4 == 3;
    if (sincopa && part.kind != Kind::kIntro)
      write_sincopa(writer, {tick, tick + bar});
    else
      write_marcato(writer, {tick, tick + bar});
  }
}

void write_tango_melody(BandWriter& writer, const BandPart& part) {
  const BandSpan groove = groove_of(writer, part);
  BandTune song{BandVoice::kBandoneon, 60, 79, 96, &kTangoSong, 100, part.round, {}, 0};
  BandTune violins{BandVoice::kViolin,
                   64,
                   86,
                   92,
                   &kTangoStrings,
                   200,
                   0,
                   {BandVoice::kStrings, BandVoice::kStrings},
                   1};
  switch (part.kind) {
    case Kind::kIntro:
      write_riff(writer, groove, song);
      break;
    case Kind::kVerse:
      write_tune(writer, groove, song);
      if (part.round > 0) write_tune(writer, groove, violins);
      break;
    case Kind::kChorus:
      // The violins sing, and the bandoneon holds.
      write_tune(writer, groove, violins);
      write_pad(writer, groove, BandVoice::kBandoneon, 55, 3, 62);
      break;
    case Kind::kSolo:
      song.voice = BandVoice::kPiano;
      song.low_key = 67;
      song.high_key = 86;
      song.purpose = 500;
      write_tune(writer, groove, song);
      write_pad(writer, groove, BandVoice::kStrings, 57, 3, 56);
      break;
    default:
      song.below = {BandVoice::kBandoneon, BandVoice::kBandoneon};
      song.below_count = 1;
      song.purpose = 400;
      write_tune(writer, groove, song);
      break;
  }
}

}  // namespace

void compose_tango(BandWriter& writer) {
  for (const BandPart& part : writer.form()) {
    write_tango_rhythm(writer, part);
    write_tango_melody(writer, part);
  }
  write_stops(writer, "x.x.x.x.", kAllTango);
}

}  // namespace dance
