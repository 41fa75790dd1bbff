// The thread that writes what houses make of invitations.
#include "tunnel/server/program/invitation_keeper.h"

#include <gtest/gtest.h>

#include <condition_variable>
#include <map>

#include "core/net/mono_clock.h"

namespace dance {
namespace {

// A store that is as slow as the test wants, and fails for one guest.
class SlowStore final : public KeyStore {
 public:
  std::string name() const override { return "slow"; }
  Result<KeyRing> read() override { return KeyRing(); }
  Result<std::optional<PublicKey>> read_server_key() override { return std::optional<PublicKey>(); }
  Result<PublicKey> claim_server_key() override { return PublicKey(); }
  Result<bool> add(const KeyEntry&) override { return false; }
  Result<bool> invite(const KeyEntry&) override { return false; }
  Result<bool> remove(const std::string&) override { return false; }
  Result<Binding> bind(const std::string& name, const PublicKey&) override {
    std::unique_lock lock(mutex_);
    ++begun_;
    changed_.notify_all();
    changed_.wait(lock, [this] { return is_open_; });
    if (name == "carol") return fail("the disk is full");
    return Binding::kBound;
  }
  void open() {
    const std::lock_guard lock(mutex_);
    is_open_ = true;
    changed_.notify_all();
  }
  void wait_for_first() {
    std::unique_lock lock(mutex_);
    changed_.wait(lock, [this] { return begun_ > 0; });
  }
  int begun() {
    const std::lock_guard lock(mutex_);
    return begun_;
  }

 private:
  std::mutex mutex_;
  std::condition_variable changed_;
  bool is_open_ = false;
  int begun_ = 0;
};

class Keeping : public ::testing::Test {
 protected:
  void SetUp() override {
    auto made = Poller::create();
    ASSERT_TRUE(made);
    poller_ = std::move(*made);
    auto store = std::make_unique<SlowStore>();
    store_ = store.get();
    keeper_ =
        std::make_unique<InvitationKeeper>(std::move(store), *WakeEvent::create(), *poller_,
                                           [this](const InvitationKeeper::Kept& kept) {
                                             kept_.emplace(std::string(kept.guest.view()), kept);
                                           });
  }
  void turn_until(std::size_t count) {
    const MonoTime given_up = mono_now() + Duration::s(60);
    while (kept_.size() < count && mono_now() < given_up) poller_->run_once(Duration::ms(5));
  }
  static GuestId guest(const std::string& name) { return *GuestId::parse(name); }

  std::unique_ptr<Poller> poller_;
  SlowStore* store_ = nullptr;
  std::unique_ptr<InvitationKeeper> keeper_;
  std::multimap<std::string, InvitationKeeper::Kept> kept_;
};

TEST_F(Keeping, AHouseThatAsksAgainWaitsForTheFirstAnswer) {
  const PublicKey key = PrivateKey::make().public_key();
  keeper_->bind(7, guest("alice"), key);
  store_->wait_for_first();
  for (int i = 0; i < 10; ++i) keeper_->bind(8, guest("alice"), PrivateKey::make().public_key());
  keeper_->bind(9, guest("bob"), key);
  keeper_->bind(10, guest("carol"), key);
  store_->open();
  turn_until(3);
  EXPECT_EQ(kept_.size(), 3u);
  ASSERT_EQ(kept_.count("alice"), 1u);
  EXPECT_EQ(kept_.find("alice")->second.peer, 7u);
  EXPECT_EQ(*kept_.find("bob")->second.binding, Binding::kBound);
  ASSERT_FALSE(kept_.find("carol")->second.binding);
  EXPECT_EQ(kept_.find("carol")->second.binding.error().what, "the disk is full");
}

TEST_F(Keeping, NoMoreWaitThanAreAllowed) {
  for (int i = 0; i < 500; ++i)
    keeper_->bind(1, guest("guest-" + std::to_string(i)), PrivateKey::make().public_key());
  store_->wait_for_first();
  store_->open();
  turn_until(InvitationKeeper::kMost);
  EXPECT_EQ(kept_.size(), InvitationKeeper::kMost);
  EXPECT_EQ(store_->begun(), static_cast<int>(InvitationKeeper::kMost));
}

TEST_F(Keeping, EndsWithWishesThatWait) {
  for (int i = 0; i < 20; ++i)
    keeper_->bind(1, guest("guest-" + std::to_string(i)), PrivateKey::make().public_key());
  store_->wait_for_first();
  store_->open();
  keeper_.reset();
  EXPECT_TRUE(kept_.empty());
}

}  // namespace
}  // namespace dance
