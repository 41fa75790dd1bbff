#include "apps/doctor/doctor_limits.h"

#include <sys/resource.h>
#include <sys/stat.h>

#include <algorithm>
#include <cstdlib>
#include <filesystem>
#include <set>

#include "core/base/printable.h"

namespace dance {
namespace {

namespace fs = std::filesystem;
using Grade = Finding::Grade;

// Ten dancers at 120 Hz record 2.6 GB an hour, at about 605 bytes a pose.
constexpr std::uint64_t kLeastFree_bytes = std::uint64_t{4} << 30;
// A house with cameras, sound and windows has some 150 files open, libraries of drivers among them.
constexpr std::uint64_t kLeastFiles = 512;

std::string gigabytes(std::uint64_t bytes) {
  const std::uint64_t tenths = bytes * 10 / 1'000'000'000;
  return std::to_string(tenths / 10) + "." + std::to_string(tenths % 10) + " GB";
}

}  // namespace

Finding check_disk(const std::string& folder, std::uint64_t free_bytes) {
  const std::string shown = printable(folder);
  Finding finding{"disk", Grade::kOk, gigabytes(free_bytes) + " free at " + shown, ""};
  if (free_bytes >= kLeastFree_bytes) return finding;
  finding.grade = Grade::kNote;
  finding.what += ", where recordings go: a recording ends when it is full";
  finding.cure = "du -xh " + shown + " | sort -h | tail   (lists what is largest)";
  return finding;
}

Finding check_open_files(std::uint64_t limit, std::uint64_t most) {
  Finding finding{"open files", Grade::kOk, std::to_string(limit) + " for each program", ""};
  if (limit >= kLeastFiles) return finding;
  finding.grade = Grade::kNote;
  finding.what += ": a house with cameras, sound and windows needs more";
  finding.cure = most > limit ? "ulimit -n " + std::to_string(std::min<std::uint64_t>(most, 4096))
                              : "a line in /etc/security/limits.conf: * - nofile 4096";
  return finding;
}

std::vector<Finding> examine_limits() {
  std::vector<Finding> findings;
  // `dance record` writes into this folder, windows into one of the user's.
  std::vector<fs::path> folders;
  std::error_code error;
  folders.push_back(fs::current_path(error));
  if (const char* home = std::getenv("HOME"))  // NOLINT(concurrency-mt-unsafe)
    folders.emplace_back(home);
  std::set<dev_t> seen;
  for (const fs::path& folder : folders) {
    struct stat status {};
    if (folder.empty() || ::stat(folder.c_str(), &status) != 0) continue;
    if (!seen.insert(status.st_dev).second) continue;
    const fs::space_info space = fs::space(folder, error);
    if (!error) findings.push_back(check_disk(folder.string(), space.available));
  }
  rlimit files{};
  if (getrlimit(RLIMIT_NOFILE, &files) == 0)
    findings.push_back(check_open_files(files.rlim_cur, files.rlim_max));
  return findings;
}

}  // namespace dance
