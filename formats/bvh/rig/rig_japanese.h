// MikuMikuDance names its joints in Japanese; rig_names.h reads English words.
//
// Ownership: plain values.
// Threads:   none inside.
// Failure:   none; a text without these words is returned as it is.
#pragma once

#include <string>
#include <string_view>

namespace dance {

// The name with the Japanese words and full-width digits of joints replaced: "左足首" becomes
// " left  ankle ".
std::string in_english(std::string_view name);

}  // namespace dance
