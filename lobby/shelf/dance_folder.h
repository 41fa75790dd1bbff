// The folders with recorded dances: lists, renames and deletes the recordings in them.
//
// Threads: any; as slow as the disk.
// Failure: a folder that cannot be read has no recordings. rename_dance() and delete_dance() return
//          the reason; no recording is overwritten, and no other folder is reached.
#pragma once

#include <string>
#include <string_view>
#include <vector>

#include "core/base/result.h"
#include "lobby/shelf/recorded_dance.h"

namespace dance {

constexpr std::size_t kMostDances = 500;
constexpr std::size_t kMostDanceName_bytes = 80;

// The newest kMostDances of the regular files *.lcm of these folders, by the time of their last
// change, newest first.
std::vector<RecordedDance> dances_in(const std::vector<std::string>& folders);
void sort_newest_first(std::vector<RecordedDance>& dances);

// True if a recording may have this name: visible text of bounded length that names a file in the
// same folder, and not a hidden one.
bool is_dance_name(std::string_view name);
// Gives the file that name, with the ending .lcm, and returns its new path.
Result<std::string> rename_dance(const std::string& path, const std::string& name);
Result<void> delete_dance(const std::string& path);
// Returns a path in the recording's folder that is not taken: "dance-1.mp4", or "dance-1-2.mp4".
std::string name_for_export(const std::string& path, const std::string& ending);

}  // namespace dance
