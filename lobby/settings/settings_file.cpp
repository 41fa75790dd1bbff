#include "lobby/settings/settings_file.h"

#include <array>
#include <cerrno>
#include <cstdlib>
#include <cstring>
#include <ctime>
#include <filesystem>

#include "core/program/whole_file.h"
#include "formats/session/session_edit.h"
#include "formats/session/table_edit.h"

namespace dance {
namespace {

namespace fs = std::filesystem;

constexpr const char* kHeader =
    "# What was chosen in the DanceGraph window. It is an ordinary session file: edit it, and\n"
    "# start it with: dance join FILE\n";

std::string date_now() {
  const std::time_t now = std::time(nullptr);
  std::tm local{};
  localtime_r(&now, &local);
  std::array<char, 32> text{};
  std::strftime(text.data(), text.size(), "%Y%m%d-%H%M%S", &local);
  return text.data();
}

bool is_there(const std::string& path) {
  std::error_code error;
  return fs::symlink_status(path, error).type() != fs::file_type::not_found;
}

}  // namespace

Result<std::string> SettingsFile::usual_path() {
  const char* config = std::getenv("XDG_CONFIG_HOME");  // NOLINT(concurrency-mt-unsafe)
  if (config != nullptr && *config == '/') return std::string(config) + "/dancegraph/house.toml";
  const char* home = std::getenv("HOME");  // NOLINT(concurrency-mt-unsafe)
  if (home != nullptr && *home == '/') return std::string(home) + "/.config/dancegraph/house.toml";
  return fail(
      "there is no place for what is chosen: set HOME or XDG_CONFIG_HOME to a folder of yours");
}

Result<std::string> SettingsFile::keep_aside() const {
  const std::string first = path_ + ".broken-" + date_now();
  std::string name = first;
  for (int i = 2; is_there(name) && i < 1000; ++i) name = first + "-" + std::to_string(i);
  std::error_code error;
  fs::rename(path_, name, error);
  if (error)
    return fail(path_ + " is broken, and cannot be kept aside: " + error.message() +
                "; move it away, or mend it");
  return name;
}

Result<SettingsFile::Opened> SettingsFile::open() {
  Opened opened;
  opened.settings = first_settings();
  if (!is_there(path_)) {
    opened.is_new = true;
    return opened;
  }
  DANCE_TRY(const std::string text, read_whole_file(path_, kMaxSessionBytes));
  if (const auto house = parse_session(text, path_)) {
    opened.settings = settings_of(*house);
    return opened;
  } else {
    opened.trouble = house.error().what;
  }
  DANCE_TRY(opened.kept_as, keep_aside());
  return opened;
}

Result<SettingsFile::Saved> SettingsFile::save(const LobbySettings& settings) {
  Saved saved;
  std::string text;
  if (is_there(path_)) {
    DANCE_TRY(text, read_whole_file(path_, kMaxSessionBytes));
    if (const auto house = parse_session(text, path_); !house) {
      saved.trouble = house.error().what;
      DANCE_TRY(saved.kept_as, keep_aside());
      text.clear();
    }
  }
  DANCE_TRY(const std::string wanted, edited(text, settings));
  if (is_there(path_) && wanted == text) return saved;
  if (auto written = write_whole_file(path_, wanted); !written)
    return tl::make_unexpected(written.error());
  return saved;
}

Result<std::string> SettingsFile::edited(std::string text, const LobbySettings& settings) const {
  if (text.empty()) {
    std::error_code error;
    fs::create_directories(fs::path(path_).parent_path(), error);
    if (error)
      return fail(fs::path(path_).parent_path().string() + " cannot be made: " + error.message());
    text = kHeader + ("[house]\nguest = " + toml_text(settings.name) + "\n");
  }
  return edit_settings(text, settings, path_);
}

std::string SettingsFile::trial_path() const { return path_ + ".trial.toml"; }

Result<std::string> SettingsFile::save_trial(const LobbySettings& settings) const {
  std::string text;
  if (is_there(path_)) {
    DANCE_TRY(text, read_whole_file(path_, kMaxSessionBytes));
  }
  DANCE_TRY(const std::string wanted, edited(std::move(text), settings));
  if (auto written = write_whole_file(trial_path(), wanted); !written)
    return tl::make_unexpected(written.error());
  return trial_path();
}

void SettingsFile::remove_trial() const {
  std::error_code error;  // ignored: the file may not exist
  fs::remove(trial_path(), error);
}

LobbySettings first_settings() {
  LobbySettings settings;
  const char* user = std::getenv("USER");  // NOLINT(concurrency-mt-unsafe)
  const std::string name = name_from(user != nullptr ? user : "");
  if (!name.empty() && name != "root") settings.name = name;
  settings.source = DancerSource::kCamera;
  return settings;
}

}  // namespace dance
