#include "viewer/window/window_panels.h"

#include <chrono>
#include <cstdlib>
#include <filesystem>

#include "core/program/program.h"
#include "producers/music/control/music_control.h"
#include "viewer/dance_panel/dance_panel.h"
#include "viewer/instruments/instrument_panel.h"
#include "viewer/style_panel/style_panel.h"
#include "viewer/window/help_panel.h"
#include "viewer/window/window_keys.h"
#include "voice/control/voice_control.h"

namespace dance {
namespace {

DanceRecording::Options recording_options(const ViewOptions& options) {
  const auto is_folder = [](const std::string& path) {
    std::error_code ignored;
    return std::filesystem::is_directory(path, ignored);
  };
  return {program_folder() + "/dance-record",
          recordings_folder([](const char* name) { return std::getenv(name); }, is_folder),
          options.feed.bus_url};
}

MusicDesk::Needs music_needs(const std::string& bus, std::shared_ptr<SessionFile> file) {
  MusicDesk::Needs needs;
  needs.plays_here = [bus] { return is_music_played(bus); };
  needs.tell = [bus](double volume) { return tell_music_volume(bus, volume); };
  if (!file) return needs;
  needs.volume = file->music_volume();
  needs.keep = [file](double volume) { return file->save_music_volume(volume); };
  return needs;
}

// Of a live house: a recorded dance is over.
void add_dance_panel(const PanelNeeds& needs, const WindowPanel& at_right,
                     std::shared_ptr<SessionFile> file, PanelStack& panels) {
  DanceBoard* board = needs.source.dance();
  const ViewOptions& options = needs.options;
  // Of files only where it, or its keys, are asked for.
  const bool is_asked = options.panel == "dance" || options.panel == "keys";
  if (board == nullptr || (options.headless && !is_asked)) return;
  DanceNeeds dance{*board,
                   needs.records,
                   needs.wishes,
                   needs.drawing,
                   options.language,
                   recording_options(options),
                   {},
                   {},
                   music_needs(options.feed.bus_url, std::move(file))};
  dance.tell_voice = [bus = options.feed.bus_url](const GuestId& guest, std::string_view command) {
    return tell_voice(bus, guest, command);
  };
  dance.wall = [] {
    return Duration::us(std::chrono::duration_cast<std::chrono::microseconds>(
                            std::chrono::system_clock::now().time_since_epoch())
                            .count());
  };
  auto panel = std::make_unique<DancePanel>(std::move(dance));
  panel->yield_to(at_right);
  panel->open(options.panel == "dance");
  panels.add(std::move(panel));
}

}  // namespace

Result<void> add_panels(const PanelNeeds& needs, PanelStack& panels) {
  const ViewOptions& options = needs.options;
  auto instruments = std::make_unique<InstrumentPanel>(needs.records);
  instruments->open(options.panel == "instruments");
  if (options.focus) instruments->choose(*options.focus);
  panels.add(std::move(instruments));
  std::shared_ptr<SessionFile> file;
  if (!options.session.empty()) {
    DANCE_TRY(SessionFile opened, SessionFile::open(options.session));
    file = std::make_shared<SessionFile>(std::move(opened));
  }
  auto style = std::make_unique<StylePanel>(needs.records, needs.source.instruments(), file,
                                            options.log.empty());
  style->open(options.panel == "style");
  if (options.focus) style->choose(*options.focus);
  const StylePanel& at_right = *style;
  panels.add(std::move(style));
  ReplaySource* replay = needs.source.replay();
  if (replay != nullptr && (!options.headless || options.panel == "timeline"))
    panels.add(std::make_unique<TimelinePanel>(*replay, needs.exporting));
  add_dance_panel(needs, at_right, file, panels);
  auto help = std::make_unique<HelpPanel>(panels, window_key_groups(replay != nullptr));
  if (options.panel == "keys") help->open();
  panels.add(std::move(help));
  return {};
}

}  // namespace dance
