#include "viewer/dance_panel/recording.h"

#include <array>
#include <chrono>
#include <csignal>
#include <cstdio>
#include <filesystem>

#include "core/base/printable.h"

namespace dance {
namespace {

constexpr Duration kEndsWithin = Duration::s(5);
constexpr std::size_t kMostWords = 2048;
constexpr std::size_t kMostTrouble = 200;
constexpr int kMostFilesAMinute = 100;

std::string last_line(const std::string& words) {
  std::size_t end = words.size();
  while (end > 0 && (words[end - 1] == '\n' || words[end - 1] == '\r')) --end;
  const std::size_t before = words.rfind('\n', end == 0 ? 0 : end - 1);
  const std::size_t begin = before == std::string::npos ? 0 : before + 1;
  return words.substr(std::min(begin, end), end - std::min(begin, end));
}

// "" for a relative path, as the desktop ignores those.
std::string folder_in(const Environment& environment, const char* name) {
  const char* text = environment(name);
  return text != nullptr && *text == '/' ? text : "";
}

}  // namespace

std::optional<std::string> dance_file(const std::string& folder, const std::tm& local,
                                      std::string_view ending,
                                      const std::function<bool(const std::string&)>& is_taken) {
  std::array<char, 40> stamp{};
  std::strftime(stamp.data(), stamp.size(), "dance-%Y-%m-%d-%H%M", &local);
  for (int i = 1; i <= kMostFilesAMinute; ++i) {
    std::string path = folder + "/" + stamp.data();
    if (i > 1) path += "-" + std::to_string(i);
    path += ending;
    if (!is_taken(path)) return path;
  }
  return std::nullopt;
}

Result<std::string> new_dance_file(const std::string& folder, std::string_view ending) {
  if (folder.empty()) return fail("HOME is not set");
  std::error_code error;
  std::filesystem::create_directories(folder, error);
  if (error) return fail(folder + ": " + error.message());
  const std::time_t wall = std::chrono::system_clock::to_time_t(std::chrono::system_clock::now());
  std::tm local{};
  localtime_r(&wall, &local);
  auto path = dance_file(folder, local, ending, [](const std::string& taken) {
    std::error_code ignored;
    return std::filesystem::exists(taken, ignored);
  });
  if (!path) return fail("too many files of this minute in " + folder);
  return std::move(*path);
}

std::string recordings_folder(const Environment& environment) {
  const std::string videos = folder_in(environment, "XDG_VIDEOS_DIR");
  if (!videos.empty()) return videos + "/DanceGraph";
  const std::string home = folder_in(environment, "HOME");
  return home.empty() ? "" : home + "/Videos/DanceGraph";
}

std::vector<std::string> older_recordings_folders(const Environment& environment) {
  std::vector<std::string> folders;
  const auto add = [&](const char* name, const char* rest) {
    const std::string folder = folder_in(environment, name);
    if (!folder.empty()) folders.push_back(folder + rest);
  };
  add("XDG_VIDEOS_DIR", "");
  add("HOME", "/Videos");
  add("XDG_DATA_HOME", "/dance/recordings");
  add("HOME", "/.local/share/dance/recordings");
  return folders;
}

void DanceRecording::fail_with(std::string why) {
  trouble_ = printable(why.substr(0, kMostTrouble));
  is_saved_ = false;
  state_ = State::kIdle;
}

void DanceRecording::start(MonoTime now) {
  if (state_ != State::kIdle) return;
  trouble_.clear();
  words_.clear();
  is_saved_ = false;
  auto path = new_dance_file(options_.folder, ".lcm");
  if (!path) return fail_with(path.error().what);
  file_ = std::move(*path);
  auto pipe = ChildPipe::open();
  if (!pipe) return fail_with(pipe.error().what);
  ChildProcess::Options how{options_.program, {"-o", file_, "--packed"}, "/dev/null", ""};
  if (!options_.bus.empty()) how.arguments.insert(how.arguments.end(), {"--bus", options_.bus});
  how.talk_fd = pipe->child_fd();
  auto program = ChildProcess::start(how);
  if (!program) return fail_with(program.error().what);
  pipe->let_go();
  said_ = std::move(*pipe);
  program_.emplace(std::move(*program));
  begun_ = now;
  state_ = State::kRunning;
}

void DanceRecording::stop(MonoTime now) {
  if (state_ != State::kRunning) return;
  program_->ask_to_stop();
  asked_to_stop_ = now;
  state_ = State::kStopping;
}

// The last ones are kept: they say why it ended.
void DanceRecording::read_words() {
  std::array<char, 512> some{};
  for (int i = 0; i < 8; ++i) {
    const std::size_t size = said_.read(some).value_or(0);
    if (size == 0) return;
    words_.append(some.data(), size);
    if (words_.size() > kMostWords) words_.erase(0, words_.size() - kMostWords);
  }
}

void DanceRecording::work(MonoTime now) {
  if (state_ == State::kIdle) return;
  read_words();
  if (!program_->has_ended()) {
    if (state_ == State::kStopping && now - asked_to_stop_ > kEndsWithin) program_->kill_now();
    return;
  }
  finish();
}

void DanceRecording::finish() {
  read_words();
  const bool is_well = program_->ended_well();
  const std::string said = last_line(words_);
  const std::string end = program_->exit_text();
  program_.reset();
  if (!is_well) return fail_with(said.empty() ? end : said);
  is_saved_ = true;
  state_ = State::kIdle;
}

}  // namespace dance
