#include "tunnel/nats/nats_messages.h"

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
  std::unique_ptr<NatsMessages> made(new NatsMessages(options, poller, std::move(handlers)));
  DANCE_TRY(NatsGreeted greeted, made->connector_.connect_now());
  made->begin(std::move(greeted), mono_now());
  return made;
}

NatsMessages::NatsMessages(const NatsOptions& options, Poller& poller, Handlers handlers)
    : poller_(poller),
      handlers_(std::move(handlers)),
      connector_(options),
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

void NatsMessages::begin(NatsGreeted greeted, MonoTime now) {
  channel_.emplace(std::move(greeted.channel));
  reader_.clear();
  waiting_.clear();
  const auto room = reader_.room();
  const std::size_t count = std::min(room.size(), greeted.unread.size());
  std::copy_n(greeted.unread.begin(), count, room.begin());
  reader_.add(count);
  heard_ = now;
  write_again_ = MonoTime();
  next_ping_ = now + kAsksAfter;
  for (const auto& [subject, number] : subjects_) say_listen(subject, number);
  poller_.watch(channel_->fd(), [this](MonoTime at) { on_readable(at); });
  poller_.set_deadline(timer_, next_ping_);
  end_turn(now);
}

void NatsMessages::end(MonoTime) {
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

void NatsMessages::say_listen(std::string_view subject, std::uint32_t number) {
  say({"SUB ", subject, " ", NumberText(number).view(), "\r\n"});
}

void NatsMessages::listen(std::string_view subject) {
  const auto [added, is_new] = subjects_.emplace(std::string(subject), next_number_);
  if (!is_new) return;
  ++next_number_;
  if (channel_) say_listen(subject, added->second);
}

void NatsMessages::end_listen(std::string_view subject) {
  const auto known = subjects_.find(subject);
  if (known == subjects_.end()) return;
  if (channel_) say({"UNSUB ", NumberText(known->second).view(), "\r\n"});
  subjects_.erase(known);
}

void NatsMessages::end_turn(MonoTime now) {
  if (!channel_ || waiting_.empty()) return;
  const auto written = channel_->write(waiting_);
  if (!written) return end(now);
  waiting_.erase(waiting_.begin(), waiting_.begin() + static_cast<std::ptrdiff_t>(*written));
  write_again_ = waiting_.empty() ? MonoTime() : now + kWritesAgain;
  if (!waiting_.empty()) poller_.set_deadline(timer_, write_again_);
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
    end(now);
    return MonoTime();
  }
  if (now >= next_ping_) {
    next_ping_ = now + kAsksAfter;
    if (now - heard_ >= kAsksAfter) {
      say({"PING\r\n"});
      end_turn(now);
      if (!channel_) return MonoTime();
    }
  }
  return write_again_.is_set() ? std::min(write_again_, next_ping_) : next_ping_;
}

void NatsMessages::on_readable(MonoTime now) {
  for (int reads = 0; channel_ && reads < kReadsPerTurn; ++reads) {
    const auto room = reader_.room().first(kBehind);
    const auto count = channel_->read(room);
    if (!count) {
      end(now);
      break;
    }
    if (*count == 0) break;
    heard_ = now;
    reader_.add(*count);
    const bool is_behind = *count == room.size();
    take_all(is_behind, now);
    if (channel_ && reader_.is_broken()) end(now);
    if (!is_behind) break;
  }
  handlers_.after_batch(now);
  end_turn(now);
}

// How many of each subject there are in the buffer.
void NatsMessages::count_newest() {
  in_buffer_.assign(next_number_, 0);
  while (const auto item = reader_.next())
    if (item->kind == NatsReader::Kind::kMessage && item->subscription < next_number_)
      ++in_buffer_[item->subscription];
  reader_.rewind();
}

void NatsMessages::take_all(bool is_behind, MonoTime now) {
  if (is_behind) count_newest();
  while (const auto item = reader_.next()) {
    switch (item->kind) {
      case NatsReader::Kind::kMessage:
        if (is_behind && item->subscription < in_buffer_.size() &&
            in_buffer_[item->subscription]-- > kKept)
          ++counters_.dropped_in;
        else
          handlers_.on_message(item->text, item->payload, now);
        break;
      case NatsReader::Kind::kTooLong:
        ++counters_.dropped_in;
        break;
      case NatsReader::Kind::kPing:
        say({"PONG\r\n"});
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
