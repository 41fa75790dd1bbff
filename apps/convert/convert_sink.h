// What `dance convert` writes: a recording as a file of any kind.
//
// Units/frames: as formats/recording/recording_sink.h; clips at a steady rate.
// Ownership:    a sink owns its file.
// Threads:      none inside; one owner.
// Failure:      finish() says what could not be written, or what the format cannot hold, and the
//               cure. What is left out by a bound is counted in left_out().
#pragma once

#include <memory>
#include <string>

#include "core/bus/channel.h"
#include "formats/kind/file_kind.h"
#include "formats/recording/recording_sink.h"

namespace dance {

class ConvertSink : public RecordingSink {
 public:
  virtual Result<void> finish() = 0;
  // Of all guests; after finish().
  virtual std::uint64_t frames() const = 0;
  // What bounds left out: a loss, as damage is; "" where that is nothing.
  virtual std::string left_out() const { return ""; }
  // What the file says otherwise than its input by its nature, as a table without hands; "" where
  // that is nothing.
  virtual std::string note() const { return ""; }
};

struct SinkOptions {
  std::string path;               // an empty file that is to be written, and
  std::string name;               // what it is called to the user
  double hz = 0.0;                // of clips; 0 = 60
  Where where = Where::kCapture;  // the channels of an LCM log
};

Result<std::unique_ptr<ConvertSink>> make_sink(FileKind kind, const SinkOptions& options);

}  // namespace dance
