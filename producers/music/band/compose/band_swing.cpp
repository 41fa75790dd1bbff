#include <array>

#include "producers/music/band/compose/band_melody.h"
#include "producers/music/band/compose/band_styles.h"

namespace dance {
namespace {

using Kind = BandPartKind;

constexpr BandRhythms kSwingSong{{"x-x-x-xxx---....", "..x-x-xx-x-x----", "x-xx-x--x-xx----",
                                  ".xx--xx-.xx-x---", "x--xx-x-x--x----", "..xxx-x-x--x----"},
                                 {"x-x-x--xx-------", "x-xx-x-xx-------", "..x-x--xx-------"}};
constexpr BandRhythms kSwingHorns{{"x..x....x..x....", "..xx..x...xx..x.", "x-xx.x..x-xx.x..",
                                   ".x.x....xx.x....", "x.xx.xx.x-------", "..x..x-...x..x-."},
                                  {"x..x..x-x-------", "x.xx.x-xx-------", "..x..x.xx-------"}};
constexpr BandRhythms kSwingSolo{{"xxxxxx.xxxxxx---", "..xxxxx-x.xxx---", "x.xxx.xxxxx-x-..",
                                  ".xxx.xxxxxxxx---", "xxx-xxx-xxxxx---", "x---.xxxxxxxx-.."},
                                 {"xxxxx.x-x-------", "x.xxxxx-x-------", "..xxx.xxx-------"}};

constexpr std::array kAllSwing{BandVoice::kUprightBass, BandVoice::kPiano, BandVoice::kTrumpet,
                               BandVoice::kTrombone};

void write_swing_drums(BandWriter& writer, const BandPart& part) {
  const BandSpan groove = groove_of(writer, part);
  const BandSpan beat = beat_of(writer, part);
  writer.strokes(groove.begin, groove.end, BandVoice::kDrums, "r.Rrr.Rr");
  writer.strokes(beat.begin, beat.end, BandVoice::kDrums, "..p...p.");
  writer.strokes(beat.begin, beat.end, BandVoice::kDrums, "k.f.k.f.", kEighth_ticks,
                 part.kind == Kind::kVerse ? 90 : 120);
  // The snare's remarks, louder behind the horns.
  writer.strokes(groove.begin, groove.end, BandVoice::kDrums, ".....g.....g..g....g.......g..g.");
  if (part.kind == Kind::kRiff || part.kind == Kind::kChorus) {
    writer.strokes(groove.begin, groove.end, BandVoice::kDrums, "..s...s.", kEighth_ticks, 62);
    writer.strokes(groove.begin, groove.begin + kEighth_ticks, BandVoice::kDrums, "c");
  }
  const int end = writer.end_of(part);
  if (part.kind == Kind::kEnding)
    writer.strokes(groove.end, groove.end + kEighth_ticks, BandVoice::kDrums, "c");
  else
    writer.strokes(end - 2 * kBeat_ticks, end, BandVoice::kDrums, ".s.s", kEighth_ticks, 84);
}

// A note on each beat: the chord, its tones, and half a tone beside the next root.
void write_walking_bass(BandWriter& writer, BandSpan span, Random& random) {
  for (int tick = span.begin; tick < span.end; tick += writer.bar_ticks()) {
    const BandChord& chord = writer.chord_at(tick);
    const int root = key_from(chord.root, 33);
    const int next = key_from(writer.chord_at(tick + writer.bar_ticks()).root, 33);
    const bool up = random.below(3) != 0;
    const auto tones = chord.tones();
    const int second = up ? root + tones[1] : nearest_tone(chord, root - 4);
    const int third = up ? root + tones[2] : nearest_tone(chord, root - 7);
    const int approach = next + (random.below(2) == 0 ? 1 : -1);
    const std::array keys{root, second, third == second ? root : third, approach};
    for (int beat = 0; beat < 4; ++beat)
      writer.note(tick + beat * kBeat_ticks, kBeat_ticks - 4, BandVoice::kUprightBass,
                  keys[static_cast<std::size_t>(beat)], beat % 2 == 0 ? 104 : 98);
  }
}

void write_swing_melody(BandWriter& writer, const BandPart& part, BandVoice lead) {
  const BandSpan groove = groove_of(writer, part);
  BandTune song{lead, 60, 79, 92, &kSwingSong, 100, part.round, {}, 0};
  BandTune horns{BandVoice::kTrumpet,
                 64,
                 79,
                 84,
                 &kSwingHorns,
                 200,
                 0,
                 {BandVoice::kSax, BandVoice::kTrombone},
                 2};
  switch (part.kind) {
    case Kind::kVerse:
      write_tune(writer, groove, song);
      break;
    case Kind::kChorus:
      song.purpose = 300;
      write_call_and_answer(writer, groove, song, horns);
      break;
    case Kind::kSolo:
      song.voice = part.round % 2 == 0 ? BandVoice::kSax : BandVoice::kVibraphone;
      song.rhythms = &kSwingSolo;
      song.purpose = 500;
      write_tune(writer, groove, song);
      break;
    case Kind::kRiff:
      horns.purpose = 400 + static_cast<std::uint32_t>(part.round);
      [[fallthrough]];
    default:
      write_riff(writer, groove, horns);
      break;
  }
}

}  // namespace

void compose_swing(BandWriter& writer) {
  Random random = writer.random_for(1);
  constexpr std::array<std::string_view, 3> kPianos{"x..x......x..x..", "..x....x.x....x.",
                                                    "...x..x....x...."};
  constexpr std::array kLeads{BandVoice::kClarinet, BandVoice::kTrumpet, BandVoice::kSax,
                              BandVoice::kVibraphone};
  const BandVoice lead = kLeads[random.below(kLeads.size())];
  for (const BandPart& part : writer.form()) {
    const BandSpan groove = groove_of(writer, part);
    write_swing_drums(writer, part);
    write_walking_bass(writer, groove, random);
    write_chords(writer, groove, BandVoice::kGuitar, "x.X.x.X.", 52, 3, 66);
    write_chords(writer, groove, BandVoice::kPiano, kPianos[random.below(kPianos.size())], 57, 4,
                 78);
    write_swing_melody(writer, part, lead);
  }
  write_stops(writer, random.below(2) == 0 ? "x..x..x." : "x.x..x..", kAllSwing);
}

}  // namespace dance
