#include "viewer/window/window_panels.h"

#include "viewer/instruments/instrument_panel.h"
#include "viewer/style_panel/style_panel.h"
#include "viewer/window/help_panel.h"
#include "viewer/window/window_keys.h"

namespace dance {

Result<void> add_panels(const PanelNeeds& needs, PanelStack& panels) {
  const ViewOptions& options = needs.options;
  auto instruments = std::make_unique<InstrumentPanel>(needs.records);
  instruments->open(options.panel == "instruments");
  if (options.focus) instruments->choose(*options.focus);
  panels.add(std::move(instruments));
  std::unique_ptr<SessionFile> file;
  if (!options.session.empty()) {
    DANCE_TRY(SessionFile opened, SessionFile::open(options.session));
    file = std::make_unique<SessionFile>(std::move(opened));
  }
  auto style = std::make_unique<StylePanel>(needs.records, needs.source.instruments(),
                                            std::move(file), options.log.empty());
  style->open(options.panel == "style");
  if (options.focus) style->choose(*options.focus);
  panels.add(std::move(style));
  ReplaySource* replay = needs.source.replay();
  if (replay != nullptr && (!options.headless || options.panel == "timeline"))
    panels.add(std::make_unique<TimelinePanel>(*replay, needs.exporting));
  auto help = std::make_unique<HelpPanel>(panels, window_key_groups(replay != nullptr));
  if (options.panel == "keys") help->open();
  panels.add(std::move(help));
  return {};
}

}  // namespace dance
