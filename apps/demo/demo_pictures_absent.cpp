// For builds without the viewer.
#include "apps/demo/demo_pictures.h"

namespace dance {

Result<DemoPictures> draw_comparison(const DemoOptions&, const DemoPlan&, const DemoTrace&,
                                     const DemoRhythm&) {
  return DemoPictures();
}

}  // namespace dance
