#include "tunnel/seal/seal_client.h"

#include <algorithm>

#include "core/base/assert.h"
#include "core/base/deadline.h"

namespace dance {
namespace {

constexpr Duration kNoAnswerAfter = Duration::ms(1500);
constexpr Duration kInterruptedAfter = Duration::s(3);
// Between tries that the server refused: it would not say otherwise so soon.
constexpr Duration kRefusedWait = Duration::s(2);
constexpr Duration kNoticeWait = Duration::ms(500);
// A session that is silent this long may be of a server that is no more.
constexpr Duration kSilence = Duration::s(2);
constexpr Duration kTickOfTry = Duration::ms(50);
constexpr Duration kTickOfSession = Duration::ms(500);

}  // namespace

SealClient::SealClient(std::unique_ptr<SealContext> context, RandomU64 random, Handlers handlers,
                       DatagramSink& sink)
    : context_(std::move(context)),
      random_(std::move(random)),
      handlers_(std::move(handlers)),
      sink_(sink) {}

SealClient::~SealClient() { close(); }

void SealClient::begin(MonoTime now, bool is_rekeying) {
  ++counters_.tries;
  std::uint64_t id = 0;
  while (id == 0) id = seal::id_of(random_());
  try_ = Try();
  try_.is_rekeying = is_rekeying;
  try_.channel = std::make_unique<SealChannel>(*context_, SealChannel::Side::kLink, sink_);
  try_.channel->set_id(id);
  try_.since = now;
  go_on({}, now);
}

void SealClient::begin_anew(MonoTime now) {
  next_.reset();
  next_try_ = MonoTime();
  begin(now);
  next_tick_ = now + kTickOfTry;
}

void SealClient::connect_to_other_server(MonoTime now) {
  const bool was_sealed = session_ != nullptr;
  session_.reset();
  previous_.reset();
  begin_anew(now);
  if (was_sealed && handlers_.on_unsealed) handlers_.on_unsealed(now);
}

void SealClient::give_up(SealTrouble trouble, MonoTime now) {
  if (try_.is_rekeying && session_) return end_rekeying(now);
  try_ = Try();
  const bool is_refused = trouble != SealTrouble::kNoAnswer && trouble != SealTrouble::kInterrupted;
  next_try_ = is_refused ? now + kRefusedWait : now;
  if (handlers_.on_trouble) handlers_.on_trouble(trouble, now);
}

void SealClient::go_on(seal::Bytes records, MonoTime now) {
  const bool is_proving = try_.channel->awaits_answer_to_proof();
  switch (try_.channel->handshake(records)) {
    case SealChannel::Progress::kUnderWay:
      return;
    case SealChannel::Progress::kFailed:
      return give_up(context_->take_key_mismatch() ? SealTrouble::kServerKeyChanged
                     : is_proving                  ? SealTrouble::kWrongKey
                                                   : SealTrouble::kNotTrusted,
                     now);
    case SealChannel::Progress::kDone:
      break;
  }
  std::unique_ptr<SealChannel> made = std::move(try_.channel);
  // A session that has fallen silent may be of a server that is no more: it is replaced.
  const bool is_rekeying = try_.is_rekeying && session_ && now - last_heard_ <= kSilence;
  try_ = Try();
  if (!is_rekeying) return use_session(std::move(made), now);
  next_ = std::move(made);
  next_since_ = now;
  announce_next(now);
}

void SealClient::use_session(std::unique_ptr<SealChannel> session, MonoTime now) {
  session_ = std::move(session);
  next_.reset();
  previous_.reset();
  ++counters_.sessions;
  last_heard_ = session_since_ = now;
  rekey_delay_ = 0.1 * static_cast<double>(random_() >> 32) * 0x1p-32;
  next_try_ = next_rekeying_ = MonoTime();
  if (handlers_.on_sealed) handlers_.on_sealed(now);
}

SealChannel* SealClient::channel_of(std::uint64_t id) const {
  for (SealChannel* channel : {session_.get(), next_.get(), previous_.get()})
    if (channel != nullptr && channel->id() == id) return channel;
  return nullptr;
}

void SealClient::receive(seal::Bytes datagram, MonoTime received, MonoTime now) {
  const auto opening = seal::parse(datagram);
  if (!opening) {
    ++counters_.forged;
    return;
  }
  const bool is_of_session = session_ && opening->id == session_->id();
  const bool is_of_try = try_.channel && opening->id == try_.channel->id();
  if (opening->form == seal::Form::kNotice) {
    // Anybody can say so: the session stays until another stands.
    if (!is_of_session) return;
    ++counters_.notices;
    if (next_) return use_session(std::move(next_), now);
    if (!try_.channel && (!next_try_.is_set() || now >= next_try_)) {
      begin(now);
      next_try_ = now + kNoticeWait;
      next_tick_ = now + kTickOfTry;
    }
    return;
  }
  if (opening->form == seal::Form::kRecords) {
    if (is_of_try) {
      try_.has_heard = true;
      try_.heard = now;
      go_on(opening->body, now);
    } else if (is_of_session && session_->take_records(opening->body)) {
      session_.reset();
      next_.reset();
      previous_.reset();
      next_tick_ = now;
      if (handlers_.on_unsealed) handlers_.on_unsealed(now);
    } else if (next_ && opening->id == next_->id()) {
      if (next_->take_records(opening->body)) end_rekeying(now);
    }
    return;
  }
  seal::Bytes plain;
  SealChannel* channel = channel_of(opening->id);
  const auto opened = channel ? channel->open(opening->body, plain) : SealChannel::Opened::kForged;
  if (opened == SealChannel::Opened::kPlain) {
    last_heard_ = now;
    if (channel == next_.get()) switch_to_next(now);
    if (plain[0] == seal::kRekeyed) return;
    if (plain[0] == seal::kPathQuestion) return answer_path(plain);
    handlers_.on_datagram(plain, received, now);
  } else if (opened == SealChannel::Opened::kReplayed) {
    ++counters_.replayed;
  } else {
    ++counters_.forged;
  }
}

// Yes, we hear at this address.
void SealClient::answer_path(seal::Bytes question) {
  if (question.size() != seal::kPathBytes) return;
  std::array<std::uint8_t, seal::kPathBytes> answer;
  std::copy(question.begin(), question.end(), answer.begin());
  answer[0] = seal::kPathAnswer;
  session_->send(answer);
}

void SealClient::send(const Address&, std::span<const std::uint8_t> plain) {
  if (!session_ || !session_->send(plain)) ++counters_.unsealed;
}

MonoTime SealClient::tick(MonoTime now) {
  if (try_.channel) {
    if (!try_.has_heard && now - try_.since > kNoAnswerAfter)
      give_up(SealTrouble::kNoAnswer, now);
    else if (try_.has_heard && now - try_.heard > kInterruptedAfter)
      give_up(SealTrouble::kInterrupted, now);
    else
      try_.channel->resend_when_due();
  }
  if (next_ && now - last_heard_ > kSilence) use_session(std::move(next_), now);
  const bool is_wanted = !session_ || now - last_heard_ > kSilence;
  if (!try_.channel && is_wanted && now >= next_try_) begin(now);
  const MonoTime rekey_tick_at = rekey_tick(now);
  next_tick_ = now + (try_.channel ? kTickOfTry : kTickOfSession);
  if (!try_.channel && is_wanted && next_try_ > now) next_tick_ = std::min(next_tick_, next_try_);
  next_tick_ = earlier(next_tick_, rekey_tick_at);
  return next_tick_;
}

void SealClient::close() {
  if (session_) session_->close();
  session_.reset();
  if (next_) next_->close();
  next_.reset();
  previous_.reset();
  try_ = Try();
}

}  // namespace dance
