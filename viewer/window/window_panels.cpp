#include "viewer/window/window_panels.h"

#include "viewer/window/help_panel.h"
#include "viewer/window/window_keys.h"

namespace dance {

void add_panels(const PanelNeeds& needs, PanelStack& panels) {
  const ViewOptions& options = needs.options;
  auto instruments = std::make_unique<InstrumentPanel>(needs.records);
  instruments->open(options.panel == "instruments");
  if (options.focus) instruments->choose(*options.focus);
  panels.add(std::move(instruments));
  auto help = std::make_unique<HelpPanel>(panels, window_key_groups());
  if (options.panel == "keys") help->open();
  panels.add(std::move(help));
}

}  // namespace dance
