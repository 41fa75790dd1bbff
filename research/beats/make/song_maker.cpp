#include "research/beats/make/song_maker.h"

#include <algorithm>
#include <cmath>
#include <numbers>
#include <string>

#include "core/base/random.h"

namespace dance {
namespace {

constexpr std::size_t kBarBeats = 4;
constexpr std::size_t kRowSteps = 16;
constexpr std::size_t kSectionBars = 8;
constexpr double kFirstBeat_s = 0.5;
// Of a row's places, in the most varied song.
constexpr double kAdded = 0.07;
constexpr double kLeftOut = 0.15;
// Of a song's layers, drums and instruments, in every other song.
constexpr double kBorrowed = 0.35;
// Of General MIDI: tones that have an onset, and drums.
constexpr std::uint64_t kPrograms = 96;
constexpr int kLowestDrum = 35;
constexpr std::uint64_t kDrums = 47;

using Chord = std::array<int, 3>;  // semitones
constexpr Chord kMajor{0, 4, 7};
constexpr Chord kMinor{0, 3, 7};
constexpr std::array<std::array<int, 4>, 8> kProgressions{{{0, 5, 7, 0},
                                                           {0, 8, 3, 10},
                                                           {0, 0, 5, 7},
                                                           {0, 10, 8, 7},
                                                           {0, 5, 0, 7},
                                                           {0, 7, 9, 5},
                                                           {0, 3, 5, 7},
                                                           {0, 0, 7, 7}}};

// Voices: channel, lowest root, programs, and those of songs that are kept back.
struct Instrument {
  int channel;
  int lowest;
  std::vector<int> programs;
  std::vector<int> kept_programs;
};

const Instrument& instrument_of(SongVoice voice) {
  static const std::vector<Instrument> kInstruments{
      {MadeSong::kDrumChannel, 0, {0}, {0}},
      {1, 28, {32, 33, 34, 35, 38}, {36, 39}},
      {0, 57, {0, 1, 2, 4, 16}, {3, 5, 17}},
      {2, 52, {24, 25, 26, 27}, {28, 105}},
      {5, 40, {29, 30}, {29, 30}},
      {3, 60, {56, 57, 61, 65}, {59, 62}},
      {4, 67, {11, 56, 65, 66, 71, 73, 80}, {12, 22, 40, 68, 75}},
      {6, 55, {48, 50, 52, 89}, {49, 51, 91}},
  };
  return kInstruments[static_cast<std::size_t>(voice)];
}

// A layer as one song plays it.
struct PlayedLayer {
  const SongLayer* layer;
  std::string row;
  std::array<int, 3> drums;
  double loudness;
  bool sounds = true;  // in this section
};

class SongMaker {
 public:
  SongMaker(const SongStyle& style, double seconds, std::uint64_t seed, SongUse use)
      : style_(style),
        is_kept_back_(use == SongUse::kKeptBack),
        is_mixed_(use == SongUse::kMixed),
        random_(seed) {
    song_.tempo_bpm = random_.uniform(style.least_tempo_bpm, style.most_tempo_bpm);
    lay_beats(seconds);
    swing_ = random_.uniform(style.least_swing, style.most_swing);
    jitter_s_ = style.is_steady ? 0.001 : random_.uniform(0.002, 0.007);
    progression_ = kProgressions[random_.below(kProgressions.size())];
    key_ = static_cast<int>(random_.below(12));
    is_minor_ = random_.below(2) == 0;
    bars_a_chord_ = random_.below(3) == 0 ? 2 : 1;
    if (!is_kept_back_) variety_ = random_.uniform();
    choose_layers();
  }

  MadeSong make() {
    const std::size_t bars = (song_.beats_s.size() - 1) / kBarBeats;
    for (std::size_t bar = 0; bar < bars; ++bar) {
      if (bar % kSectionBars == 0) begin_section();
      const bool is_break = breaks_ && bar % kSectionBars >= kSectionBars - 2;
      const bool is_fill = bar % kSectionBars == kSectionBars - 1 && random_.uniform() < 0.6;
      for (const PlayedLayer& played : layers_)
        if (played.sounds && !(is_break && played.layer->voice == SongVoice::kDrums))
          play(played, bar);
      if (is_fill && has_fills_) play_fill(bar);
      if (has_drums_ && bar % kSectionBars == 0 && random_.uniform() < 0.5)
        strike(bar, 0.0, 49, 96);
    }
    return std::move(song_);
  }

 private:
  void lay_beats(double seconds) {
    const std::uint64_t kind = style_.is_steady ? 0 : random_.below(5);
    double wander = 0.0;
    double t = kFirstBeat_s;
    for (std::size_t i = 0; t < seconds; ++i) {
      song_.beats_s.push_back(t);
      double factor = 1.0;
      if (kind == 2) factor = 1.0 + wander;
      if (kind == 3)
        factor = 1.0 + 0.05 * std::sin(2.0 * std::numbers::pi * static_cast<double>(i) / 64.0);
      if (kind == 4) factor = i / 32 % 2 == 0 ? 1.0 : 1.2;
      wander = 0.97 * wander + 0.006 * random_.normal();
      t += 60.0 / (song_.tempo_bpm * std::min(factor, 218.0 / song_.tempo_bpm));
    }
  }

  // Bands of one style borrow from others, and play on what they have: a model that is taught so
  // knows more than the styles.
  const SongLayer& borrowed(const SongLayer& own) {
    std::vector<const SongLayer*> others;
    for (const SongStyle& style : song_styles())
      for (const SongLayer& layer : style.layers)
        if (layer.voice == own.voice && layer.drums.empty() == own.drums.empty())
          others.push_back(&layer);
    return *others[random_.below(others.size())];
  }

  void choose_layers() {
    const double borrows = is_mixed_ && random_.uniform() < 0.5 ? kBorrowed : 0.0;
    const auto borrows_now = [&] { return is_mixed_ && random_.uniform() < borrows; };
    for (const SongLayer& own : style_.layers) {
      const SongLayer& layer = borrows_now() ? borrowed(own) : own;
      const Instrument& instrument = instrument_of(layer.voice);
      const std::vector<int>& programs = !layer.programs.empty() ? layer.programs
                                         : is_kept_back_         ? instrument.kept_programs
                                                                 : instrument.programs;
      int& program = song_.programs[static_cast<std::size_t>(instrument.channel)];
      program = programs[random_.below(programs.size())];
      if (layer.voice != SongVoice::kDrums && borrows_now())
        program = static_cast<int>(random_.below(kPrograms));
      if (random_.uniform() >= own.chance) continue;
      PlayedLayer played{&layer, a_row_of(layer), {}, 0.0};
      if (!layer.drums.empty()) played.drums = layer.drums[random_.below(layer.drums.size())];
      if (!layer.drums.empty() && borrows_now())
        for (int& key : played.drums) key = kLowestDrum + static_cast<int>(random_.below(kDrums));
      played.loudness = layer.loudness * random_.uniform(0.65, 1.15);
      layers_.push_back(played);
    }
    has_drums_ = std::any_of(layers_.begin(), layers_.end(), [](const PlayedLayer& played) {
      return played.layer->voice == SongVoice::kDrums;
    });
    has_fills_ = random_.uniform() < 0.7 && has_drums_;
  }

  std::string a_row_of(const SongLayer& layer) {
    const bool keeps_back = is_kept_back_ && !layer.kept_rows.empty();
    const std::vector<std::string>& rows = keeps_back ? layer.kept_rows : layer.rows;
    const std::string& row = rows[random_.below(rows.size())];
    return is_kept_back_ ? row : varied(row, layer);
  }

  // As a band varies what it knows: strokes are left out and soft ones come in between, in some
  // songs more than in others. A model trained on these songs knows more than the rows.
  std::string varied(std::string row, const SongLayer& layer) {
    if (layer.voice == SongVoice::kPad && row.find_first_not_of("c.") == std::string::npos)
      return row;
    const bool has_chords = row.find('c') != std::string::npos;
    const char added = layer.voice == SongVoice::kDrums ? 'o' : has_chords ? 'c' : 'r';
    for (char& letter : row) {
      if (letter == '|') continue;
      if (letter == '.') {
        if (random_.uniform() < variety_ * kAdded) letter = added;
      } else if (random_.uniform() < variety_ * kLeftOut) {
        letter = '.';
      }
    }
    return row;
  }

  void begin_section() {
    for (PlayedLayer& played : layers_) {
      played.sounds = played.layer->chance >= 1.0 || random_.uniform() < 0.85;
      if (random_.uniform() < 0.25) played.row = a_row_of(*played.layer);
    }
    breaks_ = random_.uniform() < 0.08;
  }

  int root_of(std::size_t bar) const {
    return (key_ + progression_[bar / bars_a_chord_ % progression_.size()]) % 12;
  }
  const Chord& chord_of(std::size_t bar) const {
    const int degree = progression_[bar / bars_a_chord_ % progression_.size()];
    return is_minor_ && degree != 3 && degree != 8 && degree != 10 ? kMinor : kMajor;
  }

  double time_of(std::size_t bar, double beats) {
    const double whole = std::floor(beats);
    double part = beats - whole;
    part = part < 0.5 ? 2.0 * part * swing_ : swing_ + 2.0 * (part - 0.5) * (1.0 - swing_);
    const std::size_t i = bar * kBarBeats + static_cast<std::size_t>(whole);
    return song_.beats_s[i] + part * (song_.beats_s[i + 1] - song_.beats_s[i]);
  }

  void add(std::size_t bar, double beats, double length_beats, int channel, int key,
           double loudness) {
    const double beat_s = 60.0 / song_.tempo_bpm;
    song_.notes.push_back(
        {std::max(0.0, time_of(bar, beats) + jitter_s_ * random_.normal()), length_beats * beat_s,
         channel, std::clamp(key, 0, 127),
         std::clamp(static_cast<int>(std::lround(loudness + 6.0 * random_.normal())), 1, 127)});
  }
  void strike(std::size_t bar, double beats, int drum, double loudness) {
    add(bar, beats, 0.2, MadeSong::kDrumChannel, drum, loudness);
  }

  void play_fill(std::size_t bar) {
    constexpr std::array kFillDrums{38, 41, 43, 45, 47};
    const double step_beats = random_.below(2) == 0 ? 0.25 : 0.5;
    for (double at = 2.0; at < 4.0; at += step_beats)
      strike(bar, at, kFillDrums[random_.below(kFillDrums.size())], 98.0);
  }

  void play(const PlayedLayer& played, std::size_t bar) {
    const std::size_t row_bars = played.row.size() > kRowSteps ? 2 : 1;
    const std::string_view row =
        std::string_view(played.row).substr(bar % row_bars * (kRowSteps + 1), kRowSteps);
    for (std::size_t step = 0; step < row.size(); ++step)
      if (row[step] != '.') {
        if (played.layer->voice == SongVoice::kDrums)
          play_drum(played, bar, 0.25 * static_cast<double>(step), row[step]);
        else
          play_tone(played, bar, 0.25 * static_cast<double>(step), row[step]);
      }
  }

  void play_drum(const PlayedLayer& played, std::size_t bar, double beats, char letter) {
    constexpr std::string_view kLetters = "xyzXYZop";
    constexpr std::array kDrum{0, 1, 2, 0, 1, 2, 0, 0};
    constexpr std::array kFactor{1.0, 1.0, 1.0, 1.12, 1.12, 1.12, 0.65, 0.5};
    const std::size_t i = kLetters.find(letter);
    if (i == std::string_view::npos) return;  // a test reads every row
    strike(bar, beats, played.drums[static_cast<std::size_t>(kDrum[i])],
           played.loudness * kFactor[i]);
  }

  void play_tone(const PlayedLayer& played, std::size_t bar, double beats, char letter) {
    const SongLayer& layer = *played.layer;
    const Instrument& instrument = instrument_of(layer.voice);
    const auto above = [&](int tone) {
      return instrument.lowest + ((tone - instrument.lowest) % 12 + 12) % 12;
    };
    const int root = above(root_of(bar));
    const auto put = [&](int key) {
      add(bar, beats, layer.length_beats, instrument.channel, key, played.loudness);
    };
    const Chord& chord = chord_of(bar);
    if (letter == '1') put(root);
    if (letter == '3') put(root + chord[1]);
    if (letter == '5') put(root + chord[2]);
    if (letter == '8') put(root + 12);
    if (letter == 'n') put(above(root_of(bar + 1)));
    if (letter == 'r')
      put(root + chord[random_.below(chord.size())] + (random_.below(4) == 0 ? 12 : 0));
    if (letter != 'c') return;
    const Chord power{0, 7, 12};  // a third is mud when it is distorted
    for (const int tone : layer.voice == SongVoice::kDistorted ? power : chord) put(root + tone);
  }

  const SongStyle& style_;
  bool is_kept_back_;
  bool is_mixed_;
  Random random_;
  MadeSong song_;
  double swing_ = 0.5;
  double jitter_s_ = 0.0;
  double variety_ = 0.0;
  std::array<int, 4> progression_{};
  int key_ = 0;
  bool is_minor_ = false;
  std::size_t bars_a_chord_ = 1;
  std::vector<PlayedLayer> layers_;
  bool has_drums_ = false;
  bool has_fills_ = false;
  bool breaks_ = false;
};

}  // namespace

MadeSong make_song(const SongStyle& style, double seconds, std::uint64_t seed, SongUse use) {
  return SongMaker(style, seconds, seed, use).make();
}

}  // namespace dance
