#include "lobby/run/dance_shelf.h"

#include <algorithm>
#include <charconv>
#include <filesystem>
#include <utility>

#include "core/base/text/plain_text.h"
#include "core/net/clock/recording_clock.h"
#include "lobby/run/machine_facts.h"
#include "lobby/shelf/dance_folder.h"

namespace dance {
namespace {

constexpr std::size_t kReadATurn = 4;  // recordings
constexpr Duration kExportEnds = Duration::s(2);

void remove_part(const std::string& file) {
  std::error_code error;  // ignored: there may be none
  std::filesystem::remove(file + ".part", error);
}

}  // namespace

int percent_in(std::string_view line) {
  constexpr std::string_view kBegin = "writing: ";
  if (!line.starts_with(kBegin) || !line.ends_with(" %")) return -1;
  line.remove_prefix(kBegin.size());
  int percent = -1;
  const auto [rest, error] = std::from_chars(line.data(), line.data() + line.size() - 2, percent);
  const bool is_whole = error == std::errc() && rest == line.data() + line.size() - 2;
  return is_whole && percent >= 0 && percent <= 100 ? percent : -1;
}

void DanceShelf::list(LobbyModel& model) {
  ShelfFacts& shelf = model.shelf;
  std::vector<RecordedDance> before = std::exchange(shelf.dances, dances_in(folders_));
  for (RecordedDance& dance : shelf.dances) {
    const auto at = std::find_if(before.begin(), before.end(), [&](const RecordedDance& it) {
      return it.is_read && it.path == dance.path && it.changed_us == dance.changed_us;
    });
    if (at == before.end()) continue;
    dance = std::move(*at);
    before.erase(at);
  }
  shelf.folder = folders_.empty() ? "" : with_tilde(folders_.front());
  shelf.now_us = wall_now_us();
  has_unread_ = true;
}

void DanceShelf::read_some(LobbyModel& model) {
  std::size_t count = 0;
  for (RecordedDance& dance : model.shelf.dances) {
    if (dance.is_read) continue;
    if (count++ == kReadATurn) return;
    read_dance(dance);
  }
  has_unread_ = false;
  sort_newest_first(model.shelf.dances);
}

void DanceShelf::note_dance_begins() {
  known_before_.clear();
  for (const RecordedDance& dance : dances_in(folders_)) known_before_.insert(dance.path);
}

void DanceShelf::note_dance_ends(LobbyModel& model) {
  list(model);
  for (const RecordedDance& dance : model.shelf.dances) {
    if (known_before_.contains(dance.path)) continue;
    model.shelf.chosen = dance.path;
    model.shelf.question = ShelfFacts::Question::kNone;
    return model.tell({LobbyBanner::Kind::kGood,
                       Text::kLobbySavedDance,
                       {},
                       with_tilde(plain_text(dance.path)),
                       Text::kLobbyWatch,
                       LobbyWish::kWatch});
  }
}

void DanceShelf::apply(LobbyModel& model, LobbyWish wish) {
  switch (wish) {
    case LobbyWish::kListDances:
      return list(model);
    case LobbyWish::kWatch:
      return watch(model);
    case LobbyWish::kMakeVideo:
      return make_video(model);
    case LobbyWish::kExportBvh:
      return export_as(model, ".bvh");
    case LobbyWish::kExportGlb:
      return export_as(model, ".glb");
    case LobbyWish::kCancelExport:
      return cancel_export(model);
    case LobbyWish::kRename:
      return rename(model);
    case LobbyWish::kDelete:
      return erase(model);
    case LobbyWish::kOpenFolder:
      return open_folder(model);
    default:
      return;
  }
}

// dance-view has the timeline.
void DanceShelf::watch(LobbyModel& model) {
  const RecordedDance* dance = model.shelf.find_chosen();
  if (dance == nullptr) return;
  viewer_.reset();  // one at a time
  const std::string language(kLanguages[static_cast<std::size_t>(model.texts.language())].code);
  auto started = ChildWords::start("dance-view", {"--language", language, "--place",
                                                  model.settings.window.place, "--", dance->path});
  if (!started) return model.tell(error_banner(Text::kLobbyNotShown, {}, started.error().what));
  viewer_ = std::move(*started);
}

void DanceShelf::make_video(LobbyModel& model) {
  const RecordedDance* dance = model.shelf.find_chosen();
  if (dance == nullptr || export_) return;
  const std::string file = name_for_export(dance->path, ".mp4");
  std::vector<std::string> words{"--export", file, "--place", model.settings.window.place};
  // Without a graphics card a minute of dance takes about two minutes to draw with these options,
  // and ten without them.
  if (!model.shelf.has_graphics_card)
    words.insert(words.end(), {"--quality", "low", "--size", "960x540"});
  words.insert(words.end(), {"--", dance->path});
  jobs_.push_back({"dance-view", std::move(words), file});
  start_next(model);
}

void DanceShelf::export_as(LobbyModel& model, const std::string& ending) {
  const RecordedDance* dance = model.shelf.find_chosen();
  if (dance == nullptr || export_) return;
  if (ending == ".bvh" && dance->guests.size() > 1) {
    for (const std::string& guest : dance->guests) {
      const std::string file = name_for_export(dance->path, "-" + guest + ending);
      // A recorded name may begin with '-'; it must not be parsed as an option.
      jobs_.push_back({"dance-convert", {"--guest=" + guest, "--", dance->path, file}, file});
    }
  } else {
    const std::string file = name_for_export(dance->path, ending);
    jobs_.push_back({"dance-convert", {"--", dance->path, file}, file});
  }
  start_next(model);
}

void DanceShelf::start_next(LobbyModel& model) {
  model.shelf.exported_name.clear();
  model.shelf.percent = -1;
  if (jobs_.empty()) return;
  model.shelf.question = ShelfFacts::Question::kNone;
  auto started = ChildWords::start(jobs_.front().program, jobs_.front().arguments, true);
  if (!started) {
    jobs_.clear();
    return model.tell(error_banner(Text::kLobbyExportFailed, {}, started.error().what));
  }
  export_ = std::move(*started);
  model.shelf.exported_name = std::filesystem::path(jobs_.front().file).filename().string();
}

void DanceShelf::cancel_export(LobbyModel& model) {
  if (!export_) return;
  export_->process().stop(kExportEnds);
  export_.reset();
  remove_part(jobs_.front().file);
  jobs_.clear();
  start_next(model);
}

void DanceShelf::rename(LobbyModel& model) {
  const RecordedDance* dance = model.shelf.find_chosen();
  if (dance == nullptr) return;
  const auto renamed = rename_dance(dance->path, model.shelf.name_typed);
  if (!renamed)
    return model.tell(error_banner(Text::kLobbyNotRenamed, {}, plain_text(renamed.error().what)));
  model.forget(Text::kLobbyNotRenamed);
  model.shelf.chosen = *renamed;
  model.shelf.question = ShelfFacts::Question::kNone;
  list(model);
}

void DanceShelf::erase(LobbyModel& model) {
  const RecordedDance* dance = model.shelf.find_chosen();
  if (dance == nullptr) return;
  if (const auto deleted = delete_dance(dance->path); !deleted)
    return model.tell(error_banner(Text::kLobbyNotDeleted, {}, plain_text(deleted.error().what)));
  model.forget(Text::kLobbySavedDance);
  model.shelf.chosen.clear();
  model.shelf.question = ShelfFacts::Question::kNone;
  list(model);
}

std::string DanceShelf::folder_of(const LobbyModel& model) const {
  const RecordedDance* dance = model.shelf.find_chosen();
  if (dance != nullptr) return std::filesystem::path(dance->path).parent_path().string();
  return folders_.empty() ? "" : folders_.front();
}

void DanceShelf::open_folder(LobbyModel& model) {
  opener_.reset();
  auto started = dance::open_folder(folder_of(model));
  if (started)
    opener_ = std::move(*started);
  else
    model.tell(error_banner(Text::kLobbyNotShown, {}, started.error().what));
}

bool DanceShelf::poll_export(LobbyModel& model) {
  if (!export_ || !export_->read()) return false;
  for (const std::string& line : export_->take_lines())
    model.shelf.percent = std::max(model.shelf.percent, percent_in(line));
  if (!export_->process().has_ended()) return true;
  export_->read();
  const ChildWords output = std::move(*export_);
  export_.reset();
  const std::string file = jobs_.front().file;
  jobs_.pop_front();
  std::error_code error;
  if (!std::filesystem::exists(file, error)) {
    remove_part(file);  // the other guests' files are still written
    model.tell(error_banner(Text::kLobbyExportFailed, {}, output.last_line()));
  } else if (jobs_.empty()) {
    const Text button = model.shelf.has_opener ? Text::kLobbyOpenFolder : Text::kCount;
    model.tell({LobbyBanner::Kind::kGood,
                Text::kLobbyExported,
                {with_tilde(plain_text(file))},
                "",
                button,
                LobbyWish::kOpenFolder});
  }
  start_next(model);
  return true;
}

bool DanceShelf::poll_viewer(LobbyModel& model) {
  if (!viewer_ || !viewer_->read() || !viewer_->process().has_ended()) return false;
  const bool is_well = viewer_->process().ended_well();
  if (!is_well) model.tell(error_banner(Text::kLobbyNotShown, {}, viewer_->last_line()));
  viewer_.reset();
  return !is_well;
}

bool DanceShelf::poll(LobbyModel& model) {
  if (opener_ && opener_->has_ended()) opener_.reset();
  const bool reads = has_unread_;
  if (reads) read_some(model);
  const bool has_export = poll_export(model);
  return poll_viewer(model) || has_export || reads;
}

}  // namespace dance
