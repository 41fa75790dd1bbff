#include "viewer/dance_panel/own/figure_controller.h"

#include <fmt/format.h>

#include <array>
#include <utility>

#include "core/base/plain_number.h"
#include "core/base/printable.h"
#include "core/program/talk.h"
#include "formats/body/look_names.h"
#include "formats/body/random_look.h"

namespace dance {
namespace {

constexpr std::size_t kMostSaid = 2048;
constexpr std::size_t kMostShown = 200;

// Without line break and time.
std::string newest_line(std::string_view said) {
  while (!said.empty() && (said.back() == '\n' || said.back() == '\r')) said.remove_suffix(1);
  const std::size_t before = said.rfind('\n');
  if (before != std::string_view::npos) said.remove_prefix(before + 1);
  return std::string(talk::without_time(said));
}

}  // namespace

std::vector<NamedFigure> FigureController::list() const {
  return needs_.list ? needs_.list() : std::vector<NamedFigure>();
}

void FigureController::choose(const GuestId& guest, OwnFigure figure) {
  if (needs_.current) figure.height = needs_.current(guest).height;
  trouble_.clear();
  if (program_)
    next_ = Choice{guest, std::move(figure)};
  else
    start({guest, std::move(figure)});
}

void FigureController::choose_any_look(const GuestId& guest, std::uint64_t seed) {
  const RandomLook random = random_look(look_of(guest), seed);
  OwnFigure figure;
  figure.look = name_of_look(random.look);
  figure.colour = fmt::format("#{:06x}", random.top);
  choose(guest, std::move(figure));
}

void FigureController::start(Choice choice) {
  const OwnFigure& figure = choice.figure;
  words_.clear();
  auto pipe = ChildPipe::open();
  if (!pipe) {
    trouble_ = pipe.error().what;
    return;
  }
  const std::string what = figure.what.empty() ? std::string(kMannequinName) : figure.what;
  ChildProcess::Options how{
      needs_.program, {"choose", std::string(choice.guest.view()), what}, "/dev/null", ""};
  const auto add = [&](const char* option, const std::string& value) {
    how.arguments.push_back(std::string(option) + "=" + value);
  };
  if (!figure.look.empty()) add("--look", figure.look);
  if (!figure.colour.empty()) add("--colour", figure.colour);
  if (figure.height != 1.0) add("--height", plain_number(figure.height));
  if (!needs_.bus.empty()) add("--bus", needs_.bus);
  how.talk_fd = pipe->child_fd();
  auto program = ChildProcess::start(how);
  if (!program) {
    trouble_ = printable(program.error().what);
    return;
  }
  pipe->let_go();
  said_ = std::move(*pipe);
  program_.emplace(std::move(*program));
  under_way_ = std::move(choice);
}

void FigureController::read_words() {
  std::array<char, 512> some{};
  for (int i = 0; i < 8; ++i) {
    const std::size_t size = said_.read(some).value_or(0);
    if (size == 0) return;
    words_.append(some.data(), size);
    if (words_.size() > kMostSaid) words_.erase(0, words_.size() - kMostSaid);
  }
}

void FigureController::work() {
  if (!program_) return;
  read_words();
  if (!program_->has_ended()) return;
  read_words();
  const bool is_well = program_->ended_well();
  const std::string end = program_->exit_text();
  program_.reset();
  if (!is_well) {
    const std::string said = newest_line(words_);
    trouble_ = printable((said.empty() ? end : said).substr(0, kMostShown));
  } else if (needs_.keep) {
    if (const auto kept = needs_.keep(under_way_.guest, under_way_.figure); !kept)
      trouble_ = printable(kept.error().what);
  }
  if (auto next = std::exchange(next_, std::nullopt)) {
    if (is_well) trouble_.clear();
    start(std::move(*next));
  }
}

}  // namespace dance
