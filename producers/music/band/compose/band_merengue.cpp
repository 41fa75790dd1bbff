#include <array>

#include "producers/music/band/compose/band_melody.h"
#include "producers/music/band/compose/band_styles.h"

namespace dance {
namespace {

using Kind = BandPartKind;

constexpr BandRhythms kMerengueSong{{"x-x-x-xxx-x-x---", "..x-x-x-x-x-x---", "x-xxx-x-x-xxx---",
                                     "x-x-xxx-x---....", ".xx-.xx-x-x-x---", "x---x-x-x-x-x---"},
                                    {"x-x-x-x-x-------", "x-xxx-x-x-------", "..x-x-x-x-------"}};
constexpr BandRhythms kMerengueSax{{"xxx.xxx.xxx.xxx.", "xx.xx.xxxx.xx.x.", "x.xxx.xxx.xxx.x.",
                                    ".xxx.xxx.xxx.xxx", "xxxxxx.xxxxxxx..", "x.xx.xx.x.xx.xx."},
                                   {"xxxxxxx-x-------", "x.xxx.x-x-------", "xxx.xxx-x-------"}};

constexpr std::array kAllMerengue{BandVoice::kBass, BandVoice::kPiano, BandVoice::kTrumpet,
                                  BandVoice::kSax};

void write_merengue_drums(BandWriter& writer, const BandPart& part) {
  const BandSpan groove = groove_of(writer, part);
  const BandSpan beat = beat_of(writer, part);
  writer.strokes(beat.begin, beat.end, BandVoice::kShaker, "X.xxX.xxX.xxX.xx", kEighth_ticks / 2);
  writer.strokes(groove.begin, groove.end, BandVoice::kTambora, "X.x.X.x.X.x.olol",
                 kEighth_ticks / 2);
  writer.strokes(beat.begin, beat.end, BandVoice::kDrums, "k.k.k.k.", kEighth_ticks,
                 part.kind == Kind::kVerse ? 84 : 96);
  writer.strokes(groove.begin, groove.end, BandVoice::kCongas, "..s...oo..s..ooo");
  if (part.kind == Kind::kChorus || part.kind == Kind::kRiff)
    writer.strokes(groove.begin, groove.end, BandVoice::kBell, "X.x.X.x.", kEighth_ticks, 84);
  if (part.kind != Kind::kIntro && part.kind != Kind::kVerse)
    writer.strokes(groove.begin, groove.begin + kEighth_ticks, BandVoice::kDrums, "c");
  if (part.kind != Kind::kEnding)
    writer.strokes(writer.end_of(part) - 2 * kBeat_ticks, writer.end_of(part), BandVoice::kTambora,
                   "o.oolol.", kEighth_ticks / 2);
  else
    writer.strokes(groove.end, groove.end + kEighth_ticks, BandVoice::kDrums, "c");
}

void write_merengue_melody(BandWriter& writer, const BandPart& part, BandVoice lead) {
  const BandSpan groove = groove_of(writer, part);
  BandTune song{lead, 62, 80, 88, &kMerengueSong, 100, part.round, {}, 0};
  BandTune saxes{
      BandVoice::kSax, 58, 74, 82, &kMerengueSax, 200, 0, {BandVoice::kSax, BandVoice::kSax}, 1};
  const BandTune brass{BandVoice::kTrumpet,
                       64,
                       80,
                       84,
                       &kMerengueSong,
                       250,
                       0,
                       {BandVoice::kTrumpet, BandVoice::kTrombone},
                       2};
  switch (part.kind) {
    case Kind::kVerse:
      write_tune(writer, groove, song);
      break;
    case Kind::kChorus:
      song.purpose = 300;
      write_call_and_answer(writer, groove, song, brass);
      break;
    case Kind::kRiff:
      // Jaleo.
      saxes.purpose = 400 + static_cast<std::uint32_t>(part.round % 2);
      write_riff(writer, groove, saxes);
      write_riff(writer, {groove.begin + 4 * writer.bar_ticks(), groove.end}, brass);
      break;
    case Kind::kSolo:
      song.voice = BandVoice::kAccordion;
      song.rhythms = &kMerengueSax;
      song.purpose = 500;
      write_tune(writer, groove, song);
      break;
    default:
      write_riff(writer, groove, brass);
      break;
  }
}

}  // namespace

void compose_merengue(BandWriter& writer) {
  Random random = writer.random_for(1);
  constexpr std::array<std::string_view, 3> kPianos{".12.43.2.31.42.3", "1.32.43.1.32.43.",
                                                    ".13.24.3.13.24.2"};
  const std::string_view piano = kPianos[random.below(kPianos.size())];
  constexpr std::array kLeads{BandVoice::kAccordion, BandVoice::kTrumpet, BandVoice::kFlute};
  const BandVoice lead = kLeads[random.below(kLeads.size())];
  for (const BandPart& part : writer.form()) {
    const BandSpan groove = groove_of(writer, part);
    write_merengue_drums(writer, part);
    write_bass(writer, groove, BandVoice::kBass,
               part.kind == Kind::kVerse ? "1---5---" : "1-..5-1-1-..5-3-", 31, 104);
    write_arpeggio(writer, groove, BandVoice::kPiano, piano, 60, 80, true);
    if (part.kind == Kind::kVerse && part.round > 0)
      write_chords(writer, groove, BandVoice::kAccordion, ".x.x.x.x", 60, 3, 50);
    write_merengue_melody(writer, part, lead);
  }
  write_stops(writer, "x.xx.xx.", kAllMerengue);
}

}  // namespace dance
