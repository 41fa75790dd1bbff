// What kind of file a path is, with errors that a person can act on.
//
// Ownership: plain values.
// Threads:   none inside.
// Failure:   one line with the path, the reason and the cure.
#pragma once

#include <string>
#include <vector>

#include "core/base/result.h"

namespace dance {

// That it is there, a file, readable and not empty.
Result<void> check_file(const std::string& path);

// A PNG, JPEG or WebP, by its first bytes and not by its name.
bool is_picture(const std::string& path);

// The files of a folder that are called as pictures are (.jpg .jpeg .png .webp, and .bmp .tif .tiff
// .pgm .ppm, which are refused when they are read), by name, numbers in them by value: 2.png comes
// before 10.png.
Result<std::vector<std::string>> pictures_in(const std::string& folder);

}  // namespace dance
