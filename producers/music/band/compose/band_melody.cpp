#include "producers/music/band/compose/band_melody.h"

#include <algorithm>
#include <cstdlib>
#include <vector>

namespace dance {
namespace {

constexpr int kMotif_bars = 2;

struct MotifNote {
  int tick;  // from the begin of the motif
  int length_ticks;
  int step;  // in the scale, from the note before
};
using Motif = std::vector<MotifNote>;

Motif motif_of(std::string_view rhythm, Random& random) {
  // Steps are small, and a leap is followed by a step back.
  constexpr std::array kSteps{-2, -1, -1, -1, 0, 1, 1, 1, 2, -3, 3, 4};
  Motif motif;
  int before = 0;
  for (std::size_t i = 0; i < rhythm.size(); ++i) {
    if (rhythm[i] != 'x') continue;
    std::size_t held = 1;
    while (i + held < rhythm.size() && rhythm[i + held] == '-') ++held;
    int step = kSteps[random.below(kSteps.size())];
    if (std::abs(before) > 2) step = before > 0 ? -1 : 1;
    motif.push_back(
        {static_cast<int>(i) * kEighth_ticks, static_cast<int>(held) * kEighth_ticks - 4, step});
    before = step;
  }
  return motif;
}

// One or two steps become others.
void vary(Motif& motif, Random& random) {
  for (int i = 0; i < 2 && !motif.empty(); ++i) {
    MotifNote& note = motif[random.below(motif.size())];
    note.step += random.below(2) == 0 ? 1 : -1;
  }
}

// Sings motifs one after the other; each note goes on from the one before.
class Singer {
 public:
  Singer(BandWriter& writer, const BandTune& tune)
      : writer_(writer), tune_(tune), key_((tune.low_key + tune.high_key) / 2) {}

  void set_key(int key) { key_ = std::clamp(key, tune_.low_key, tune_.high_key); }
  int middle() const { return (tune_.low_key + tune_.high_key) / 2; }

  void sing(const Motif& motif, int begin, int end) {
    for (const MotifNote& note : motif)
      if (begin + note.tick < end) sing(note, begin + note.tick);
  }

 private:
  void sing(const MotifNote& note, int tick) {
    const bool strong = tick % (2 * kBeat_ticks) == 0 || note.length_ticks > 2 * kEighth_ticks;
    const BandChord& chord = writer_.anticipated_chord_at(tick);
    const auto scale =
        writer_.harmony().scale_at(tick / kBeat_ticks, tune_.low_key, tune_.high_key);
    key_ = stepped(scale, note.step);
    if (strong) key_ = in_range(nearest_tone(chord, key_));
    const int accent = strong ? 6 : tick % kBeat_ticks == 0 ? 3 : -4;
    const int lift = (key_ - middle()) / 3;
    writer_.note(tick, note.length_ticks, tune_.voice, key_, tune_.velocity + accent + lift);
    int below = key_;
    for (int i = 0; i < tune_.below_count; ++i) {
      below = nearest_tone(chord, below - 3 - (i == 0 ? 0 : 1));
      writer_.note(tick, note.length_ticks, tune_.below[static_cast<std::size_t>(i)], below,
                   tune_.velocity - 8);
    }
  }
  int stepped(const std::vector<int>& scale, int step) {
    auto at = static_cast<int>(std::lower_bound(scale.begin(), scale.end(), key_) - scale.begin());
    const int last = static_cast<int>(scale.size()) - 1;
    at = std::min(at, last);
    // At the end of the range it turns round.
    if (at + step < 0 || at + step > last) step = -step;
    return scale[static_cast<std::size_t>(std::clamp(at + step, 0, last))];
  }
  int in_range(int key) const {
    while (key > tune_.high_key) key -= 12;
    while (key < tune_.low_key) key += 12;
    return key;
  }

  BandWriter& writer_;
  const BandTune& tune_;
  int key_;
};

Motif drawn(const BandTune& tune, Random& random) {
  const auto& motifs = tune.rhythms->motifs;
  return motif_of(motifs[random.below(motifs.size())], random);
}

Motif drawn_close(const BandTune& tune, Random& random) {
  const auto& closes = tune.rhythms->closes;
  Motif motif = motif_of(closes[random.below(closes.size())], random);
  // Downwards, to the end.
  for (MotifNote& note : motif) note.step = note.step > 1 ? -1 : note.step;
  return motif;
}

}  // namespace

void write_tune(BandWriter& writer, BandSpan span, const BandTune& tune) {
  Random random = writer.random_for(tune.purpose);
  Random other = writer.random_for(tune.purpose + 1000 + static_cast<std::uint32_t>(tune.round));
  const Motif theme = drawn(tune, random);
  const Motif answer = drawn(tune, random);
  const Motif close = drawn_close(tune, random);
  // The second phrase answers otherwise, and higher.
  const Motif second_answer = drawn(tune, random);
  const Motif second_close = drawn_close(tune, random);
  const int opening = static_cast<int>(random.below(7)) - 3;
  Singer singer(writer, tune);
  const int motif_ticks = kMotif_bars * writer.bar_ticks();
  int number = 0;
  for (int tick = span.begin; tick < span.end; tick += motif_ticks, ++number) {
    const int place = number % 4;
    const bool second = number / 4 % 2 == 1;
    Motif motif = theme;
    if (place == 2) motif = second ? second_answer : answer;
    if (place == 3) motif = second ? second_close : close;
    if ((place == 1 && second) || (place == 2 && tune.round > 0)) vary(motif, other);
    const int lift = second ? 3 : 0;
    if (place < 3) singer.set_key(singer.middle() + lift + (place == 2 ? 4 : opening));
    singer.sing(motif, tick, span.end);
  }
}

void write_call_and_answer(BandWriter& writer, BandSpan span, const BandTune& call,
                           const BandTune& answer) {
  Random random = writer.random_for(answer.purpose);
  Random other = writer.random_for(call.purpose + 1000 + static_cast<std::uint32_t>(call.round));
  const Motif refrain = drawn(answer, random);
  const Motif theme = drawn(call, random);
  Singer caller(writer, call);
  Singer choir(writer, answer);
  const int motif_ticks = kMotif_bars * writer.bar_ticks();
  int number = 0;
  for (int tick = span.begin; tick < span.end; tick += motif_ticks, ++number) {
    if (number % 2 == 1) {
      choir.set_key(choir.middle() + 2);
      choir.sing(refrain, tick, span.end);
    } else {
      // Half of the calls are new.
      caller.set_key(caller.middle() + static_cast<int>(other.below(5)) - 2);
      Motif motif = theme;
      if (other.below(2) == 0)
        vary(motif, other);
      else
        motif = drawn(call, other);
      caller.sing(motif, tick, span.end);
    }
  }
}

void write_riff(BandWriter& writer, BandSpan span, const BandTune& tune) {
  Random random = writer.random_for(tune.purpose);
  const Motif riff = drawn(tune, random);
  const int opening = static_cast<int>(random.below(5)) - 2;
  Singer singer(writer, tune);
  for (int tick = span.begin; tick < span.end; tick += kMotif_bars * writer.bar_ticks()) {
    singer.set_key(singer.middle() + opening);
    singer.sing(riff, tick, span.end);
  }
}

}  // namespace dance
