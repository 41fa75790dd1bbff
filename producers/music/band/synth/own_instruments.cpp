#include "producers/music/band/synth/own_instruments.h"

#include <algorithm>
#include <cmath>
#include <map>
#include <numbers>
#include <vector>

#include "core/base/random.h"
#include "producers/music/band/synth/band_mix.h"

namespace dance {
namespace {

constexpr double kTau = 2.0 * std::numbers::pi;
// Salsa is about as loud as from a soundfont.
constexpr float kLoudness = 1.35f;

using Sound = std::vector<float>;

// f(seconds since the stroke), and a fade at the end.
template <class F>
Sound sound_of(double length_s, const F& f) {
  Sound sound(static_cast<std::size_t>(length_s * kBandRate_hz));
  for (std::size_t i = 0; i < sound.size(); ++i) {
    const double left = static_cast<double>(sound.size() - i) / (0.02 * kBandRate_hz);
    sound[i] = static_cast<float>(f(static_cast<double>(i) / kBandRate_hz) * std::min(1.0, left));
  }
  return sound;
}

class Noise {
 public:
  explicit Noise(std::uint64_t seed) : random_(seed) {}
  double white() { return random_.uniform(-1.0, 1.0); }
  // Without what is below the top two octaves.
  double bright() {
    const double now = white();
    const double difference = now - before_;
    before_ = now;
    return 0.6 * difference;
  }

 private:
  Random random_;
  double before_ = 0.0;
};

Sound claves() {
  return sound_of(0.09, [](double t) {
    return 0.55 * std::exp(-55.0 * t) * std::sin(kTau * 2500 * t) +
           0.12 * std::exp(-90.0 * t) * std::sin(kTau * 4100 * t);
  });
}

Sound cowbell() {
  return sound_of(0.3, [](double t) {
    const double tone = std::sin(kTau * 587 * t) + 0.9 * std::sin(kTau * 845 * t) +
                        0.45 * std::sin(kTau * 1760 * t) + 0.3 * std::sin(kTau * 2540 * t);
    return 0.28 * (0.35 * std::exp(-9.0 * t) + 0.65 * std::exp(-40.0 * t)) * tone;
  });
}

// A skin: its tone falls a bit after the stroke.
Sound skin(double hz, double decay_per_s, double bend) {
  return sound_of(4.5 / decay_per_s, [=](double t) {
    return 0.75 * std::exp(-decay_per_s * t) *
           std::sin(kTau * (hz * t + bend * (1.0 - std::exp(-30.0 * t))));
  });
}

Sound slap(double hz, double noise_part, double decay_per_s, std::uint64_t seed) {
  Noise noise(seed);
  return sound_of(5.0 / decay_per_s, [&](double t) {
    return 0.6 * std::exp(-decay_per_s * t) *
           (noise_part * noise.white() + std::sin(kTau * hz * t));
  });
}

Sound rattle(double length_s, double decay_per_s, std::uint64_t seed) {
  Noise noise(seed);
  return sound_of(length_s,
                  [&](double t) { return 0.45 * std::exp(-decay_per_s * t) * noise.bright(); });
}

// Ridges under a stick.
Sound scrape(double length_s, double ridges_hz, std::uint64_t seed) {
  Noise noise(seed);
  return sound_of(length_s, [&](double t) {
    const double ridge = std::fmod(t * ridges_hz, 1.0);
    const double shape = std::min(1.0, 0.4 + 30.0 * t) * (1.0 - t / length_s);
    return 0.5 * shape * std::exp(-5.0 * ridge) * noise.bright();
  });
}

Sound cymbal(double length_s, double decay_per_s, double ping, std::uint64_t seed) {
  Noise noise(seed);
  return sound_of(length_s, [&](double t) {
    return 0.3 * std::exp(-decay_per_s * t) * noise.bright() +
           ping * std::exp(-30.0 * t) * std::sin(kTau * 5200 * t);
  });
}

Sound snare() {
  Noise noise(11);
  return sound_of(0.25, [&](double t) {
    return 0.4 * std::exp(-22.0 * t) * noise.white() +
           0.4 * std::exp(-30.0 * t) * std::sin(kTau * 190 * t);
  });
}

// The key is that of General MIDI.
const std::map<int, Sound>& percussion_sounds() {
  static const std::map<int, Sound> kSounds{
      {36, skin(52.0, 14.0, 1.6)},
      {37, slap(1700.0, 0.4, 90.0, 3)},
      {38, snare()},
      {41, skin(92.0, 12.0, 1.0)},
      {43, skin(112.0, 13.0, 1.0)},
      {42, rattle(0.06, 70.0, 5)},
      {49, cymbal(1.2, 4.0, 0.0, 7)},
      {51, cymbal(0.5, 10.0, 0.12, 8)},
      {56, cowbell()},
      {60, skin(390.0, 26.0, 0.8)},
      {61, skin(270.0, 22.0, 0.8)},
      {62, slap(900.0, 0.8, 50.0, 4)},
      {63, skin(190.0, 18.0, 1.2)},
      {64, skin(130.0, 15.0, 1.2)},
      {65, skin(260.0, 16.0, 0.6)},
      {66, skin(185.0, 14.0, 0.6)},
      {70, rattle(0.07, 60.0, 9)},
      {73, scrape(0.08, 140.0, 10)},
      {74, scrape(0.24, 110.0, 12)},
      {75, claves()},
  };
  return kSounds;
}

// A string that is plucked: a burst of noise runs round in a delay and loses its edge.
Sound string_sound(int key) {
  const double hz = 440.0 * std::exp2((key - 69) / 12.0);
  const auto period = static_cast<std::size_t>(std::lround(kBandRate_hz / hz));
  std::vector<double> string(period);
  Noise noise(static_cast<std::uint64_t>(key));
  double smooth = 0.0;
  for (double& s : string) s = smooth += 0.12 * (noise.white() - smooth);
  std::size_t at = 0;
  double before = string.back();
  return sound_of(1.6, [&](double t) {
    const double out = string[at];
    string[at] = 0.9965 * (0.5 * out + 0.5 * before);
    before = out;
    at = (at + 1) % period;
    // The deep tone itself.
    return 1.3 * out + 0.55 * std::exp(-2.5 * t) * std::min(1.0, 400.0 * t) *
                           (std::sin(kTau * hz * t) + 0.35 * std::sin(2.0 * kTau * hz * t));
  });
}

// Each string of the bass is made when it is first played.
class BassStrings {
 public:
  const Sound& of(int key) {
    auto found = strings_.find(key);
    if (found == strings_.end()) found = strings_.emplace(key, string_sound(key)).first;
    return found->second;
  }

 private:
  std::map<int, Sound> strings_;
};

struct Playing {
  BandVoice voice;
  int key;
  const Sound* sound;
  std::size_t at;
  float left, right;
  float fading;  // 1, less once it has ended
  bool ended;
};

class OwnSynth : public BandSynth {
 public:
  explicit OwnSynth(BassStrings& strings) : strings_(strings) {}

  void begin_note(BandVoice voice, int key, int velocity) override {
    const Sound* const sound = find_sound(voice, key);
    if (sound == nullptr) return;
    if (!is_percussion(voice)) end_note(voice, key);
    const BandPlayer& player = player_of(voice);
    const float loud = kLoudness * static_cast<float>(velocity * velocity) / (127.0f * 127.0f) *
                       static_cast<float>(player.volume * player.volume) / (127.0f * 127.0f);
    const float right = static_cast<float>(player.pan) / 127.0f;
    playing_.push_back({voice, key, sound, 0, loud * (1.0f - right), loud * right, 1.0f, false});
  }

  void end_note(BandVoice voice, int key) override {
    if (is_percussion(voice)) return;  // rings on
    for (Playing& playing : playing_)
      if (playing.voice == voice && playing.key == key) playing.ended = true;
  }

  void render(BandBlock& block) override {
    block = BandBlock{};
    for (Playing& playing : playing_) add(playing, block);
    std::erase_if(playing_, [](const Playing& playing) {
      return playing.at >= playing.sound->size() || playing.fading < 1e-4f;
    });
  }

 private:
  const Sound* find_sound(BandVoice voice, int key) {
    if (voice == BandVoice::kBass || voice == BandVoice::kUprightBass) return &strings_.of(key);
    if (!is_percussion(voice)) return nullptr;
    const auto& sounds = percussion_sounds();
    const auto found = sounds.find(key);
    return found != sounds.end() ? &found->second : nullptr;
  }

  static void add(Playing& playing, BandBlock& block) {
    constexpr float kFade = 0.9985f;  // 14 ms to a third
    const std::size_t count = std::min(block.left.size(), playing.sound->size() - playing.at);
    for (std::size_t n = 0; n < count; ++n) {
      if (playing.ended) playing.fading *= kFade;
      const float s = playing.fading * (*playing.sound)[playing.at + n];
      block.left[n] += playing.left * s;
      block.right[n] += playing.right * s;
    }
    playing.at += count;
  }

  BassStrings& strings_;
  std::vector<Playing> playing_;
};

class OwnInstruments : public BandInstruments {
 public:
  std::unique_ptr<BandSynth> make_synth() override { return std::make_unique<OwnSynth>(strings_); }
  std::string name() const override { return "own percussion"; }

 private:
  BassStrings strings_;
};

}  // namespace

std::unique_ptr<BandInstruments> make_own_instruments() {
  return std::make_unique<OwnInstruments>();
}

}  // namespace dance
