#include "producers/camera/files/picture_file.h"

#include <string.h>
#include <unistd.h>

#include <algorithm>
#include <array>
#include <cctype>
#include <filesystem>
#include <fstream>
#include <string_view>

#include "formats/picture/picture.h"

namespace dance {
namespace {

namespace fs = std::filesystem;

bool is_called_a_picture(const fs::path& path) {
  static constexpr std::array<std::string_view, 9> kEndings{
      ".jpg", ".jpeg", ".png", ".bmp", ".webp", ".tif", ".tiff", ".pgm", ".ppm"};
  std::string ending = path.extension();
  for (char& c : ending) c = static_cast<char>(std::tolower(static_cast<unsigned char>(c)));
  return std::find(kEndings.begin(), kEndings.end(), ending) != kEndings.end();
}

}  // namespace

Result<void> check_file(const std::string& path) {
  std::error_code trouble;
  const fs::file_status status = fs::status(path, trouble);
  if (status.type() == fs::file_type::not_found) {
    return fail(path + ": there is no such file; check the name");
  }
  if (trouble) return fail(path + ": " + trouble.message() + "; look at its folder with ls -l");
  if (status.type() != fs::file_type::regular) {
    return fail(path + ": is no file; give a video, a picture or a folder of pictures");
  }
  if (::access(path.c_str(), R_OK) != 0) {
    return fail(path + ": no permission to read it; mend that with chmod +r");
  }
  if (fs::file_size(path, trouble) == 0) return fail(path + ": is empty; fetch it again");
  return {};
}

bool is_picture(const std::string& path) {
  std::array<char, 16> first{};
  std::ifstream(path, std::ios::binary).read(first.data(), first.size());
  return picture_kind(std::span(reinterpret_cast<const std::uint8_t*>(first.data()),
                                first.size())) != PictureKind::kNone;
}

Result<std::vector<std::string>> pictures_in(const std::string& folder) {
  std::error_code trouble;
  std::vector<std::string> all;
  for (fs::directory_iterator entry(folder, trouble), end; !trouble && entry != end;
       entry.increment(trouble)) {
    if (is_called_a_picture(entry->path())) all.push_back(entry->path());
  }
  if (trouble) return fail(folder + ": cannot be read: " + trouble.message());
  if (all.empty()) {
    return fail(folder + ": has no pictures; they are called .jpg, .png or .webp");
  }
  std::sort(all.begin(), all.end(), [](const std::string& a, const std::string& b) {
    const int order = ::strverscmp(a.c_str(), b.c_str());
    return order != 0 ? order < 0 : a < b;
  });
  return all;
}

}  // namespace dance
