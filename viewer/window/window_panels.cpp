#include "viewer/window/window_panels.h"

#include "viewer/window/help_panel.h"
#include "viewer/window/window_keys.h"

namespace dance {

void add_panels(const PanelNeeds& needs, PanelStack& panels) {
  panels.add(std::make_unique<InstrumentPanel>(needs.records));
  panels.add(std::make_unique<HelpPanel>(panels, window_key_groups()));
}

}  // namespace dance
