#include <array>

#include "producers/music/band/compose/band_melody.h"
#include "producers/music/band/compose/band_styles.h"

namespace dance {
namespace {

using Kind = BandPartKind;

constexpr BandRhythms kCumbiaSong{{"x-xxx-x-x---....", "..xxx-x-x-x-x---", "x-x-xxx-x-x-x---",
                                   ".xxxx-x-.xxxx---", "x--xx-x-x--xx---", "xxx-x-x-xxx-x---"},
                                  {"x-x-x-x-x-------", "xxx-x-x-x-------", "..xxx-x-x-------"}};
constexpr BandRhythms kCumbiaAnswer{{"xxx-xxx-x-x-x---", "..xx..xx..xxx---", "x-xx-xx-x-x-x---",
                                     "xxxx----xxxx----", ".x.x.x.xx-------", "x.xxx.x.x.xxx---"},
                                    {"xxx-x-x-x-------", "x-x-xxx-x-------", "..xxx-x-x-------"}};

constexpr std::array kAllCumbia{BandVoice::kBass, BandVoice::kPiano, BandVoice::kAccordion};

void write_cumbia_drums(BandWriter& writer, const BandPart& part) {
  const BandSpan groove = groove_of(writer, part);
  const BandSpan beat = beat_of(writer, part);
  const bool loud = part.kind != Kind::kVerse && part.kind != Kind::kIntro;
  // Guacharaca, the calling drum off the beat, and the deep drum.
  writer.strokes(groove.begin, groove.end, BandVoice::kGuiro, "L.xxL.xxL.xxL.xx",
                 kEighth_ticks / 2);
  writer.strokes(groove.begin, groove.end, BandVoice::kCongas, ".o.o.o.o.o.o.ooo");
  writer.strokes(beat.begin, beat.end, BandVoice::kDrums, "k...k.f.k...k.k.");
  writer.strokes(beat.begin, beat.end, BandVoice::kBell, "X.x.X.x.", kEighth_ticks, loud ? 92 : 72);
  writer.strokes(beat.begin, beat.end, BandVoice::kShaker, "X.xxX.xxX.xxX.xx", kEighth_ticks / 2,
                 84);
  if (loud) writer.strokes(groove.begin, groove.end, BandVoice::kTimbales, "X..X..X.");
  if (part.kind != Kind::kEnding)
    writer.strokes(writer.end_of(part) - 2 * kBeat_ticks, writer.end_of(part), BandVoice::kTimbales,
                   "..ooloo.", kEighth_ticks / 2);
  else
    writer.strokes(groove.end, groove.end + kEighth_ticks, BandVoice::kTimbales, "c");
}

void write_cumbia_melody(BandWriter& writer, const BandPart& part, BandVoice lead) {
  const BandSpan groove = groove_of(writer, part);
  BandTune song{lead, 62, 81, 90, &kCumbiaSong, 100, part.round, {}, 0};
  BandTune answer{BandVoice::kAccordion,
                  62,
                  79,
                  84,
                  &kCumbiaAnswer,
                  200,
                  0,
                  {BandVoice::kAccordion, BandVoice::kAccordion},
                  1};
  switch (part.kind) {
    case Kind::kVerse:
      write_tune(writer, groove, song);
      break;
    case Kind::kChorus:
      song.purpose = 300;
      answer.voice = BandVoice::kTrumpet;
      answer.below = {BandVoice::kTrumpet, BandVoice::kTrombone};
      answer.below_count = 2;
      write_call_and_answer(writer, groove, song, answer);
      break;
    case Kind::kSolo:
      song.voice = BandVoice::kAccordion;
      song.rhythms = &kCumbiaAnswer;
      song.purpose = 500;
      write_tune(writer, groove, song);
      break;
    default:
      write_riff(writer, groove, answer);
      break;
  }
}

}  // namespace

void compose_cumbia(BandWriter& writer) {
  Random random = writer.random_for(1);
  constexpr std::array kLeads{BandVoice::kAccordion, BandVoice::kFlute, BandVoice::kClarinet};
  const BandVoice lead = kLeads[random.below(kLeads.size())];
  constexpr std::array<std::string_view, 2> kBasses{"1---3-5-", "1---5-8-"};
  const std::string_view bass = kBasses[random.below(kBasses.size())];
  for (const BandPart& part : writer.form()) {
    const BandSpan groove = groove_of(writer, part);
    write_cumbia_drums(writer, part);
    write_bass(writer, groove, BandVoice::kBass, bass, 31, 106);
    write_chords(writer, groove, BandVoice::kPiano, ".x.x.x.x", 60, 3, 78);
    write_chords(writer, groove, BandVoice::kGuitar, ".x.x.x.X", 55, 3, 60);
    write_cumbia_melody(writer, part, lead);
  }
  write_stops(writer, "x.xxx...", kAllCumbia);
}

}  // namespace dance
