// RoomHost: a server that the window runs, its keys, and who is there: `dance server` and
// `dance status` as programs of their own.
//
// Units/frames: none.
// Ownership:    owns the programs; the server ends with it.
// Threads:      the drawing thread; nothing waits.
// Failure:      becomes a banner of the model.
#pragma once

#include <functional>
#include <optional>
#include <string>

#include "lobby/invite/router_port.h"
#include "lobby/run/child_words.h"
#include "lobby/screen/lobby_model.h"

namespace dance {

class RoomHost {
 public:
  RoomHost() = default;
  ~RoomHost() {
    if (router_) router_->close();
  }
  RoomHost(const RoomHost&) = delete;
  RoomHost& operator=(const RoomHost&) = delete;

  void open(LobbyModel& model);
  void close(LobbyModel& model);
  void invite(LobbyModel& model);
  void withdraw(LobbyModel& model);
  // Asks the router to forward the room's port to this computer until the room is closed.
  void ask_router(LobbyModel& model, MonoTime now);
  // Copies the last invitation to the clipboard as a message; writes it as a page beside the
  // recordings; opens that folder in the file manager.
  void copy_message(LobbyModel& model);
  void save_page(LobbyModel& model);
  void open_page_folder(LobbyModel& model);
  // Requests the list of guests that have a key.
  void list(LobbyModel& model);

  // Reads the programs' output; requests the list of guests while it is shown. True if the model
  // changed.
  bool look(LobbyModel& model, MonoTime now, bool is_shown);
  bool is_running() const { return server_.has_value(); }

 private:
  using Done = std::function<void(LobbyModel&, ChildWords&)>;
  void run(LobbyModel& model, const std::string& program, std::vector<std::string> arguments,
           Done done);
  bool look_at_server(LobbyModel& model);
  bool look_at_router(LobbyModel& model, MonoTime now);

  std::optional<ChildWords> server_;
  std::optional<ChildWords> command_;  // one at a time
  Done done_;
  std::optional<ChildProcess> opener_;
  std::optional<RouterPort> router_;
  MonoTime asked_;
};

// Who is there by the JSON of `dance status`: "alice (salsa)". What is no such text is nobody.
struct ServerGuests {
  std::vector<std::string> guests;
  bool was_reached_from_elsewhere = false;
};
ServerGuests guests_of_status(const std::string& json);
// Parses the output of `dance server --list-keys`.
std::vector<InvitedGuest> invited_guests(const std::string& list);

}  // namespace dance
