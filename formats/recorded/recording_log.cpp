#include "formats/recorded/recording_log.h"

#include <fcntl.h>

#include <cerrno>
#include <cstring>

#include "formats/recording/log_sink.h"

namespace dance {

Result<RecordingLog> RecordingLog::open(const std::string& path,
                                        const RecordedFileOptions& options) {
  RecordingLog log;
  DANCE_TRY(const FileKind kind, input_kind(path));
  if (kind == FileKind::kLcm) {
    log.path_ = path;
    return log;
  }
  DANCE_TRY(const auto recording, RecordedFile::open(path, options));
  log.file_.reset(std::tmpfile());
  if (!log.file_)
    return fail(path + ": no temporary file to play it from: " + std::strerror(errno) +
                "; dance convert makes an LCM log of it");
  // A program that this one starts would keep the disk's space.
  fcntl(fileno(log.file_.get()), F_SETFD, FD_CLOEXEC);
  // tmpfile() has no name: it is opened again through its descriptor.
  log.path_ = "/proc/self/fd/" + std::to_string(fileno(log.file_.get()));
  DANCE_TRY(LogWriter writer, LogWriter::append_to(log.path_));
  LogSink sink(std::move(writer), recording->where());
  if (auto read = recording->read_into(sink); !read) return tl::make_unexpected(read.error());
  if (auto finished = sink.finish(); !finished)
    return fail(path + ": cannot be played from the temporary folder: " + finished.error().what +
                "; dance convert makes an LCM log of it elsewhere");
  log.notes_ = recording->notes();
  log.lost_ = recording->lost();
  return log;
}

}  // namespace dance
