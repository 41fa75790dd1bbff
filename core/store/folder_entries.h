// Lists a folder without exceptions: a range-for over std::filesystem::directory_iterator throws
// where reading fails on the way, as on a network drive that goes away.
//
// Threads: any.
// Failure: `error` is set, and what was read before it is returned.
#pragma once

#include <filesystem>
#include <system_error>
#include <vector>

namespace dance {

// At most `most` entries, in no order.
inline std::vector<std::filesystem::directory_entry> folder_entries(
    const std::filesystem::path& folder, std::error_code& error, std::size_t most = 100'000) {
  std::vector<std::filesystem::directory_entry> entries;
  std::filesystem::directory_iterator entry(folder, error);
  for (; !error && entry != std::filesystem::directory_iterator() && entries.size() < most;
       entry.increment(error))
    entries.push_back(*entry);
  return entries;
}

}  // namespace dance
