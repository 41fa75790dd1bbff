// The instruments of the house band, its own and those of FluidSynth: strokes sound at once. And
// errors of a missing or damaged module.
#include <gtest/gtest.h>
#include <unistd.h>

#include <cmath>
#include <filesystem>
#include <fstream>
#include <set>

#include "producers/music/band/band_audio.h"
#include "producers/music/band/synth/band_module.h"
#include "producers/music/band/synth/own_instruments.h"
#include "tests/test_folder.h"

namespace dance {
namespace {

constexpr double kMostDelay_s = 0.002;

std::set<std::pair<BandVoice, int>> all_strokes() {
  std::set<std::pair<BandVoice, int>> strokes;
  for (int style = 0; style < kBandStyles; ++style) {
    const auto song = static_cast<BandStyle>(style);
    const BandScore score = BandScore::make(band_song(song, 3, usual_tempo_bpm(song)));
    for (const BandSection& section : score.sections())
      for (const BandNote& note : section.notes)
        if (is_percussion(note.voice)) strokes.insert({note.voice, note.key});
  }
  return strokes;
}

std::vector<float> render(BandSynth& synth, int blocks) {
  std::vector<float> samples;
  for (int i = 0; i < blocks; ++i) {
    BandBlock block;
    synth.render(block);
    for (std::size_t n = 0; n < block.left.size(); ++n)
      samples.push_back(block.left[n] + block.right[n]);
  }
  return samples;
}

// When a stroke reaches a tenth of its peak.
double delay_s(const std::vector<float>& samples) {
  float peak = 0.0f;
  for (const float s : samples) peak = std::max(peak, std::abs(s));
  for (std::size_t n = 0; n < samples.size(); ++n)
    if (peak > 0.0f && std::abs(samples[n]) >= 0.1f * peak)
      return static_cast<double>(n) / kBandRate_hz;
  return 1.0;
}

std::unique_ptr<BandInstruments> fluid_instruments() {
  const std::string soundfont = best_band_sound().soundfont;
  if (soundfont.empty()) return nullptr;
  auto instruments = open_soundfont(soundfont);
  EXPECT_TRUE(instruments) << (instruments ? "" : instruments.error().what);
  return instruments ? std::move(*instruments) : nullptr;
}

TEST(OwnInstruments, SoundWithinTwoMillisecondsOfEachStroke) {
  const auto instruments = make_own_instruments();
  for (const auto& [voice, key] : all_strokes()) {
    const auto synth = instruments->make_synth();
    synth->begin_note(voice, key, 100);
    EXPECT_LE(delay_s(render(*synth, 30)), kMostDelay_s) << key;
  }
}

TEST(FluidInstruments, SoundWithinTwoMillisecondsOfEachStroke) {
  const auto instruments = fluid_instruments();
  if (instruments == nullptr) GTEST_SKIP() << "no FluidSynth or no soundfont here";
  for (const auto& [voice, key] : all_strokes()) {
    const auto synth = instruments->make_synth();
    synth->begin_note(voice, key, 100);
    EXPECT_LE(delay_s(render(*synth, 30)), kMostDelay_s) << key;
  }
}

TEST(FluidInstruments, RenderASongTheSameAfterAJumpAndBelowTheCeiling) {
  const BandSound sound = best_band_sound();
  if (sound.soundfont.empty()) GTEST_SKIP() << "no FluidSynth or no soundfont here";
  const auto score =
      std::make_shared<const BandScore>(BandScore::make(band_song(BandStyle::kMerengue, 2, 136)));
  const auto in_a_row = BandAudio::make(score, sound);
  const auto after_jump = BandAudio::make(score, sound);
  ASSERT_TRUE(in_a_row && after_jump);
  const std::int64_t begin = score->sections()[10].begin_frame;
  std::vector<float> all(2 * 200000), part(2 * 50000);
  (*in_a_row)->read_stereo(begin - 100000, all);
  (*after_jump)->read_stereo(begin + 50000, part);
  EXPECT_TRUE(std::equal(part.begin(), part.end(), all.begin() + 2 * 150000));
  float peak = 0.0f;
  for (const float s : all) peak = std::max(peak, std::abs(s));
  EXPECT_GT(peak, 0.3f);
  EXPECT_LT(peak, 0.89f);
}

TEST(BandModule, IsRefusedIfMissingOrDamaged) {
  const auto missing = band_module_from("/no/such/libdance_band.so");
  ASSERT_FALSE(missing);
  EXPECT_NE(missing.error().what.find("FluidSynth is needed"), std::string::npos);
  const TestFolder folder("band");
  const std::string path = folder.path("libdance_band.so");
  std::ofstream(path) << "no shared object";
  const auto damaged = band_module_from(path);
  ASSERT_FALSE(damaged);
  EXPECT_NE(damaged.error().what.find("cannot be loaded"), std::string::npos);
}

TEST(BandAudio, NamesASoundfontThatCannotBeRead) {
  const auto score =
      std::make_shared<const BandScore>(BandScore::make(band_song(BandStyle::kSalsa, 1, 180)));
  const TestFolder folder("band");
  const std::string path = folder.path("broken.sf2");
  std::ofstream(path) << "RIFF and nothing else";
  const auto audio = BandAudio::make(score, {path});
  ASSERT_FALSE(audio);
  if (has_band_module()) {
    EXPECT_NE(audio.error().what.find(path), std::string::npos) << audio.error().what;
  }
}

}  // namespace
}  // namespace dance
