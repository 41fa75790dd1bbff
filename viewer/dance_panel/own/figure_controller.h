// FigureController: changes the figure of a guest of this house during the dance, by `dance avatar
// choose`: the file is read and checked in that program, and no picture waits for it. The house
// takes the choice over its socket and publishes it to the room. The house file keeps it.
//
// Ownership: owns the program, which ends with it.
// Threads:   the drawing thread; nothing waits but the destructor, for a second at most.
// Failure:   trouble() says in one printable line why the figure stays as it is, or is not kept.
#pragma once

#include <functional>
#include <optional>
#include <string>
#include <vector>

#include "core/base/guest_id.h"
#include "core/base/result.h"
#include "core/program/child_pipe.h"
#include "core/program/child_process.h"
#include "formats/session/own_edit.h"

namespace dance {

// A figure to choose from.
struct NamedFigure {
  std::string what;  // as OwnFigure has it
  std::string name;  // "" = a stored file whose name is not known
};

class FigureController {
 public:
  struct Needs {
    std::string program;  // of dance-avatar; "" = figures cannot be changed
    std::string bus;      // "" = the usual one
    // Avatars of this machine beside the mannequin; called when a person opens the list.
    std::function<std::vector<NamedFigure>()> list = {};
    // The guest's figure in the house file; not set: without a file.
    std::function<OwnFigure(const GuestId&)> current = {};
    std::function<Result<void>(const GuestId&, const OwnFigure&)> keep = {};
  };

  explicit FigureController(Needs needs) : needs_(std::move(needs)) {}

  bool is_there() const { return !needs_.program.empty(); }
  std::vector<NamedFigure> list() const;
  // The figure's height stays. Of choices made while one is under way the last counts.
  void choose(const GuestId& guest, OwnFigure figure);
  // A mannequin with other clothes, hair and skin, drawn from `seed`.
  void choose_any_look(const GuestId& guest, std::uint64_t seed);
  // Once a picture.
  void work();
  bool is_busy() const { return program_.has_value(); }
  const std::string& trouble() const { return trouble_; }

 private:
  struct Choice {
    GuestId guest;
    OwnFigure figure;
  };
  void start(Choice choice);
  void read_words();

  Needs needs_;
  ChildPipe said_;  // outlives the program, which may write at its end
  std::optional<ChildProcess> program_;
  std::string words_;  // the program's last ones
  Choice under_way_;
  std::optional<Choice> next_;
  std::string trouble_;
};

}  // namespace dance
