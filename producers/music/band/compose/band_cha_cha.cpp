#include <array>

#include "producers/music/band/compose/band_melody.h"
#include "producers/music/band/compose/band_styles.h"

namespace dance {
namespace {

using Kind = BandPartKind;

constexpr BandRhythms kChaChaSong{{"x-x-x-x-x---....", "..x-x-xxx---....", "x---x-x-xxx-....",
                                   ".xx-x-x-x---x-..", "x-xxx-..x-xxx-..", "..x-x---..x-x---"},
                                  {"x-x-x-x-x-------", "x-xxx-x-x-------", "..x-x-x-x-------"}};
constexpr BandRhythms kChaChaAnswer{{"x..x..x.xxx-....", "..x.x...xxx-....", "x.x.x...x.x.x-..",
                                     "xx.xx.x.x---....", "x...xxx-x...xxx-", "..x.xxx-..x.xxx-"},
                                    {"x..x..x-x-------", "x.x.xxx-x-------", "..x.x.x.x-------"}};

constexpr std::array kAllChaCha{BandVoice::kBass, BandVoice::kPiano, BandVoice::kStrings,
                                BandVoice::kFlute};

void write_cha_cha_drums(BandWriter& writer, const BandPart& part) {
  const BandSpan groove = groove_of(writer, part);
  const BandSpan beat = beat_of(writer, part);
  const bool loud = part.kind == Kind::kChorus || part.kind == Kind::kRiff ||
                    part.kind == Kind::kEnding || part.kind == Kind::kSolo;
  writer.strokes(beat.begin, beat.end, BandVoice::kBell, "X.X.X.X.", kEighth_ticks,
                 loud ? 100 : 84);
  writer.strokes(groove.begin, groove.end, BandVoice::kGuiro, "L.xxL.xx");
  writer.strokes(groove.begin, groove.end, BandVoice::kCongas, "htsthtOohtslhtOo");
  writer.strokes(beat.begin, beat.end, BandVoice::kShaker, "X.x.X.xx");
  if (loud) writer.strokes(groove.begin, groove.end, BandVoice::kClave, "x..x..x...x.x...");
  const int end = writer.end_of(part);
  writer.strokes(groove.end, groove.end + kEighth_ticks, BandVoice::kTimbales, "c");
  if (part.kind != Kind::kEnding)
    writer.strokes(end - 2 * kBeat_ticks, end, BandVoice::kTimbales, "..ol.ooo", kEighth_ticks / 2);
}

void write_cha_cha_melody(BandWriter& writer, const BandPart& part) {
  const BandSpan groove = groove_of(writer, part);
  BandTune song{BandVoice::kFlute, 69, 88, 90, &kChaChaSong, 100, part.round, {}, 0};
  const BandTune choir{BandVoice::kStrings,
                       62,
                       77,
                       84,
                       &kChaChaAnswer,
                       200,
                       0,
                       {BandVoice::kStrings, BandVoice::kStrings},
                       1};
  switch (part.kind) {
    case Kind::kVerse:
      write_tune(writer, groove, song);
      if (part.round > 0) write_pad(writer, groove, BandVoice::kStrings, 57, 3, 52);
      break;
    case Kind::kChorus:
      write_call_and_answer(writer, groove, song, choir);
      break;
    case Kind::kSolo:
      song.voice = BandVoice::kPiano;
      song.low_key = 72;
      song.high_key = 91;
      song.purpose = 500;
      write_tune(writer, groove, song);
      write_riff(writer, groove, choir);
      break;
    default:
      write_riff(writer, groove, choir);
      break;
  }
}

}  // namespace

void compose_cha_cha(BandWriter& writer) {
  Random random = writer.random_for(1);
  constexpr std::array<std::string_view, 3> kPianos{"1-3.2-3-.4.3-2-3", "1.3.23.2.3.2.43.",
                                                    "3-1.2-3..4-32-1-"};
  const std::string_view piano = kPianos[random.below(kPianos.size())];
  constexpr std::array<std::string_view, 2> kBasses{"1--5--8-1--5--3-", "1-..5-8-1--5--n-"};
  const std::string_view bass = kBasses[random.below(kBasses.size())];
  for (const BandPart& part : writer.form()) {
    const BandSpan groove = groove_of(writer, part);
    write_cha_cha_drums(writer, part);
    write_bass(writer, groove, BandVoice::kBass, bass, 31, 100);
    write_arpeggio(writer, groove, BandVoice::kPiano, piano, 60, 82, part.kind != Kind::kVerse);
    write_cha_cha_melody(writer, part);
  }
  // One, two, cha-cha-cha.
  write_stops(writer, "x.x.xxx-", kAllChaCha);
}

}  // namespace dance
