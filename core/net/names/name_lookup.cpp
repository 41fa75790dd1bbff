#include "core/net/names/name_lookup.h"

#include <netdb.h>
#include <poll.h>
#include <pthread.h>

#include <cerrno>
#include <system_error>
#include <thread>
#include <utility>

#include "core/net/mono_clock.h"
#include "core/net/system/wake_event.h"

namespace dance {
namespace {

ResolverAnswer::Outcome outcome_of(int error) {
  if (error == 0) return ResolverAnswer::Outcome::kFound;
  const bool is_answer = error == EAI_NONAME || error == EAI_NODATA || error == EAI_ADDRFAMILY;
  return is_answer ? ResolverAnswer::Outcome::kUnknown : ResolverAnswer::Outcome::kNoAnswer;
}

}  // namespace

// The thread writes `answer`, then signals; the owner sees the signal, then reads `answer`.
struct NameLookup::Shared {
  Resolve resolve;
  WakeEvent is_answered;
  std::optional<Addresses> answer;

  void finish(Addresses found) {
    answer.emplace(std::move(found));
    is_answered.signal();
  }
};

Result<std::unique_ptr<NameLookup>> NameLookup::create(Resolve resolve) {
  auto event = WakeEvent::create();
  if (!event) return fail("names cannot be looked up: " + event.error().what);
  std::shared_ptr<Shared> shared(new Shared{std::move(resolve), std::move(*event), std::nullopt});
  return std::unique_ptr<NameLookup>(new NameLookup(std::move(shared)));
}

NameLookup::~NameLookup() = default;

int NameLookup::fd() const { return shared_->is_answered.fd(); }

void NameLookup::begin() {
  if (is_running_) return;
  is_running_ = true;
  try {
    std::thread([shared = shared_] {
      pthread_setname_np(pthread_self(), "name-lookup");
      shared->finish(shared->resolve());
    }).detach();
  } catch (const std::system_error&) {
    shared_->finish(fail("names cannot be looked up: the system allows no further thread"));
  }
}

std::optional<NameLookup::Addresses> NameLookup::take() {
  if (!shared_->is_answered.clear()) return std::nullopt;
  is_running_ = false;
  return std::exchange(shared_->answer, std::nullopt);
}

ResolverAnswer look_up_name(const std::string& name, Duration timeout) {
  ResolverAnswer answer{name, ResolverAnswer::Outcome::kNoAnswer, "", Duration()};
  const MonoTime begin = mono_now();
  const auto code = std::make_shared<int>(0);
  const auto lookup = NameLookup::create([name, code]() -> NameLookup::Addresses {
    addrinfo hints{};
    hints.ai_socktype = SOCK_DGRAM;
    addrinfo* found = nullptr;
    *code = getaddrinfo(name.c_str(), nullptr, &hints, &found);
    if (*code == 0) freeaddrinfo(found);
    return std::vector<Address>();
  });
  if (!lookup) {
    answer.reason = lookup.error().what;
    return answer;
  }
  (*lookup)->begin();
  pollfd readable{(*lookup)->fd(), POLLIN, 0};
  for (Duration left = timeout; left > Duration(); left = timeout - (mono_now() - begin))
    if (::poll(&readable, 1, static_cast<int>(left.count_ms())) >= 0 || errno != EINTR) break;
  const auto done = (*lookup)->take();
  answer.took = mono_now() - begin;
  if (!done)
    answer.outcome = ResolverAnswer::Outcome::kSilent;
  else if (!*done)
    answer.reason = done->error().what;
  else if (answer.outcome = outcome_of(*code); *code != 0)
    answer.reason = gai_strerror(*code);
  return answer;
}

}  // namespace dance
