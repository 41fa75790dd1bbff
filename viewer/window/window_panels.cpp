#include "viewer/window/window_panels.h"

#include <unistd.h>

#include <algorithm>
#include <chrono>
#include <cstdlib>

#include "core/control/role_control.h"
#include "core/control/voice_switch.h"
#include "core/program/program.h"
#include "producers/music/band/band_song.h"
#include "producers/music/control/music_control.h"
#include "viewer/chat/chat_panel.h"
#include "viewer/dance_panel/dance_panel.h"
#include "viewer/instruments/instrument_panel.h"
#include "viewer/practice/practice_panel.h"
#include "viewer/style_panel/style_panel.h"
#include "viewer/window/help_panel.h"
#include "viewer/window/own_figures.h"
#include "viewer/window/window_keys.h"
#include "voice/control/voice_control.h"

namespace dance {
namespace {

DanceRecording::Options recording_options(const ViewOptions& options) {
  return {program_folder() + "/dance-record",
          recordings_folder([](const char* name) { return std::getenv(name); }),
          options.feed.bus_url};
}

MusicDesk::Needs music_needs(const std::string& bus, std::shared_ptr<SessionFile> file) {
  MusicDesk::Needs needs;
  needs.plays_here = [bus] { return is_music_played(bus); };
  needs.tell = [bus](double volume) {
    MusicCommand command;
    command.volume = volume;
    return send_music_command(bus, command);
  };
  needs.send_speed = [bus](double speed) {
    MusicCommand command;
    command.what = MusicCommand::What::kSpeed;
    command.speed = speed;
    return send_music_command(bus, command);
  };
  needs.control_band = [bus](BandRequest request, int style) {
    using What = MusicCommand::What;
    constexpr What kCommands[] = {What::kNext,   What::kPlay,  What::kPause, What::kSlower,
                                  What::kFaster, What::kStyle, What::kLock,  What::kUnlock};
    MusicCommand command;
    command.what = kCommands[static_cast<std::size_t>(request)];
    if (request == BandRequest::kStyle &&
        !command.style.assign(name_of(static_cast<BandStyle>(style))))
      return Result<void>();
    return send_music_command(bus, command);
  };
  if (!file) return needs;
  needs.volume = file->music_volume();
  needs.keep = [file](double volume) { return file->save_music_volume(volume); };
  return needs;
}

OwnNeeds own_needs(DanceBoard& board, const std::string& bus, std::shared_ptr<SessionFile> file) {
  OwnNeeds own;
  own.rename = [&board](const GuestId& guest, const ShownName& name) { board.rename(guest, name); };
  const std::string program = program_folder() + "/dance-avatar";
  if (access(program.c_str(), X_OK) == 0) own.figures.program = program;
  own.figures.bus = bus;
  own.figures.list = [] { return figures_of(AvatarStore::of_user(), data_folder() + "/avatars"); };
  own.has_voice_switch = [bus](const GuestId& guest) { return has_voice_switch(bus, guest); };
  own.switch_voice = [bus](const GuestId& guest, bool is_on) {
    return send_voice_switch(bus, guest, is_on);
  };
  if (!file) return own;
  own.figures.current = [file](const GuestId& guest) { return file->figure(guest.view()); };
  // A guest who dances here instead of the file's is not kept.
  own.figures.keep = [file](const GuestId& guest, const OwnFigure& figure) {
    return file->hosts(guest.view()) ? file->save_figure(guest.view(), figure) : Result<void>();
  };
  own.keep_name = [file](const GuestId& guest, std::string_view name) {
    return file->hosts(guest.view()) ? file->save_shown_name(guest.view(), name) : Result<void>();
  };
  own.keep_voice = [file](const GuestId& guest, bool is_on) {
    return file->hosts(guest.view()) ? file->save_voice(is_on) : Result<void>();
  };
  return own;
}

// Adds the panel of a live house and returns it; a recording has none: nullptr.
DancePanel* add_dance_panel(const PanelNeeds& needs, const WindowPanel& at_right,
                            std::shared_ptr<SessionFile> file, PanelStack& panels) {
  DanceBoard* board = needs.source.dance();
  const ViewOptions& options = needs.options;
  // Of files only where it, or its keys, are asked for.
  const bool is_asked = options.panel == "dance" || options.panel == "keys";
  if (board == nullptr || (options.headless && !is_asked)) return nullptr;
  DanceNeeds dance{*board,
                   needs.records,
                   needs.wishes,
                   needs.drawing,
                   options.language,
                   recording_options(options),
                   {},
                   {},
                   music_needs(options.feed.bus_url, file)};
  dance.own = own_needs(*board, options.feed.bus_url, std::move(file));
  dance.send_voice_command = [bus = options.feed.bus_url](const GuestId& guest,
                                                          std::string_view command) {
    return send_voice_command(bus, guest, command);
  };
  dance.has_role = [bus = options.feed.bus_url](const GuestId& guest) {
    return has_role_control(bus, guest);
  };
  dance.send_role = [bus = options.feed.bus_url](const GuestId& guest, std::string_view role) {
    return send_role(bus, guest, dance_role_of(role).value_or(DanceRole::kEither));
  };
  dance.wall = [] {
    return Duration::us(std::chrono::duration_cast<std::chrono::microseconds>(
                            std::chrono::system_clock::now().time_since_epoch())
                            .count());
  };
  auto panel = std::make_unique<DancePanel>(std::move(dance));
  panel->yield_to(at_right);
  panel->open(options.panel == "dance");
  DancePanel* const added = panel.get();
  panels.add(std::move(panel));
  return added;
}

// The guest of this house in whose name this window sends chat: the one in focus, else the first.
std::optional<GuestId> writer_of(const DanceRecords& records, const std::optional<GuestId>& focus) {
  std::optional<GuestId> writer;
  for (const DanceGuest& guest : records.guests())
    if (!guest.is_remote && (!writer || guest.id == focus)) writer = guest.id;
  return writer;
}

// The chat of a recording can be read, but nothing can be sent.
void add_chat_panel(const PanelNeeds& needs, DancePanel* dance, PanelStack& panels) {
  ChatNeeds chat;
  chat.language = needs.options.language;
  chat.bottom_px = [&panels](const PanelFrame& frame) { return panels.bottom_px(frame); };
  if (dance != nullptr) {
    chat.writer = [dance, focus = needs.options.focus] {
      return writer_of(dance->records(), focus);
    };
    chat.send = [board = needs.source.dance()](const GuestId& guest, ChatKind kind,
                                               std::string_view text) {
      Chat written;
      written.kind = kind;
      if (written.text.assign(text)) board->write(guest, written);
    };
    chat.is_hidden = [dance, &hidden = needs.wishes.hidden](const GuestId& guest) {
      return dance->records().is_voice_muted(guest) ||
             std::ranges::find(hidden, guest) != hidden.end();
    };
  }
  panels.add(std::make_unique<ChatPanel>(std::move(chat)));
}

// The steps are of a live house; a recording has none.
void add_practice_panel(const PanelNeeds& needs, PanelStack& panels) {
  StepScoreBoard* scores = needs.source.step_scores();
  if (scores == nullptr) return;
  PracticeNeeds practice;
  practice.score = [scores, pupil = needs.options.pupil](MonoTime now) {
    const auto found = scores->find(pupil, now);
    return found ? std::optional(found->figures) : std::nullopt;
  };
  practice.teacher = needs.teacher;
  practice.teacher_note = needs.teacher_note;
  auto panel = std::make_unique<PracticePanel>(std::move(practice));
  panel->open(needs.options.panel == "practice" || needs.teacher != nullptr);
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
  DancePanel* const dance = add_dance_panel(needs, at_right, file, panels);
  add_practice_panel(needs, panels);
  if (!options.headless) add_chat_panel(needs, dance, panels);
  auto help = std::make_unique<HelpPanel>(panels, window_key_groups(replay != nullptr));
  if (options.panel == "keys") help->open();
  panels.add(std::move(help));
  return {};
}

}  // namespace dance
