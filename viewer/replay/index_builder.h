// Looks through a log and makes its ReplayIndex: once for the times, once for all else.
//
// Units/frames: as formats/replay/replay_index.h.
// Ownership:    reads through its own ReplayLog; holds a GuestBoard while it runs.
// Threads:      none inside; blocks for as long as reading takes. A window calls it in a thread.
// Failure:      an Error names a log that cannot be read, has no poses, or that `goes_on` ended.
#pragma once

#include <functional>
#include <string>

#include "formats/replay/replay_index.h"
#include "formats/replay/replay_log.h"

namespace dance {

// How much of the log is read, 0 to 1; false ends it.
using ReadingProgress = std::function<bool(double share)>;

Result<ReplayIndex> build_index(const std::string& path, bool stage_only,
                                const ReadingProgress& goes_on);
// Of a log in memory, `mark` is what its index will say of it.
Result<ReplayIndex> build_index(ReplayLog log, const std::string& name, const LogMark& mark,
                                bool stage_only, const ReadingProgress& goes_on);

struct IndexedLog {
  ReplayIndex index;
  std::string note;       // why the index could not be kept; "" where it was
  bool was_kept = false;  // from an earlier time
};
// The index that is kept of a log, or a new one, which is kept then.
Result<IndexedLog> index_of_log(const std::string& path, bool stage_only,
                                const ReadingProgress& goes_on);

}  // namespace dance
