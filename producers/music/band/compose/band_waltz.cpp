#include <array>

#include "producers/music/band/compose/band_melody.h"
#include "producers/music/band/compose/band_styles.h"

namespace dance {
namespace {

using Kind = BandPartKind;

// Two bars of three beats.
constexpr BandRhythms kWaltzSong{{"x---x-x-----", "x-x-x-x---x-", "x-----x-x-x-", "..x-x-x-----",
                                  "x---x-x---x-", "x-x-x-x-----"},
                                 {"x-x-x-x-----", "x---x-x-----", "x-----x-----"}};
constexpr BandRhythms kWaltzAnswer{{"x-----x-----", "x---x-x-----", "x-----x-x-x-", "x-x-x-x-x-x-",
                                    "..x-x-..x-x-", "x---x-x---x-"},
                                   {"x-x-x-x-----", "x---x-x-----", "x-----x-----"}};

constexpr std::array kAllWaltz{BandVoice::kUprightBass, BandVoice::kPiano, BandVoice::kStrings};

void write_waltz_rhythm(BandWriter& writer, const BandPart& part) {
  const BandSpan groove = groove_of(writer, part);
  const bool full = part.kind != Kind::kIntro && part.kind != Kind::kVerse;
  write_bass(writer, groove, BandVoice::kUprightBass, "1----.5----.", 33, 104);
  write_chords(writer, groove, BandVoice::kPiano, "..x.x.", 57, 3, 90);
  write_chords(writer, groove, BandVoice::kGuitar, "..x.x.", 52, 3, 84);
  if (part.kind != Kind::kIntro) {
    writer.strokes(groove.begin, groove.end, BandVoice::kDrums, "k.....", kEighth_ticks, 66);
    writer.strokes(groove.begin, groove.end, BandVoice::kDrums, "..p.p.", kEighth_ticks, 72);
  }
  if (full) {
    write_pad(writer, groove, BandVoice::kStrings, 55, 4, 58);
    writer.strokes(groove.begin, groove.end, BandVoice::kDrums, "r.r.r.", kEighth_ticks, 72);
  }
}

void write_waltz_melody(BandWriter& writer, const BandPart& part, BandVoice lead) {
  const BandSpan groove = groove_of(writer, part);
  BandTune song{lead, 62, 81, 104, &kWaltzSong, 100, part.round, {}, 0};
  BandTune violins{BandVoice::kViolin,
                   64,
                   84,
                   88,
                   &kWaltzAnswer,
                   200,
                   0,
                   {BandVoice::kClarinet, BandVoice::kClarinet},
                   1};
  switch (part.kind) {
    case Kind::kVerse:
      write_tune(writer, groove, song);
      if (part.round > 0) write_pad(writer, groove, BandVoice::kStrings, 57, 3, 50);
      break;
    case Kind::kChorus:
      write_tune(writer, groove, violins);
      break;
    case Kind::kSolo:
      song.voice = BandVoice::kAccordion;
      song.purpose = 500;
      write_tune(writer, groove, song);
      break;
    case Kind::kRiff:
      write_call_and_answer(writer, groove, song, violins);
      break;
    default:
      write_riff(writer, groove, violins);
      break;
  }
}

}  // namespace

void compose_waltz(BandWriter& writer) {
  Random random = writer.random_for(1);
  constexpr std::array kLeads{BandVoice::kClarinet, BandVoice::kViolin, BandVoice::kAccordion,
                              BandVoice::kFlute};
  const BandVoice lead = kLeads[random.below(kLeads.size())];
  for (const BandPart& part : writer.form()) {
    write_waltz_rhythm(writer, part);
    write_waltz_melody(writer, part, lead);
  }
  write_stops(writer, "x-x-x-", kAllWaltz);
}

}  // namespace dance
