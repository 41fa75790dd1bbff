#include "consumers/output_file.h"

#include <cerrno>
#include <system_error>

namespace dance {
namespace {

std::string reason_of(int error) { return std::generic_category().message(error); }

}  // namespace

Result<std::unique_ptr<OutputFile>> OutputFile::open(const std::string& path) {
  if (path.empty() || path == "-")
    return std::unique_ptr<OutputFile>(new OutputFile(stdout, "standard output"));
  std::FILE* file = std::fopen(path.c_str(), "we");
  if (file == nullptr)
    return fail(path + ": cannot be written: " + reason_of(errno) + "; give another path with -o");
  return std::unique_ptr<OutputFile>(new OutputFile(file, path));
}

OutputFile::~OutputFile() {
  if (file_ != stdout) std::fclose(file_);
}

void OutputFile::write(std::string_view text) {
  if (error_ == 0 && std::fwrite(text.data(), 1, text.size(), file_) != text.size()) error_ = errno;
}

Result<void> OutputFile::flush() {
  if (error_ == 0 && std::fflush(file_) != 0) error_ = errno;
  if (error_ != 0)
    return fail(name_ + ": writing failed: " + reason_of(error_) +
                "; what was written before stands");
  return {};
}

}  // namespace dance
