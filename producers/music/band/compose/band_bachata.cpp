#include <array>

#include "producers/music/band/compose/band_melody.h"
#include "producers/music/band/compose/band_styles.h"

namespace dance {
namespace {

using Kind = BandPartKind;

constexpr BandRhythms kBachataSong{{"x-x-x-x-x---x---", "..x-x-x-x-------", "x---x-x-x-x-x---",
                                    ".xx-x-x-x-x-x---", "x-x-xxx-x---....", "..xxx-x-xxx-x---"},
                                   {"x-x-x---x-------", "x-xxx-x-x-------", "..x-x-x-x-------"}};
constexpr BandRhythms kBachataGuitar{{"xxxxxxx-xxxxxxx-", "x-xxx-xxx-xxx-x-", ".xxxxxxx.xxxx---",
                                      "xxx.xxx.xxx.xxx-", "x-xx-xx-xxxxx---", "..xxxxxxx-x-x---"},
                                     {"xxxxxxx-x-------", "x-x-xxx-x-------", "..xxxxx-x-------"}};

constexpr std::array kAllBachata{BandVoice::kBass, BandVoice::kGuitar, BandVoice::kLeadGuitar};

void write_bachata_drums(BandWriter& writer, const BandPart& part) {
  const BandSpan groove = groove_of(writer, part);
  const BandSpan beat = beat_of(writer, part);
  const bool mambo = part.kind == Kind::kRiff || part.kind == Kind::kSolo;
  writer.strokes(beat.begin, beat.end, BandVoice::kShaker, "X.xxX.xxX.xxX.xx", kEighth_ticks / 2,
                 92);
  writer.strokes(groove.begin, groove.end, BandVoice::kBongos, "XxXxXxl.XxXxXxlx");
  writer.strokes(beat.begin, beat.end, BandVoice::kDrums, "k.f.k.f.", kEighth_ticks, 90);
  if (mambo || part.kind == Kind::kChorus)
    writer.strokes(groove.begin, groove.end, BandVoice::kBell, mambo ? "X.x.X.xx" : "x...x...");
  if (part.kind != Kind::kEnding)
    writer.strokes(writer.end_of(part) - kBeat_ticks, writer.end_of(part), BandVoice::kBongos,
                   "xXlX", kEighth_ticks / 2);
  else
    writer.strokes(groove.end, groove.end + kEighth_ticks, BandVoice::kDrums, "k");
}

void write_bachata_melody(BandWriter& writer, const BandPart& part, BandVoice singer) {
  const BandSpan groove = groove_of(writer, part);
  const BandTune song{singer, 62, 79, 90, &kBachataSong, 100, part.round, {}, 0};
  BandTune guitar{BandVoice::kLeadGuitar, 62, 81, 92, &kBachataGuitar, 200, part.round, {}, 0};
  switch (part.kind) {
    case Kind::kVerse:
      write_tune(writer, groove, song);
      break;
    case Kind::kChorus: {
      BandTune high = song;
      high.purpose = 300;
      high.round = 0;
      high.below = {singer, singer};
      high.below_count = 1;
      write_tune(writer, groove, high);
      write_pad(writer, groove, BandVoice::kStrings, 57, 3, 50);
      break;
    }
    case Kind::kSolo:
      guitar.purpose = 500;
      [[fallthrough]];
    default:
      write_tune(writer, groove, guitar);
      break;
  }
}

}  // namespace

void compose_bachata(BandWriter& writer) {
  Random random = writer.random_for(1);
  constexpr std::array<std::string_view, 3> kRequintos{"13243243", "14323432", "12343243"};
  const std::string_view requinto = kRequintos[random.below(kRequintos.size())];
  constexpr std::array<std::string_view, 3> kBasses{"1---5-8-", "1--1-5-8", "1---3-5-"};
  const std::string_view bass = kBasses[random.below(kBasses.size())];
  constexpr std::array kSingers{BandVoice::kSax, BandVoice::kFlute, BandVoice::kClarinet};
  const BandVoice singer = kSingers[random.below(kSingers.size())];
  for (const BandPart& part : writer.form()) {
    const BandSpan groove = groove_of(writer, part);
    write_bachata_drums(writer, part);
    write_bass(writer, groove, BandVoice::kBass, bass, 31, 104);
    write_chords(writer, groove, BandVoice::kGuitar, "X.x-X.xx", 52, 4, 62);
    if (part.kind == Kind::kVerse || part.kind == Kind::kChorus)
      write_arpeggio(writer, groove, BandVoice::kLeadGuitar, requinto, 62, 78);
    write_bachata_melody(writer, part, singer);
  }
  write_stops(writer, "x..x..x-", kAllBachata);
}

}  // namespace dance
