#include "lobby/screen/file_chooser.h"

#include <algorithm>
#include <cstdlib>
#include <filesystem>

#include "core/base/music/music_file_name.h"

namespace dance {
namespace {

namespace fs = std::filesystem;

std::string lower(std::string_view text) {
  std::string out(text);
  for (char& c : out)
    if (c >= 'A' && c <= 'Z') c = static_cast<char>(c - 'A' + 'a');
  return out;
}

std::string home_folder() {
  const char* home = std::getenv("HOME");  // NOLINT(concurrency-mt-unsafe)
  return home != nullptr && *home == '/' ? home : "/";
}

}  // namespace

bool is_file_for(ChooserPurpose purpose, std::string_view name) {
  const std::string small = lower(name);
  const auto ends = [&](std::initializer_list<const char*> endings) {
    return std::any_of(endings.begin(), endings.end(),
                       [&](const char* ending) { return small.ends_with(ending); });
  };
  switch (purpose) {
    case ChooserPurpose::kMotion:
    case ChooserPurpose::kPartner:
    case ChooserPurpose::kTeacher:
      return ends({".bvh", ".bvh.xz", ".glb", ".gltf", ".vrma", ".lcm"});
    case ChooserPurpose::kMusic:
      return has_music_ending(std::string(name));
    case ChooserPurpose::kAvatar:
      return ends({".vrm", ".glb"});
    case ChooserPurpose::kVideo:
      return ends({".mp4", ".webm", ".mkv", ".mov", ".avi"});
    case ChooserPurpose::kNone:
      break;
  }
  return false;
}

void FileChooser::open(ChooserPurpose purpose, const std::string& file) {
  purpose_ = purpose;
  std::error_code error;
  const fs::path folder = fs::path(file).parent_path();
  enter(!file.empty() && fs::is_directory(folder, error) ? folder.string() : home_folder());
}

void FileChooser::enter(const std::string& folder) {
  folder_ = folder;
  entries_.clear();
  trouble_.clear();
  std::error_code error;
  fs::directory_iterator it(folder, fs::directory_options::skip_permission_denied, error);
  for (; !error && it != fs::directory_iterator() && entries_.size() < kMostEntries;
       it.increment(error)) {
    std::error_code ignored;
    const std::string name = it->path().filename().string();
    if (name.empty() || name.front() == '.') continue;
    const bool is_folder = it->is_directory(ignored);
    if (is_folder || is_file_for(purpose_, name)) entries_.push_back({name, is_folder});
  }
  if (error) trouble_ = error.message();
  std::sort(entries_.begin(), entries_.end(), [](const Entry& a, const Entry& b) {
    return a.is_folder != b.is_folder ? a.is_folder : lower(a.name) < lower(b.name);
  });
}

void FileChooser::enter_parent() {
  const fs::path parent = fs::path(folder_).parent_path();
  enter(parent.empty() ? "/" : parent.string());
}

std::string FileChooser::path_of(const Entry& entry) const {
  return (fs::path(folder_) / entry.name).string();
}

}  // namespace dance
