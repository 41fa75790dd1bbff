#include "viewer/avatar/avatar_loader.h"

#include <pthread.h>
#include <sys/resource.h>

#include <exception>
#include <system_error>

#include "core/program/confinement.h"

namespace dance {
namespace {

// As the pictures' own: the programs that send and route go first.
constexpr int kLoadingNiceness = 5;

template <class T>
std::size_t bytes_in(const std::vector<T>& items) {
  return items.capacity() * sizeof(T);
}

}  // namespace

std::size_t size_bytes(const AvatarModel& model) {
  std::size_t sum = sizeof(AvatarModel) + bytes_in(model.nodes) + bytes_in(model.joints) +
                    bytes_in(model.vertices) + bytes_in(model.triangles) + bytes_in(model.parts) +
                    bytes_in(model.materials) + bytes_in(model.springs) + bytes_in(model.colliders);
  for (const AvatarPicture& picture : model.pictures) sum += bytes_in(picture.rgba);
  for (const AvatarMorph& morph : model.morphs)
    sum += bytes_in(morph.vertices) + bytes_in(morph.places_m) + bytes_in(morph.normals);
  return sum;
}

void AvatarJob::run(const AvatarStop& stop) {
  try {
    auto made = make_(stop);
    if (made && !*made) return give_up(made->error().what);
    is_missing_ = !made;
    if (made) {
      size_bytes_ = dance::size_bytes(**made);
      model_ = std::make_shared<const AvatarModel>(std::move(**made));
    }
  } catch (const std::exception& failure) {
    return give_up(unread_because(failure));
  }
  make_ = nullptr;
  is_done_.store(true, std::memory_order_release);
}

void AvatarJob::give_up(std::string why) {
  error_ = std::move(why);
  make_ = nullptr;
  is_done_.store(true, std::memory_order_release);
}

std::shared_ptr<AvatarJob> AvatarJob::empty() {
  auto job = std::make_shared<AvatarJob>(nullptr);
  job->give_up("");
  return job;
}

AvatarLoader::AvatarLoader() {
  try {
    thread_ = std::thread([this] { run(); });
  } catch (const std::system_error&) {
    // start() tells.
  }
}

AvatarLoader::~AvatarLoader() {
  {
    const std::lock_guard lock(mutex_);
    ends_ = true;
  }
  wakes_.notify_all();
  if (thread_.joinable()) thread_.join();
}

std::shared_ptr<AvatarJob> AvatarLoader::start(AvatarJob::Make make) {
  auto job = std::make_shared<AvatarJob>(std::move(make));
  if (!thread_.joinable()) {
    job->give_up("no thread for it could be started");
    return job;
  }
  {
    const std::lock_guard lock(mutex_);
    queue_.push_back(job);
  }
  wakes_.notify_one();
  return job;
}

void AvatarLoader::wait() {
  std::unique_lock lock(mutex_);
  is_idle_.wait(lock, [this] { return queue_.empty() && !is_busy_; });
}

void AvatarLoader::run() {
  pthread_setname_np(pthread_self(), "view-avatars");
  setpriority(PRIO_PROCESS, 0, kLoadingNiceness);  // of this thread alone
  confine_thread();                                // avatars come from strangers
  const AvatarStop stop = [this] { return ends_.load(std::memory_order_relaxed); };
  std::unique_lock lock(mutex_);
  while (true) {
    wakes_.wait(lock, [this] { return ends_ || !queue_.empty(); });
    if (ends_) return;
    std::shared_ptr<AvatarJob> job = std::move(queue_.front());
    queue_.pop_front();
    is_busy_ = true;
    lock.unlock();
    if (job.use_count() > 1) job->run(stop);
    job.reset();
    lock.lock();
    is_busy_ = false;
    if (queue_.empty()) is_idle_.notify_all();
  }
}

}  // namespace dance
