#include "producers/music/band/synth/band_mix.h"

#include <array>
#include <cstddef>

namespace dance {
namespace {

// In the order of BandVoice. Tuned with TimGM6mb.sf2, each player alone, by loudness and octaves
// against recorded salsa, merengue and swing.
constexpr std::array<BandPlayer, kBandVoices> kPlayers{{
    {0, 88, 80},    // clave
    {0, 100, 84},   // bell
    {0, 116, 44},   // congas
    {0, 110, 36},   // bongos
    {0, 100, 92},   // timbales
    {0, 112, 24},   // shaker
    {0, 98, 104},   // guiro
    {0, 118, 64},   // drums
    {33, 127, 64},  // bass
    {32, 127, 64},  // upright bass
    {0, 92, 52},    // piano
    {24, 84, 42},   // guitar
    {25, 90, 74},   // lead guitar
    {56, 90, 78},   // trumpet
    {57, 100, 50},  // trombone
    {66, 94, 72},   // sax
    {73, 80, 58},   // flute
    {71, 80, 60},   // clarinet
    {21, 76, 56},   // accordion
    {23, 88, 54},   // bandoneon
    {40, 74, 76},   // violin
    {48, 102, 64},  // strings
    {11, 72, 76},   // vibraphone
    {0, 86, 60},    // tambora
}};

}  // namespace

const BandPlayer& player_of(BandVoice voice) { return kPlayers[static_cast<std::size_t>(voice)]; }

}  // namespace dance
