// A recorded dance in a file of any kind (LCM log, MCAP, table, BVH, glTF), for programs that
// convert and play it.
//
// Units/frames: as formats/recording/recording_sink.h; clips begin when their file was last
//               changed.
// Ownership:    a RecordedFile owns its file.
// Failure:      an Error names the file and the cure; what was damaged is left out, and lost() says
//               what.
#pragma once

#include <memory>
#include <optional>
#include <string>
#include <vector>

#include "core/bus/channel.h"
#include "formats/bvh/retarget.h"
#include "formats/kind/file_kind.h"
#include "formats/recording/recording_sink.h"

namespace dance {

struct RecordedFileOptions {
  GuestId guest;               // the name of a single dancer without one; not set: the file's
  std::optional<Where> where;  // of an LCM log
  RetargetOptions retarget;    // unit and axis of a BVH or glTF
};

class RecordedFile {
 public:
  // Refuses folders, pipes and devices, files of another kind, and options for another kind.
  static Result<std::unique_ptr<RecordedFile>> open(const std::string& path,
                                                    const RecordedFileOptions& options = {});
  virtual ~RecordedFile() = default;

  virtual Result<void> read_into(RecordingSink& sink) = 0;
  // The place, as in channels, that its poses are from.
  virtual Where where() const { return Where::kCapture; }
  // Assumptions and oddities, one line each.
  virtual std::vector<std::string> notes() const { return {}; }
  // One line on what could not be read; "" if nothing.
  virtual std::string lost() const { return ""; }
};

}  // namespace dance
