// The file in which a log's index is kept: beside the log, or where its folder cannot be written,
// in the user's cache.
//
// Units/frames: none.
// Ownership:    nothing stays.
// Threads:      any; of two processes that write one file, one wins.
// Failure:      load_index() gives no index that is not of this log as it is now, and says why; the
//               file is written anew then. An index that cannot be kept is an Error that names the
//               file; it can be used all the same.
#pragma once

#include <string>
#include <vector>

#include "formats/replay/replay_index.h"

namespace dance {

// Of a log as it is now.
Result<LogMark> mark_of_log(const std::string& path);

// Where its index may be, the place beside it first.
std::vector<std::string> index_places(const std::string& log_path, bool stage_only);

Result<ReplayIndex> load_index(const std::string& log_path, const LogMark& mark, bool stage_only);
// Where it was kept.
Result<std::string> save_index(const std::string& log_path, const ReplayIndex& index);

}  // namespace dance
