#include "voice/program/key_reader.h"

#include <unistd.h>

#include <array>

#include "core/program/foreground.h"

namespace dance {

KeyReader::KeyReader(Poller& poller, std::function<void(char key, MonoTime now)> on_key)
    : poller_(poller), on_key_(std::move(on_key)) {
  if (!is_in_foreground() || tcgetattr(STDIN_FILENO, &before_) != 0) return;
  termios single = before_;
  single.c_lflag &= ~static_cast<tcflag_t>(ICANON | ECHO);
  single.c_cc[VMIN] = 0;
  single.c_cc[VTIME] = 0;
  if (tcsetattr(STDIN_FILENO, TCSANOW, &single) != 0) return;
  is_there_ = true;
  poller_.watch(STDIN_FILENO, [this](MonoTime now) {
    std::array<char, 64> keys{};
    const ssize_t count = ::read(STDIN_FILENO, keys.data(), keys.size());
    // The terminal was closed.
    if (count <= 0) return poller_.unwatch(STDIN_FILENO);
    for (ssize_t i = 0; i < count; ++i) on_key_(keys[static_cast<std::size_t>(i)], now);
  });
}

KeyReader::~KeyReader() {
  if (!is_there_) return;
  poller_.unwatch(STDIN_FILENO);
  tcsetattr(STDIN_FILENO, TCSANOW, &before_);
}

}  // namespace dance
