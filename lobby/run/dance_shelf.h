// DanceShelf: lists the recordings of this machine, shows one in a window of its own, writes videos
// and motion files of it, renames and deletes it.
//
// Ownership: owns the programs; they end with it, and an unfinished file is removed.
// Threads:   the drawing thread; poll() reads a few recordings at most.
// Failure:   becomes a banner of the model.
#pragma once

#include <deque>
#include <optional>
#include <set>
#include <string>
#include <vector>

#include "lobby/run/child_words.h"
#include "lobby/screen/lobby_model.h"

namespace dance {

class DanceShelf {
 public:
  // The folder of new recordings comes first.
  explicit DanceShelf(std::vector<std::string> folders) : folders_(std::move(folders)) {}

  void list(LobbyModel& model);
  // Notes the recordings before a dance; after it, the window offers to show a new one.
  void note_dance_begins();
  void note_dance_ends(LobbyModel& model);

  // Applies a request about recordings; ignores others.
  void apply(LobbyModel& model, LobbyWish wish);
  // Reads what the programs have written. True if the model changed.
  bool poll(LobbyModel& model);
  // True while an export runs or recordings are still to be read.
  bool is_busy() const { return export_ || has_unread_; }

 private:
  struct Job {
    std::string program;
    std::vector<std::string> arguments;
    std::string file;
  };
  void watch(LobbyModel& model);
  void make_video(LobbyModel& model);
  void export_as(LobbyModel& model, const std::string& ending);
  void cancel_export(LobbyModel& model);
  void rename(LobbyModel& model);
  void erase(LobbyModel& model);
  void open_folder(LobbyModel& model);
  void start_next(LobbyModel& model);
  void read_some(LobbyModel& model);
  bool poll_export(LobbyModel& model);
  bool poll_viewer(LobbyModel& model);
  std::string folder_of(const LobbyModel& model) const;

  std::vector<std::string> folders_;
  std::set<std::string> known_before_;  // recordings when the dance began
  bool has_unread_ = false;
  std::optional<ChildWords> export_;
  std::deque<Job> jobs_;  // the first one runs
  std::optional<ChildWords> viewer_;
  std::optional<ChildProcess> opener_;
};

// "writing: 45 %" → 45; -1 for other lines.
int percent_in(std::string_view line);

}  // namespace dance
