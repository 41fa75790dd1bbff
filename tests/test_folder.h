// A folder for the files of a test, and what a file holds.
//
// Ownership: a TestFolder and what is in it go with the object.
// Threads:   one folder of a name at a time in a process.
// Failure:   a file that is not there holds nothing.
#pragma once

#include <unistd.h>

#include <cstdint>
#include <filesystem>
#include <fstream>
#include <iterator>
#include <string>
#include <vector>

namespace dance {

// An empty folder of this test's own, gone when it ends.
class TestFolder {
 public:
  explicit TestFolder(const std::string& name)
      : path_(std::filesystem::temp_directory_path() /
              ("dance-" + name + "-" + std::to_string(getpid()))) {
    std::filesystem::remove_all(path_);
    std::filesystem::create_directories(path_);
  }
  ~TestFolder() {
    std::error_code ignored;
    std::filesystem::remove_all(path_, ignored);
  }
  TestFolder(const TestFolder&) = delete;
  TestFolder& operator=(const TestFolder&) = delete;
  std::string path(const std::string& name = "") const {
    return (name.empty() ? path_ : path_ / name).string();
  }

 private:
  std::filesystem::path path_;
};

inline std::string text_of(const std::string& path) {
  std::ifstream file(path, std::ios::binary);
  return {std::istreambuf_iterator<char>(file), {}};
}

// True if the file or folder exists and only its owner can read, write or enter it.
inline bool is_private(const std::string& path) {
  using std::filesystem::perms;
  std::error_code missing;
  const perms mode = std::filesystem::status(path, missing).permissions();
  return !missing && (mode & (perms::group_all | perms::others_all)) == perms::none;
}

inline std::vector<std::uint8_t> bytes_in(const std::string& path) {
  std::ifstream file(path, std::ios::binary);
  return {std::istreambuf_iterator<char>(file), {}};
}

}  // namespace dance
