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

#include "lobby/run/child_words.h"
#include "lobby/screen/lobby_model.h"

namespace dance {

class RoomHost {
 public:
  void open(LobbyModel& model);
  void close(LobbyModel& model);
  void invite(LobbyModel& model);
  void withdraw(LobbyModel& model);
  // Whose keys there are.
  void list(LobbyModel& model);

  // What has come from the programs; asks who is there where that is shown. True where the model
  // is another now.
  bool look(LobbyModel& model, MonoTime now, bool is_shown);
  bool is_running() const { return server_.has_value(); }

 private:
  using Done = std::function<void(LobbyModel&, ChildWords&)>;
  void run(LobbyModel& model, const std::string& program, std::vector<std::string> arguments,
           Done done);
  bool look_at_server(LobbyModel& model);

  std::optional<ChildWords> server_;
  std::optional<ChildWords> command_;  // one at a time
  Done done_;
  MonoTime asked_;
};

// Who is there by the JSON of `dance status`: "alice (salsa)". What is no such text is nobody.
struct ServerGuests {
  std::vector<std::string> guests;
  bool was_reached_from_elsewhere = false;
};
ServerGuests guests_of_status(const std::string& json);
// The names in what `dance server --list-keys` prints.
std::vector<std::string> names_of_keys(const std::string& list);

}  // namespace dance
