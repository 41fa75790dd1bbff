#include "viewer/window/window_input.h"

namespace dance {

void WindowInput::on_key(const KeyPress& press) {
  if (panels_.on_key(press)) return;
  if (const auto command = window_command(press)) obey(*command);
}

// Whatever is open and whichever modifier is held by now: nobody goes on to be heard.
void WindowInput::on_key_released(const KeyPress& press) {
  const auto command = window_command({press.key});
  if (command && command->action == WindowAction::kTalk) state_.voice.is_talk_held = false;
}

void WindowInput::on_drag(WindowDrag drag, float right, float up) {
  if (drag == WindowDrag::kOrbit)
    director_.drag_orbit(right, up);
  else
    director_.drag_pan(right, up);
}

void WindowInput::obey(const WindowCommand& command) {
  switch (command.action) {
    case WindowAction::kNone:
      return;
    case WindowAction::kNextView:
      return director_.show_next(command.step);
    case WindowAction::kShowView:
      return director_.show(command.view == director_.mode() ? ViewMode::kOrbit : command.view);
    case WindowAction::kChooseNumber:
      state_.chosen_number = command.step;
      return;
    case WindowAction::kNextGuest:
      state_.chosen_step += command.step;
      return;
    case WindowAction::kZoom:
      return director_.zoom(static_cast<float>(command.step));
    case WindowAction::kStartOver:
      return director_.start_over();
    case WindowAction::kRotate:
      return director_.toggle_turning();
    case WindowAction::kTrails:
      state_.shows_trails = !state_.shows_trails;
      return;
    case WindowAction::kTags:
      state_.shows_tags = !state_.shows_tags;
      return;
    case WindowAction::kPlace:
      state_.place = next_place(state_.place, command.step);
      ++state_.place_changes;
      return;
    case WindowAction::kHud:
      state_.shows_hud = !state_.shows_hud;
      return;
    case WindowAction::kFullScreen:
      ++state_.full_screen_presses;
      return;
    case WindowAction::kPicture:
      state_.dance.takes_picture = true;
      return;
    case WindowAction::kDisplayMode:
      state_.display = state_.display == DisplayMode::kTearFree ? DisplayMode::kLowLatency
                                                                : DisplayMode::kTearFree;
      return;
    case WindowAction::kExtrapolate:
      state_.extrapolates = !state_.extrapolates;
      return;
    case WindowAction::kTalk:
      state_.voice.is_talk_held = true;
      return;
    case WindowAction::kMute:
      ++state_.voice.mute_presses;
      return;
    case WindowAction::kDeafen:
      ++state_.voice.deafen_presses;
      return;
    case WindowAction::kClose:
      state_.is_over = true;
      return;
  }
}

}  // namespace dance
