// The band's own sounds, made by rule: claves, cowbell, congas, bongos, timbales, maracas, guiro,
// drums, and a plucked bass. They need no file. Players of other instruments are silent.
#pragma once

#include "producers/music/band/synth/band_synth.h"

namespace dance {

std::unique_ptr<BandInstruments> make_own_instruments();

}  // namespace dance
