// The window's screens, drawn with Dear ImGui from a LobbyModel: the user, with whom to dance, the
// user's own room, and the recordings. They change the model's settings and set its request; they
// do nothing else.
//
// Units/frames: pixels.
// Ownership:    refers to the model for the length of a call.
// Threads:      the drawing thread, within a frame of Dear ImGui.
// Failure:      none.
#pragma once

#include <initializer_list>

#include "lobby/screen/lobby_kit.h"
#include "lobby/screen/lobby_model.h"

namespace dance {

// All of the window: the list of screens, banners, the screen, its command line, what is open.
void draw_lobby(LobbyModel& model, LobbyKit& kit, float width_px, float height_px);

// Of draw_lobby(), one each.
void draw_you_screen(LobbyModel& model, LobbyKit& kit);
void draw_figure_card(LobbyModel& model, LobbyKit& kit);  // on the page You
void draw_dance_screen(LobbyModel& model, LobbyKit& kit);
void draw_host_screen(LobbyModel& model, LobbyKit& kit);
void draw_shelf_screen(LobbyModel& model, LobbyKit& kit);
void draw_file_chooser(LobbyModel& model, LobbyKit& kit);
// Draws "Show the command" once a page: the commands that do the same as its buttons.
struct CommandOf {
  Text button;
  LobbyWish wish;
};
void draw_commands(LobbyModel& model, LobbyKit& kit, std::initializer_list<CommandOf> commands);

}  // namespace dance
