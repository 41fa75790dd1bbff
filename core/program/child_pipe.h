// ChildPipe: what a program that this one starts writes, read here without waiting.
//
// Units/frames: bytes.
// Ownership:    owns both ends; the program's own copy is the program's.
// Threads:      one.
// Failure:      open() says that this process can open no more files.
#pragma once

#include <cstdint>
#include <optional>
#include <span>
#include <utility>

#include "core/base/result.h"

namespace dance {

class ChildPipe {
 public:
  static Result<ChildPipe> open();

  ChildPipe() = default;  // closed
  ~ChildPipe() { close(); }
  ChildPipe(ChildPipe&& other) noexcept
      : fd_(std::exchange(other.fd_, -1)), child_fd_(std::exchange(other.child_fd_, -1)) {}
  ChildPipe& operator=(ChildPipe&& other) noexcept {
    std::swap(fd_, other.fd_);
    std::swap(child_fd_, other.child_fd_);
    return *this;
  }

  // For ChildProcess::Options. Once that is started this process lets go of it: the end of what is
  // written is the end of the program.
  int child_fd() const { return child_fd_; }
  void let_go();

  // Readable when something has come, or its end; -1 where it is closed.
  int fd() const { return fd_; }
  bool is_open() const { return fd_ >= 0; }
  // How much has come, 0 where nothing has; nothing at its end, and where it is closed.
  std::optional<std::size_t> read(std::span<char> into);
  std::optional<std::size_t> read(std::span<std::uint8_t> into) {
    return read({reinterpret_cast<char*>(into.data()), into.size()});
  }
  void close();

 private:
  int fd_ = -1, child_fd_ = -1;
};

}  // namespace dance
