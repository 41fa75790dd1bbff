// Where the pictures of Debian's package opencv-doc are: chessboards that a calibration is known
// of, and a stereo pair with the truth beside it.
//
// Threads: any.
// Failure: "" where the package is not installed.
#pragma once

#include <array>
#include <cstdlib>
#include <filesystem>
#include <string>

namespace dance {

constexpr const char* kNoOpencvDoc =
    "no pictures of chessboards: install opencv-doc, or name the folder of its examples/data in "
    "DANCE_OPENCV_DOC";

inline std::string opencv_doc_folder() {
  const char* named =
      std::getenv("DANCE_OPENCV_DOC");  // NOLINT(concurrency-mt-unsafe): no thread sets it
  const std::array<std::string, 2> folders{named ? named : "",
                                           "/usr/share/doc/opencv-doc/examples/data"};
  for (const std::string& folder : folders)
    if (!folder.empty() && std::filesystem::exists(folder + "/left01.jpg")) return folder;
  return {};
}

}  // namespace dance
