// Reports changes of this machine's addresses or routes, so that a house that changes from Wi-Fi to
// a mobile network notices at once, not after a timeout.
//
// Units/frames: none.
// Ownership:    owns its descriptor.
// Threads:      one owner.
// Failure:      open() gives nullptr where the kernel does not support it.
#pragma once

#include <memory>

namespace dance {

class AddressWatch {
 public:
  static std::unique_ptr<AddressWatch> open();
  ~AddressWatch();
  AddressWatch(const AddressWatch&) = delete;
  AddressWatch& operator=(const AddressWatch&) = delete;

  // Readable when there is something to drain.
  int fd() const { return fd_; }
  // Reads all pending reports. True if something has changed.
  bool drain();

 private:
  explicit AddressWatch(int fd) : fd_(fd) {}
  int fd_;
};

}  // namespace dance
