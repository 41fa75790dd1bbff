#include <algorithm>
#include <array>

#include "producers/music/band/compose/band_melody.h"
#include "producers/music/band/compose/band_styles.h"

namespace dance {
namespace {

using Kind = BandPartKind;

// Two bars of eighths, for a clave of two and three strokes, and of three and two.
struct SalsaPatterns {
  std::string_view clave, cascara, bell, congas;
  std::string_view arpeggio[3];
};
constexpr SalsaPatterns kTwoThree{"..x.x...x..x..x.",
                                  "X.XxX.x.X.X.xxX.",
                                  "X.XoX.XoX.X.X.Xo",
                                  "htsthtOohtslhtOo",
                                  {"1-32-4-3-2-4-3-2", "3-12-3-1-4-3-2-3", "2-43-2-4-3-1-2-3"}};
constexpr SalsaPatterns kThreeTwo{"x..x..x...x.x...",
                                  "X.X.xxX.X.XxX.x.",
                                  "X.X.X.XoX.XoX.Xo",
                                  "htslhtOohtsthtOo",
                                  {"12-4-3-23-12-4-3", "31-2-4-32-31-4-2", "23-4-2-34-21-3-2"}};

constexpr BandRhythms kSalsaSong{{"..x-x-x-..x-x---", "x-x-x--x-x-x----", "x--x--x-x--x----",
                                  ".x-x-x-x---x----", "..xxx-x-x--x----", "x-xx-x-x--x-----"},
                                 {"x-x-x-x-x-------", "..x-x-x-x-------", "x--x--x-x-------"}};
constexpr BandRhythms kSalsaBrass{{"x..x..x.xx.x....", "..x.xx..x..x..x.", "x.x..x.x..x.x---",
                                   ".x.x.x.xx--.....", "xx.xx.x.x---....", "..xx..x.x..x.x.."},
                                  {"x..x..x-x-------", "x.x.xx.xx-------", "..x.x.x.x-------"}};
constexpr BandRhythms kSalsaSolo{{"xxxx.xxxx.xxx---", "..xxxxx-x.x.x---", "x.xxx.xxx.xxx-..",
                                  ".x.x.x.xxxxxx---", "xxx.xxx.xxx.xx--", "x---..xxxxxxx---"},
                                 {"xxxxx-x-x-------", "x.x.xxxxx-------", "..xxx.x-x-------"}};

constexpr std::array kAllSalsa{BandVoice::kBass, BandVoice::kPiano, BandVoice::kTrombone,
                               BandVoice::kTrumpet};

void write_salsa_drums(BandWriter& writer, const BandPart& part, const SalsaPatterns& patterns) {
  const BandSpan groove = groove_of(writer, part);
  const BandSpan beat = beat_of(writer, part);
  const int end = writer.end_of(part);
  const bool loud = part.kind == Kind::kChorus || part.kind == Kind::kRiff ||
                    part.kind == Kind::kEnding || part.kind == Kind::kSolo;
  writer.strokes(groove.begin, end, BandVoice::kClave, patterns.clave);
  // A short intro begins without congas.
  const int congas_begin =
      part.kind == Kind::kIntro ? groove.begin + 4 * writer.bar_ticks() : groove.begin;
  writer.strokes(congas_begin, groove.end, BandVoice::kCongas, patterns.congas);
  writer.strokes(beat.begin, beat.end, BandVoice::kShaker, "Xx");
  // The beats on which dancers step.
  writer.strokes(beat.begin, beat.end, BandVoice::kDrums, "k.k.k.k.", kEighth_ticks,
                 loud ? 96 : 84);
  if (loud) {
    writer.strokes(groove.begin, groove.end, BandVoice::kBell, patterns.bell);
    writer.strokes(groove.begin, groove.end, BandVoice::kGuiro, "L.xxL.xx");
    writer.strokes(groove.begin, groove.begin + kEighth_ticks, BandVoice::kTimbales, "c");
  } else {
    writer.strokes(groove.begin, groove.end, BandVoice::kTimbales, patterns.cascara);
    writer.strokes(groove.begin, groove.end, BandVoice::kBongos, "XxxxXxl.");
  }
  // The timbales lead on.
  const int fill = end - 2 * kBeat_ticks;
  if (part.kind != Kind::kEnding)
    writer.strokes(fill, end, BandVoice::kTimbales, part.round % 2 == 0 ? "..oo" : ".olo");
  else
    writer.strokes(groove.end, groove.end + kEighth_ticks, BandVoice::kTimbales, "c");
}

void write_salsa_bass(BandWriter& writer, const BandPart& part) {
  const BandSpan groove = groove_of(writer, part);
  const bool calm = part.kind == Kind::kVerse || part.kind == Kind::kIntro;
  // The first root, then the tumbao: the fifth after the two, the next root on the four.
  writer.note(groove.begin, 3 * kEighth_ticks - 3, BandVoice::kBass,
              key_from(writer.chord_at(groove.begin).root, 31), 100);
  write_bass(writer, groove, BandVoice::kBass,
             calm ? "...5--n----5--n----5--n----8--n-" : "...5--n----8--n-...35-n----8--n-", 31,
             100);
}

void write_salsa_melody(BandWriter& writer, const BandPart& part, BandVoice lead) {
  const BandSpan groove = groove_of(writer, part);
  BandTune song{lead, 62, 80, 92, &kSalsaSong, 100, part.round, {}, 0};
  const BandTune choir{BandVoice::kTrumpet,
                       64,
                       79,
                       84,
                       &kSalsaBrass,
                       200,
                       0,
                       {BandVoice::kTrombone, BandVoice::kTrombone},
                       2};
  switch (part.kind) {
    case Kind::kIntro:
      write_tune(writer, {groove.begin, groove.end}, choir);
      break;
    case Kind::kVerse: {
      write_tune(writer, groove, song);
      // The brass answers from the second verse on.
      if (part.round == 0) break;
      write_pad(writer, groove, BandVoice::kTrombone, 50, 2, 48);
      for (int bar = 6; bar < part.bars; bar += 8) {
        const int answer = groove.begin + bar * writer.bar_ticks();
        write_riff(writer, {answer, std::min(groove.end, answer + 2 * writer.bar_ticks())}, choir);
      }
      break;
    }
    case Kind::kChorus: {
      song.purpose = 300;
      write_call_and_answer(writer, groove, song, choir);
      break;
    }
    case Kind::kRiff: {
      BandTune low = choir;
      low.voice = BandVoice::kTrombone;
      low.low_key = 50;
      low.high_key = 64;
      low.purpose = 400 + static_cast<std::uint32_t>(part.round % 2);
      low.below_count = 1;
      write_riff(writer, groove, low);
      BandTune high = choir;
      high.purpose = 410 + static_cast<std::uint32_t>(part.round % 2);
      high.below = {BandVoice::kTrumpet, BandVoice::kTrumpet};
      high.below_count = 1;
      // The trumpets come in on top, four bars later.
      write_riff(writer, {groove.begin + 4 * writer.bar_ticks(), groove.end}, high);
      break;
    }
    case Kind::kSolo: {
      song.rhythms = &kSalsaSolo;
      song.purpose = 500;
      song.voice = part.round % 2 == 0 ? lead : BandVoice::kTrumpet;
      write_tune(writer, groove, song);
      break;
    }
    case Kind::kEnding:
      write_riff(writer, groove, choir);
      break;
  }
}

}  // namespace

void compose_salsa(BandWriter& writer) {
  Random random = writer.random_for(1);
  const SalsaPatterns& patterns = random.below(2) == 0 ? kTwoThree : kThreeTwo;
  const std::string_view montuno = patterns.arpeggio[random.below(3)];
  const std::string_view calm = patterns.arpeggio[random.below(3)];
  constexpr std::array kLeads{BandVoice::kFlute, BandVoice::kTrumpet, BandVoice::kSax,
                              BandVoice::kVibraphone};
  const BandVoice lead = kLeads[random.below(kLeads.size())];
  for (const BandPart& part : writer.form()) {
    const BandSpan groove = groove_of(writer, part);
    const bool verse = part.kind == Kind::kVerse;
    write_salsa_drums(writer, part, patterns);
    write_salsa_bass(writer, part);
    write_arpeggio(writer, groove, BandVoice::kPiano, verse ? calm : montuno, 60, verse ? 74 : 86,
                   !verse || part.round > 0);
    write_salsa_melody(writer, part, lead);
  }
  write_stops(writer, random.below(2) == 0 ? "x..x..x." : "x.x.xxx.", kAllSalsa);
}

}  // namespace dance
