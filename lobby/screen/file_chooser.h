// FileChooser: a folder's files of some kinds, to choose one of; for motion, music and avatars.
//
// Units/frames: none.
// Ownership:    plain values.
// Threads:      the drawing thread; reading a folder takes as long as its disk.
// Failure:      a folder that cannot be read is empty, and trouble() says why.
#pragma once

#include <string>
#include <string_view>
#include <vector>

namespace dance {

enum class ChooserPurpose { kNone, kMotion, kPartner, kTeacher, kMusic, kAvatar, kVideo };

class FileChooser {
 public:
  static constexpr std::size_t kMostEntries = 500;
  struct Entry {
    std::string name;
    bool is_folder = false;
  };

  // In the folder of that file, or at home.
  void open(ChooserPurpose purpose, const std::string& file);
  void enter(const std::string& folder);
  void enter_parent();
  void close() { purpose_ = ChooserPurpose::kNone; }

  ChooserPurpose purpose() const { return purpose_; }
  bool is_open() const { return purpose_ != ChooserPurpose::kNone; }
  const std::string& folder() const { return folder_; }
  // Folders first, each by name; those that begin with a dot are left out.
  const std::vector<Entry>& entries() const { return entries_; }
  const std::string& trouble() const { return trouble_; }
  std::string path_of(const Entry& entry) const;

 private:
  ChooserPurpose purpose_ = ChooserPurpose::kNone;
  std::string folder_;
  std::vector<Entry> entries_;
  std::string trouble_;
};

// Whether a file of that name is of use for it.
bool is_file_for(ChooserPurpose purpose, std::string_view name);

}  // namespace dance
