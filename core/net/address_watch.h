// Tells when this machine's addresses or routes change: a house that goes from Wi-Fi to a phone's
// line notices at once, not when its server has been silent for a while.
//
// Units/frames: none.
// Ownership:    owns its descriptor.
// Threads:      one owner.
// Failure:      open() gives nullptr where the kernel does not tell; whoever asks goes on without.
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
  // Takes all that has been told. True where something has changed.
  bool drain();

 private:
  explicit AddressWatch(int fd) : fd_(fd) {}
  int fd_;
};

}  // namespace dance
