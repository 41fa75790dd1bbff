// The styles of the house band: each writes all notes of a song.
#pragma once

#include "producers/music/band/compose/band_writer.h"

namespace dance {

void compose_salsa(BandWriter& writer);
void compose_bachata(BandWriter& writer);
void compose_cha_cha(BandWriter& writer);
void compose_merengue(BandWriter& writer);
void compose_cumbia(BandWriter& writer);
void compose_swing(BandWriter& writer);
void compose_tango(BandWriter& writer);
void compose_waltz(BandWriter& writer);

}  // namespace dance
