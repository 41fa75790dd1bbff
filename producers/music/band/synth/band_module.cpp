#include "producers/music/band/synth/band_module.h"

#include <unistd.h>

#include <mutex>

#include "core/program/program_module.h"

namespace dance {
namespace {

#ifdef DANCE_HAVE_FLUIDSYNTH
constexpr const char* kBandCure =
    "install the package dancegraph-band (apt-get install ./dancegraph-band_*.deb)";
constexpr bool kOfThisBuild = true;
#else
constexpr const char* kBandCure =
    "this build was made without it; install libfluidsynth-dev and build again";
constexpr bool kOfThisBuild = false;
#endif

// A module that lies there in a build without FluidSynth was made by another build.
std::string band_module_path() { return kOfThisBuild ? module_path("libdance_band.so") : ""; }

Result<const BandModule*> own_module() {
  static std::mutex mutex;
  static const BandModule* loaded = nullptr;
  const std::lock_guard lock(mutex);
  if (loaded == nullptr) {
    DANCE_TRY(loaded, band_module_from(band_module_path()));
  }
  return loaded;
}

}  // namespace

bool has_band_module() { return ::access(band_module_path().c_str(), R_OK) == 0; }

Result<const BandModule*> band_module_from(const std::string& path) {
  DANCE_TRY(const void* const table,
            load_module(path, {"FluidSynth", "dancegraph-band", kBandCure, "dance_band_module_1",
                               DANCE_BAND_INTERFACE}));
  return static_cast<const BandModule*>(table);
}

Result<std::unique_ptr<BandInstruments>> open_soundfont(const std::string& path) {
  DANCE_TRY(const BandModule* const module, own_module());
  return module->open_soundfont(path);
}

}  // namespace dance
