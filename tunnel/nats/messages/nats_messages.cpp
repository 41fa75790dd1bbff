#include "tunnel/nats/messages/nats_messages.h"

#include <algorithm>
#include <array>
#include <charconv>

#include "core/net/mono_clock.h"

namespace dance {
namespace {

// A connection on which nothing came for so long is asked, and then given up.
constexpr Duration kAsksAfter = Duration::ms(500);
constexpr Duration kSilentConnection = Duration::ms(1500);
constexpr Duration kWritesAgain = Duration::ms(1);
// Then sockets and timers have their say.
constexpr int kReadsPerTurn = 4;
// So much at once has waited: some hundred records.
constexpr std::size_t kBehind = 32'768;
constexpr std::size_t kLongestSubject = 128;
// Subjects to begin and end take no more of a turn, so that poses find room behind them.
constexpr std::size_t kInterestsPerTurn = NatsMessages::kMostWaiting / 4;

std::span<const std::uint8_t> bytes_of(std::string_view text) {
  return {reinterpret_cast<const std::uint8_t*>(text.data()), text.size()};
}

class NumberText {
 public:
  explicit NumberText(std::size_t number)
      : end_(std::to_chars(digits_.data(), digits_.data() + digits_.size(), number).ptr) {}
  std::string_view view() const {
    return {digits_.data(), static_cast<std::size_t>(end_ - digits_.data())};
  }

 private:
  std::array<char, 20> digits_;
  char* end_;
};

}  // namespace

Result<std::unique_ptr<NatsMessages>> NatsMessages::connect(const NatsOptions& options,
                                                            Poller& poller, Handlers handlers) {
  DANCE_TRY(WakeEvent wake, WakeEvent::create());
  std::unique_ptr<NatsMessages> made(
      new NatsMessages(options, std::move(wake), poller, std::move(handlers)));
  DANCE_TRY(NatsHandshake opened, made->connector_.connect_now());
  made->begin(std::move(opened), mono_now());
  return made;
}

NatsMessages::NatsMessages(const NatsOptions& options, WakeEvent wake, Poller& poller,
                           Handlers handlers)
    : poller_(poller),
      handlers_(std::move(handlers)),
      connector_(options, std::move(wake)),
      timer_(poller.add_timer(MonoTime(), [this](MonoTime now) { return tick(now); })) {
  waiting_.reserve(2 * kMostWaiting);
  poller_.watch(connector_.fd(), [this](MonoTime now) {
    auto made = connector_.take();
    if (!made || channel_) return;
    begin(std::move(*made), now);
    handlers_.on_back(now);
  });
}

NatsMessages::~NatsMessages() {
  if (channel_) poller_.unwatch(channel_->fd());
  poller_.unwatch(connector_.fd());
  poller_.remove_timer(timer_);
}

void NatsMessages::begin(NatsHandshake opened, MonoTime now) {
  channel_.emplace(std::move(opened.channel));
  reader_.clear();
  waiting_.clear();
  const auto room = reader_.room();
  const std::size_t count = std::min(room.size(), opened.unread.size());
  std::copy_n(opened.unread.begin(), count, room.begin());
  reader_.add(count);
  heard_ = now;
  stuck_since_ = write_again_ = read_again_ = MonoTime();
  is_stuck_ = owes_pong_ = false;
  next_ping_ = now + kAsksAfter;
  subjects_.begin();
  poller_.watch(channel_->fd(), [this](MonoTime at) { on_readable(at); });
  poller_.set_deadline(timer_, next_ping_);
  end_turn(now);
}

void NatsMessages::end() {
  poller_.unwatch(channel_->fd());
  poller_.set_deadline(timer_, MonoTime());
  channel_.reset();
  waiting_.clear();
  connector_.ask();
}

void NatsMessages::say(std::initializer_list<std::string_view> parts) {
  for (const std::string_view part : parts) {
    const auto bytes = bytes_of(part);
    waiting_.insert(waiting_.end(), bytes.begin(), bytes.end());
  }
}

void NatsMessages::publish(std::string_view subject, Bytes message) {
  if (!channel_ || waiting_.size() + message.size() + kLongestSubject > kMostWaiting) {
    ++counters_.dropped_out;
    return;
  }
  say({"PUB ", subject, " ", NumberText(message.size()).view(), "\r\n"});
  waiting_.insert(waiting_.end(), message.begin(), message.end());
  say({"\r\n"});
}

void NatsMessages::listen(std::string_view subject) {
  if (!subjects_.listen(subject)) ++counters_.refused;
}

void NatsMessages::end_listen(std::string_view subject) {
  subjects_.end_listen(subject, mono_now());
}

void NatsMessages::say_interests() {
  const std::size_t most = waiting_.size() + kInterestsPerTurn;
  while (waiting_.size() < std::min(most, kMostWaiting)) {
    const auto line = subjects_.take_line();
    if (!line) return;
    ++counters_.interests_said;
    if (line->subject.empty())
      say({"UNSUB ", NumberText(line->number).view(), "\r\n"});
    else
      say({"SUB ", line->subject, " ", NumberText(line->number).view(), "\r\n"});
  }
}

// What is said besides poses is bounded too: a PONG a turn, interests while there is room, and a
// PING where nothing came. So at most kMostWaiting wait, and one line.
void NatsMessages::end_turn(MonoTime now) {
  if (!channel_) return;
  say_interests();
  if (owes_pong_ && waiting_.size() < kMostWaiting) {
    say({"PONG\r\n"});
    owes_pong_ = false;
  }
  if (waiting_.empty()) return;
  const auto written = channel_->write(waiting_);
  if (!written) return end();
  waiting_.erase(waiting_.begin(), waiting_.begin() + static_cast<std::ptrdiff_t>(*written));
  is_stuck_ = !waiting_.empty();
  if (*written > 0)
    stuck_since_ = MonoTime();
  else if (!stuck_since_.is_set())
    stuck_since_ = now;
  else if (now - stuck_since_ > kSilentConnection)
    return end();
  write_again_ = is_stuck_ || subjects_.has_lines() ? now + kWritesAgain : MonoTime();
  if (write_again_.is_set()) poller_.set_deadline(timer_, next_deadline());
}

void NatsMessages::flush(Duration longest) {
  for (const MonoTime until = mono_now() + longest; channel_ && !waiting_.empty();) {
    const MonoTime now = mono_now();
    if (now >= until) return;
    end_turn(now);
    if (channel_ && !waiting_.empty()) channel_->wait_for_bytes(kWritesAgain);
  }
}

MonoTime NatsMessages::tick(MonoTime now) {
  if (!channel_) return MonoTime();
  if (write_again_.is_set() && now >= write_again_) end_turn(now);
  if (!channel_) return MonoTime();
  if (now - heard_ > kSilentConnection) {
    end();
    return MonoTime();
  }
  if (read_again_.is_set() && now >= read_again_) on_readable(now);
  if (!channel_) return MonoTime();
  if (now >= next_ping_) {
    next_ping_ = now + kAsksAfter;
    subjects_.settle(now);
    if (subjects_.has_lines()) end_turn(now);
    if (!channel_) return MonoTime();
    if (now - heard_ >= kAsksAfter && waiting_.size() < kMostWaiting) {
      say({"PING\r\n"});
      end_turn(now);
      if (!channel_) return MonoTime();
    }
  }
  return next_deadline();
}

MonoTime NatsMessages::next_deadline() const {
  MonoTime next = next_ping_;
  for (const MonoTime at : {write_again_, read_again_})
    if (at.is_set()) next = std::min(next, at);
  return next;
}

void NatsMessages::on_readable(MonoTime now) {
  read_again_ = MonoTime();
  for (int reads = 0; channel_ && reads < kReadsPerTurn; ++reads) {
    const auto room = reader_.room().first(kBehind);
    const auto count = channel_->read(room);
    if (!count) {
      end();
      break;
    }
    if (*count == 0) break;
    heard_ = now;
    reader_.add(*count);
    const bool is_behind = *count == room.size();
    take_all(is_behind, now);
    if (channel_ && reader_.is_broken()) end();
    if (!is_behind) break;
  }
  handlers_.after_batch(now);
  end_turn(now);
  // What TLS has taken from the socket already wakes no poller.
  if (!channel_ || !channel_->has_pending()) return;
  read_again_ = now;
  poller_.set_deadline(timer_, next_deadline());
}

// How many of each subject there are in the buffer.
void NatsMessages::count_newest() {
  subjects_.count_all();
  while (const auto item = reader_.next())
    if (item->kind == NatsReader::Kind::kMessage) subjects_.count(item->subscription);
  reader_.rewind();
}

void NatsMessages::take_all(bool is_behind, MonoTime now) {
  if (is_behind) count_newest();
  while (const auto item = reader_.next()) {
    switch (item->kind) {
      case NatsReader::Kind::kMessage:
        // Of a subject that has ended, or is about to, some are still on their way.
        if (!subjects_.is_wanted(item->subscription)) break;
        if (is_behind && !subjects_.is_newest(item->subscription, kKept))
          ++counters_.dropped_in;
        else
          handlers_.on_message(item->text, item->payload, now);
        break;
      case NatsReader::Kind::kTooLong:
        ++counters_.dropped_in;
        break;
      case NatsReader::Kind::kPing:
        owes_pong_ = true;  // one answers all that came before it
        break;
      case NatsReader::Kind::kError:
        ++counters_.refused;  // where it matters, the end of the connection follows
        break;
      case NatsReader::Kind::kPong:
      case NatsReader::Kind::kOther:
        break;
    }
  }
}

}  // namespace dance
