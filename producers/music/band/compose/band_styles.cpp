#include "producers/music/band/compose/band_styles.h"

namespace dance {

std::vector<BandSheetNote> compose(BandWriter& writer) {
  switch (writer.style()) {
    case BandStyle::kSalsa:
      compose_salsa(writer);
      break;
    case BandStyle::kBachata:
      compose_bachata(writer);
      break;
    case BandStyle::kChaCha:
      compose_cha_cha(writer);
      break;
    case BandStyle::kMerengue:
      compose_merengue(writer);
      break;
    case BandStyle::kCumbia:
      compose_cumbia(writer);
      break;
    case BandStyle::kSwing:
      compose_swing(writer);
      break;
    case BandStyle::kTango:
      compose_tango(writer);
      break;
    case BandStyle::kWaltz:
      compose_waltz(writer);
      break;
  }
  return writer.take_sheet();
}

}  // namespace dance
