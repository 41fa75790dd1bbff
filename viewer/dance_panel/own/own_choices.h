// OwnChoices: what a person changes about a guest of this house during the dance, below that
// guest's line of the dance panel: the shown name, the figure, the voice and the place on the
// floor. The house applies each change and publishes it to the room.
//
// Units/frames: pixels; metres and radians in W.
// Ownership:    borrows what OwnNeeds names, which must outlive it; owns the desk of figures.
// Threads:      the drawing thread.
// Failure:      what cannot be sent or kept is in trouble().
#pragma once

#include <functional>
#include <map>
#include <string>
#include <vector>

#include "core/bus/state_messages.h"
#include "viewer/chat/line_editor.h"
#include "viewer/dance_panel/dance_records.h"
#include "viewer/dance_panel/own/figure_controller.h"
#include "viewer/dance_panel/panel_controls.h"
#include "viewer/words/texts.h"

namespace dance {

struct OwnNeeds {
  // Each one that is not set is not offered.
  std::function<void(const GuestId&, const ShownName&)> rename = {};
  std::function<Result<void>(const GuestId&, std::string_view name)> keep_name = {};
  FigureController::Needs figures = {};
  // A house of this user can turn the voice of that guest on and off.
  std::function<bool(const GuestId&)> has_voice_switch = {};
  std::function<Result<void>(const GuestId&, bool is_on)> switch_voice = {};
  std::function<Result<void>(const GuestId&, bool is_on)> keep_voice = {};
};

class OwnChoices {
 public:
  OwnChoices(OwnNeeds needs, Language language)
      : needs_(std::move(needs)), texts_(language), figures_(needs_.figures) {}

  // Once a picture.
  void work() { figures_.work(); }
  bool changes_figure() const { return figures_.is_busy(); }
  // Nothing is typed or listed any more.
  void close() { open_ = Open::kNone; }
  // While a line is typed all keys are its own.
  bool is_typed_in() const { return open_ == Open::kName || open_ == Open::kFile; }
  bool on_key(const KeyPress& press);
  bool on_character(char32_t character);
  // Below the guest's line. `name`: the name that is shown now, "" = the id.
  void draw(PanelControls& controls, const GuestId& guest, std::string_view name);
  // The guest whose voice this house can turn on and off; not set: none.
  const GuestId& voice_guest(const std::vector<DanceGuest>& guests, MonoTime now);
  void switch_voice(const GuestId& guest, bool is_on);
  // The height of what draw() made in the last picture.
  float height_px() const { return height_px_; }
  const std::string& trouble() const { return trouble_.empty() ? figures_.trouble() : trouble_; }

 private:
  enum class Open : std::uint8_t { kNone, kName, kFigures, kFile };

  void open(Open what, const GuestId& guest);
  void apply_line();
  void draw_line(PanelControls& controls);
  void draw_text() const;
  void draw_figures(PanelControls& controls, const GuestId& guest);

  OwnNeeds needs_;
  Texts texts_;
  FigureController figures_;
  Open open_ = Open::kNone;
  GuestId guest_;  // whose choices are open
  std::vector<NamedFigure> listed_;
  LineEditor editor_{kMostTyped, kMostTyped};
  std::string trouble_;
  float height_px_ = 0.0f;
  std::uint64_t looks_ = 0;  // that were drawn by chance
  GuestId voice_guest_;
  MonoTime voice_read_;  // when it was looked for

  static constexpr std::size_t kMostTyped = 1024;  // a path
};

}  // namespace dance
