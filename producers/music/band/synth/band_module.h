// The module (core/program/program_module.h) libdance_band.so, through which the house band plays a
// soundfont with FluidSynth, which brings some 34 packages. Debian's dancegraph-band has it. Its
// function dance_band_module_1() returns a BandModule.
//
// Ownership:    the module stays loaded until the program ends.
// Threads:      any may call open_soundfont().
// Failure:      open_soundfont() names the file, or the missing module and its package.
#pragma once

#include <memory>
#include <string>

#include "core/base/result.h"
#include "producers/music/band/synth/band_synth.h"

namespace dance {

struct BandModule {
  Result<std::unique_ptr<BandInstruments>> (*open_soundfont)(const std::string& path);
};

Result<std::unique_ptr<BandInstruments>> open_soundfont(const std::string& path);
// True if the module is installed, without which open_soundfont() fails.
bool has_band_module();

// The module of another file than the program's own; for tests of damaged installations.
Result<const BandModule*> band_module_from(const std::string& path);

}  // namespace dance

extern "C" const void* dance_band_module_1(const char* interface_hash);
