#include "tunnel/link/link_status.h"

namespace dance {
namespace {

HouseLinkTrouble trouble_of(SealTrouble trouble) {
  switch (trouble) {
    case SealTrouble::kWrongKey:
      return HouseLinkTrouble::kWrongKey;
    case SealTrouble::kNotTrusted:
      return HouseLinkTrouble::kNotTrusted;
    case SealTrouble::kServerKeyChanged:
      return HouseLinkTrouble::kServerKeyChanged;
    case SealTrouble::kInterrupted:
      return HouseLinkTrouble::kInterrupted;
    case SealTrouble::kNoAnswer:
      break;
  }
  return HouseLinkTrouble::kNoAnswer;
}

// First what the handler did before.
template <class... Args, class Then>
std::function<void(Args...)> behind(std::function<void(Args...)> before, Then then) {
  return [before = std::move(before), then = std::move(then)](Args... args) {
    if (before) before(args...);
    then(args...);
  };
}

}  // namespace

void LinkStatus::listen_to(LinkHandlers& handlers) {
  handlers.on_state =
      behind(std::move(handlers.on_state), [this](LinkState state, MonoTime) { on_state(state); });
  handlers.on_no_answer = behind(std::move(handlers.on_no_answer), [this](const Address&) {
    settle(HouseLinkTrouble::kNoAnswer);
    changed();
  });
  handlers.on_no_entry = behind(std::move(handlers.on_no_entry), [this](SealTrouble trouble) {
    settle(trouble_of(trouble));
    changed();
  });
  handlers.on_refused = behind(
      std::move(handlers.on_refused),
      [this](const wire::RefusalNotice& refusal, MonoTime now) { on_refused(refusal, now); });
  handlers.on_removal =
      behind(std::move(handlers.on_removal),
             [this](std::int32_t number, RemovalVerdict verdict) { on_removal(number, verdict); });
}

void LinkStatus::settle(HouseLinkTrouble trouble) {
  status_.trouble = trouble;
  status_.refusal = 0;
  status_.refused = GuestId();
  status_.asks_again = MonoTime();
}

void LinkStatus::on_state(LinkState state) {
  status_.state = state == LinkState::kConnected ? HouseLinkState::kConnected
                  : state == LinkState::kLapsed  ? HouseLinkState::kLapsed
                                                 : HouseLinkState::kConnecting;
  if (state == LinkState::kConnected) settle(HouseLinkTrouble::kNone);
  changed();
}

void LinkStatus::on_refused(const wire::RefusalNotice& refusal, MonoTime now) {
  const bool is_removed = refusal.cause == wire::Refusal::kRemoved;
  settle(is_removed ? HouseLinkTrouble::kRemoved : HouseLinkTrouble::kRefused);
  if (is_removed)
    status_.asks_again = now + Duration::s(refusal.seconds);
  else
    status_.refusal = static_cast<int>(refusal.cause);
  status_.refused = refusal.guest;
  changed();
}

void LinkStatus::on_removal(std::int32_t number, RemovalVerdict verdict) {
  status_.removal = number;
  status_.verdict = verdict;
  changed();
}

}  // namespace dance
