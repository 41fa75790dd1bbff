#include "producers/music/file/song_folder.h"

#include <algorithm>
#include <array>
#include <cctype>
#include <filesystem>
#include <string_view>

namespace dance {

bool is_music_file(const std::string& path) {
  constexpr std::array<std::string_view, 7> kEndings = {".ogg", ".opus", ".flac", ".wav",
                                                        ".mp3", ".m4a",  ".aac"};
  std::string ending = std::filesystem::path(path).extension().string();
  std::transform(ending.begin(), ending.end(), ending.begin(),
                 [](unsigned char c) { return static_cast<char>(std::tolower(c)); });
  return std::find(kEndings.begin(), kEndings.end(), ending) != kEndings.end();
}

std::vector<std::string> songs_after(const std::string& path) {
  namespace fs = std::filesystem;
  const fs::path folder = fs::path(path).parent_path();
  std::vector<std::string> songs;
  std::error_code error;
  fs::directory_iterator entry(folder.empty() ? fs::path(".") : folder, error);
  for (; !error && entry != fs::directory_iterator() && songs.size() < kMostSongsInFolder;
       entry.increment(error)) {
    // Named as the song is, so that it is found among them.
    std::string song = (folder / entry->path().filename()).string();
    std::error_code unreadable;
    if (song != path && is_music_file(song) && entry->is_regular_file(unreadable))
      songs.push_back(std::move(song));
  }
  std::sort(songs.begin(), songs.end());
  std::rotate(songs.begin(), std::upper_bound(songs.begin(), songs.end(), path), songs.end());
  songs.push_back(path);
  return songs;
}

}  // namespace dance
