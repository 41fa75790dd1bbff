// KeyReader: single keys from the terminal as commands, while the program runs: space talks, m and
// d change muted and deafened.
//
// Units/frames: none.
// Ownership:    sets the terminal to single keys and back again; the poller must outlive it.
// Threads:      the poller's.
// Failure:      without a terminal there are no keys: is_there() is false.
#pragma once

#include <termios.h>

#include <functional>

#include "core/net/poller.h"

namespace dance {

class KeyReader {
 public:
  KeyReader(Poller& poller, std::function<void(char key, MonoTime now)> on_key);
  ~KeyReader();
  KeyReader(const KeyReader&) = delete;
  KeyReader& operator=(const KeyReader&) = delete;

  bool is_there() const { return is_there_; }

 private:
  Poller& poller_;
  std::function<void(char key, MonoTime now)> on_key_;
  termios before_{};
  bool is_there_ = false;
};

}  // namespace dance
