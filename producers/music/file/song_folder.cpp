#include "producers/music/file/song_folder.h"

#include <algorithm>
#include <filesystem>

#include "core/base/music/music_file_name.h"
#include "core/store/folder_entries.h"

namespace dance {

std::vector<std::string> songs_after(const std::string& path) {
  namespace fs = std::filesystem;
  const fs::path folder = fs::path(path).parent_path();
  std::vector<std::string> songs;
  std::error_code error;
  for (const auto& entry :
       folder_entries(folder.empty() ? fs::path(".") : folder, error, kMostSongsInFolder)) {
    // The name is built like the song's own, so that the song is found among the names.
    std::string song = (folder / entry.path().filename()).string();
    std::error_code unreadable;
    if (song != path && has_music_ending(song) && entry.is_regular_file(unreadable))
      songs.push_back(std::move(song));
  }
  std::sort(songs.begin(), songs.end());
  std::rotate(songs.begin(), std::upper_bound(songs.begin(), songs.end(), path), songs.end());
  songs.push_back(path);
  return songs;
}

}  // namespace dance
