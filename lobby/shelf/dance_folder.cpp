#include "lobby/shelf/dance_folder.h"

#include <sys/stat.h>

#include <algorithm>
#include <filesystem>
#include <set>

#include "core/base/text/plain_text.h"
#include "core/program/part_file.h"

namespace dance {
namespace {

namespace fs = std::filesystem;

constexpr std::string_view kEnding = ".lcm";
constexpr const char* kIndexEnding = ".index";  // a replay's index is beside the recording
constexpr int kMostNames = 999;

bool is_there(const std::string& path) {
  std::error_code error;
  return fs::symlink_status(path, error).type() != fs::file_type::not_found;
}

// The most entries of one folder that are looked at, recordings and other files.
constexpr int kMostEntries = 20'000;

std::string stem_of(const std::string& path) {
  return path.ends_with(kEnding) ? path.substr(0, path.size() - kEnding.size()) : path;
}

std::vector<RecordedDance> recordings_in(const std::vector<std::string>& folders) {
  std::vector<RecordedDance> dances;
  std::set<std::string> known;  // two folders may be the same one
  for (const std::string& folder : folders) {
    std::error_code error;
    fs::directory_iterator it(folder, fs::directory_options::skip_permission_denied, error);
    for (int entries = 0; !error && it != fs::directory_iterator() && entries < kMostEntries;
         ++entries, it.increment(error)) {
      const std::string path = it->path().string();
      const std::string name = it->path().filename().string();
      struct stat facts {};
      if (name.starts_with('.') || !name.ends_with(kEnding) || stat(path.c_str(), &facts) != 0 ||
          !S_ISREG(facts.st_mode) || !known.insert(path).second)
        continue;
      RecordedDance dance;
      dance.path = path;
      dance.changed_us = static_cast<std::int64_t>(facts.st_mtim.tv_sec) * 1'000'000 +
                         facts.st_mtim.tv_nsec / 1'000;
      dance.begun_us = dance.changed_us;
      dances.push_back(std::move(dance));
    }
  }
  return dances;
}

}  // namespace

void sort_newest_first(std::vector<RecordedDance>& dances) {
  std::stable_sort(dances.begin(), dances.end(), [](const auto& a, const auto& b) {
    return a.begun_us != b.begun_us ? a.begun_us > b.begun_us : a.path < b.path;
  });
}

std::vector<RecordedDance> dances_in(const std::vector<std::string>& folders) {
  std::vector<RecordedDance> dances = recordings_in(folders);
  sort_newest_first(dances);
  if (dances.size() > kMostDances) dances.resize(kMostDances);
  return dances;
}

bool is_dance_name(std::string_view name) {
  return !name.empty() && name.size() <= kMostDanceName_bytes && name.front() != '.' &&
         name.front() != ' ' && name.back() != ' ' && name.find('/') == std::string_view::npos &&
         is_plain_text(name);
}

Result<std::string> rename_dance(const std::string& path, const std::string& name) {
  if (!is_dance_name(name))
    return fail("a name has 1 to " + std::to_string(kMostDanceName_bytes) +
                " bytes, no / and no . at its beginning");
  const std::string file = name.ends_with(kEnding) ? name : name + std::string(kEnding);
  const std::string to = (fs::path(path).parent_path() / file).string();
  if (to == path) return to;
  // Another program may take the name at any moment: a check before a rename would be too early.
  if (auto moved = move_to_free_name(path, to); !moved) return tl::make_unexpected(moved.error());
  std::error_code error;
  fs::rename(path + kIndexEnding, to + kIndexEnding, error);  // there may be none
  return to;
}

Result<void> delete_dance(const std::string& path) {
  std::error_code error;
  fs::remove(path, error);
  if (error) return fail(fs::path(path).filename().string() + ": " + error.message());
  fs::remove(path + kIndexEnding, error);  // there may be none
  return {};
}

std::string name_for_export(const std::string& path, const std::string& ending) {
  const std::string stem = stem_of(path);
  std::string name = stem + ending;
  for (int i = 2; is_there(name) && i < kMostNames; ++i)
    name = stem + "-" + std::to_string(i) + ending;
  return name;
}

}  // namespace dance
