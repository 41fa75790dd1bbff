// The house band's instruments from a soundfont, through FluidSynth, without its effects: the band
// has a hall of its own, which ends with the section. A new synth takes 0.2 ms. The soundfont is
// read once, and all synths share it.
#include <fluidsynth.h>
#include <unistd.h>

#include <cstring>
#include <filesystem>

#include "producers/music/band/synth/band_mix.h"
#include "producers/music/band/synth/band_module.h"

namespace dance {
namespace {

struct FluidDelete {
  void operator()(fluid_settings_t* settings) const { delete_fluid_settings(settings); }
  void operator()(fluid_synth_t* synth) const { delete_fluid_synth(synth); }
};
using FluidSettings = std::unique_ptr<fluid_settings_t, FluidDelete>;
using FluidHandle = std::unique_ptr<fluid_synth_t, FluidDelete>;

// The band has a channel for each of its players.
constexpr int kFluidChannels = 32;
static_assert(kBandVoices <= kFluidChannels);

FluidSettings make_settings() {
  FluidSettings settings(new_fluid_settings());
  fluid_settings_t* const s = settings.get();
  fluid_settings_setnum(s, "synth.sample-rate", kBandRate_hz);
  fluid_settings_setnum(s, "synth.gain", 0.9);
  fluid_settings_setint(s, "synth.midi-channels", kFluidChannels);
  fluid_settings_setint(s, "synth.polyphony", 160);
  fluid_settings_setint(s, "synth.cpu-cores", 1);
  fluid_settings_setint(s, "synth.reverb.active", 0);
  fluid_settings_setint(s, "synth.chorus.active", 0);
  fluid_settings_setint(s, "synth.min-note-length", 0);
  fluid_settings_setint(s, "synth.threadsafe-api", 0);
  fluid_settings_setint(s, "synth.lock-memory", 0);
  return settings;
}

class FluidSynth : public BandSynth {
 public:
  FluidSynth(fluid_settings_t* settings, fluid_sfont_t* soundfont)
      : soundfont_(soundfont), synth_(new_fluid_synth(settings)) {
    fluid_synth_add_sfont(synth_.get(), soundfont_);
    seat_players();
  }
  ~FluidSynth() override {
    // The soundfont is another synth's to delete.
    fluid_synth_all_sounds_off(synth_.get(), -1);
    fluid_synth_remove_sfont(synth_.get(), soundfont_);
  }
  FluidSynth(const FluidSynth&) = delete;
  FluidSynth& operator=(const FluidSynth&) = delete;

  void begin_note(BandVoice voice, int key, int velocity) override {
    fluid_synth_noteon(synth_.get(), static_cast<int>(voice), key, velocity);
  }
  void end_note(BandVoice voice, int key) override {
    // Strokes ring on.
    if (!is_percussion(voice)) fluid_synth_noteoff(synth_.get(), static_cast<int>(voice), key);
  }
  void render(BandBlock& block) override {
    fluid_synth_write_float(synth_.get(), kBandBlock_frames, block.left.data(), 0, 1,
                            block.right.data(), 0, 1);
  }

 private:
  void seat_players() {
    constexpr int kDrumBank = 128;
    for (int i = 0; i < kBandVoices; ++i) {
      const auto voice = static_cast<BandVoice>(i);
      const BandPlayer& player = player_of(voice);
      const bool drums = is_percussion(voice);
      fluid_synth_set_channel_type(synth_.get(), i,
                                   drums ? CHANNEL_TYPE_DRUM : CHANNEL_TYPE_MELODIC);
      fluid_synth_program_select(synth_.get(), i, fluid_sfont_get_id(soundfont_),
                                 drums ? kDrumBank : 0, player.program);
      fluid_synth_cc(synth_.get(), i, 7, player.volume);
      fluid_synth_cc(synth_.get(), i, 10, player.pan);
    }
  }

  fluid_sfont_t* soundfont_;
  FluidHandle synth_;
};

class FluidInstruments : public BandInstruments {
 public:
  FluidInstruments(FluidSettings settings, FluidHandle reader, fluid_sfont_t* soundfont,
                   std::string file)
      : settings_(std::move(settings)),
        reader_(std::move(reader)),
        soundfont_(soundfont),
        file_(std::move(file)) {}

  std::unique_ptr<BandSynth> make_synth() override {
    return std::make_unique<FluidSynth>(settings_.get(), soundfont_);
  }
  std::string name() const override { return "FluidSynth, " + file_; }

 private:
  FluidSettings settings_;
  FluidHandle reader_;  // owns the soundfont
  fluid_sfont_t* soundfont_;
  std::string file_;
};

Result<std::unique_ptr<BandInstruments>> open_fluid_instruments(const std::string& path) {
  // FluidSynth prints nothing: the returned error names the failure.
  for (const int level : {FLUID_PANIC, FLUID_ERR, FLUID_WARN, FLUID_INFO, FLUID_DBG})
    fluid_set_log_function(level, nullptr, nullptr);
  if (::access(path.c_str(), R_OK) != 0)
    return fail(path + ": no soundfont can be read there; install timgm6mb-soundfont");
  FluidSettings settings = make_settings();
  FluidHandle reader(new_fluid_synth(settings.get()));
  if (reader == nullptr) return fail("FluidSynth does not start");
  const int id = fluid_synth_sfload(reader.get(), path.c_str(), 0);
  fluid_sfont_t* const soundfont =
      id == FLUID_FAILED ? nullptr : fluid_synth_get_sfont_by_id(reader.get(), id);
  if (soundfont == nullptr) return fail(path + ": FluidSynth cannot read this soundfont");
  return std::make_unique<FluidInstruments>(std::move(settings), std::move(reader), soundfont,
                                            std::filesystem::path(path).filename().string());
}

}  // namespace
}  // namespace dance

// The one function that the band's module exports.
extern "C" __attribute__((visibility("default"))) const void* dance_band_module_1(
    const char* interface_hash) {
  static constexpr dance::BandModule kModule{&dance::open_fluid_instruments};
  return std::strcmp(interface_hash, DANCE_BAND_INTERFACE) == 0 ? &kModule : nullptr;
}
