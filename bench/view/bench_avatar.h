// An avatar from a file, for benchmarks.
//
// Threads: any.
// Failure: names the file and what is wrong with it.
#pragma once

#include <memory>
#include <string>

#include "core/base/result.h"
#include "formats/avatar/avatar_model.h"

namespace dance {

Result<std::shared_ptr<const AvatarModel>> read_bench_avatar(const std::string& file);

}  // namespace dance
