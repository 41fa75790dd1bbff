// The songs beside a song: files of music in its folder, ordered by name.
//
// Threads:      any; reads the folder.
// Failure:      a folder that cannot be read holds the song alone.
#pragma once

#include <string>
#include <vector>

namespace dance {

constexpr std::size_t kMostSongsInFolder = 10000;  // entries of its folder

// Those after `path` in the order of their names, then those before it, then itself.
std::vector<std::string> songs_after(const std::string& path);

}  // namespace dance
