#include "house/program/hosted_program.h"

#include <algorithm>
#include <utility>

#include "core/net/mono_clock.h"
#include "core/program/talk.h"

namespace dance {
namespace {

constexpr Duration kProgramEnds = Duration::s(2);
constexpr Duration kStable = Duration::s(30);  // it ran so long: its death was a chance
constexpr int kWrongUse = 2;
constexpr int kDied = -1;  // by a signal

}  // namespace

HostedProgram::HostedProgram(Options options, Poller& poller)
    : options_(std::move(options)), poller_(poller), words_(poller) {
  is_wanted_ = options_.starts;
  const MonoTime next = is_wanted_ ? start(mono_now()) : MonoTime();
  timer_ = poller.add_timer(next, [this](MonoTime now) { return look(now); });
}

void HostedProgram::set_wanted(bool is_wanted) {
  if (std::exchange(is_wanted_, is_wanted) == is_wanted) return;
  const MonoTime now = mono_now();
  if (!is_wanted && program_ && !asked_to_end_.is_set()) {
    program_->ask_to_stop();
    asked_to_end_ = now;
  }
  if (is_wanted) {
    has_finished_ = false;
    pause_ = Duration();
    trouble_.clear();
    words_.forget();
  }
  // A start that waits for its pause begins at once.
  poller_.set_deadline(timer_, now);
}

MonoTime HostedProgram::wait_for_end(MonoTime now) {
  if (!program_->has_ended()) {
    if (now - asked_to_end_ > kProgramEnds) program_->kill_now();
    return now + options_.look;
  }
  words_.end();
  program_.reset();
  asked_to_end_ = MonoTime();
  return look(now);
}

HostedProgram::~HostedProgram() {
  poller_.remove_timer(timer_);
  if (program_) program_->stop(kProgramEnds);
  words_.end();
}

MonoTime HostedProgram::start(MonoTime now) {
  ChildProcess::Options options{options_.path, options_.arguments(), "/dev/null", ""};
  options.talk_fd = words_.begin();
  auto program = ChildProcess::start(options);
  words_.started();
  if (!program) {
    words_.end();
    return try_later(program.error().what, now);
  }
  program_ = std::make_unique<ChildProcess>(std::move(*program));
  started_ = now;
  works_ = false;
  return now + options_.look;
}

MonoTime HostedProgram::look(MonoTime now) {
  if (asked_to_end_.is_set()) return wait_for_end(now);
  if (!program_) return is_wanted_ ? start(now) : MonoTime();
  if (!program_->has_ended()) {
    if (!works_ && options_.works(program_->pid(), started_)) note_that_it_works();
    return now + options_.look;
  }
  words_.end();
  const std::string end = options_.name + " " + program_->exit_text();
  const int exit_code = program_->exit_code();
  program_.reset();
  if (exit_code == kDied) return start_after_death(end, now);
  if (exit_code != 0 && exit_code != kWrongUse) return try_later(end, now);
  has_finished_ = exit_code == 0;
  talk::warn("{}; the house goes on {}", end, options_.without);
  return {};
}

void HostedProgram::note_that_it_works() {
  works_ = true;
  if (trouble_.empty()) return;
  talk::info("{} works again", options_.name);
  trouble_.clear();
  words_.forget();
}

MonoTime HostedProgram::try_later(const std::string& trouble, MonoTime now) {
  if (std::exchange(trouble_, trouble) != trouble)
    talk::warn("{}; the house goes on {}, and starts it again every {:.3g} s", trouble,
               options_.without, options_.pause.as_seconds());
  return now + options_.pause;
}

MonoTime HostedProgram::start_after_death(const std::string& end, MonoTime now) {
  const bool dies_again = pause_ > Duration() && now - started_ < kStable;
  pause_ = dies_again ? std::min(pause_ * 2, options_.pause) : options_.first_pause;
  trouble_ = end;
  talk::warn("{}; the house goes on {}, and it is started again", end, options_.without);
  return now + pause_;
}

}  // namespace dance
