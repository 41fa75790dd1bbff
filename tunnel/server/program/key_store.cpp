#include "tunnel/server/program/key_store.h"

#include <chrono>
#include <thread>

#include "core/program/talk.h"
#include "tunnel/nats/values/nats_store.h"
#include "tunnel/seal/keys/key_files.h"
#include "tunnel/seal/keys/utc_text.h"
#include "tunnel/server/program/cluster/cluster_keys.h"

namespace dance {
namespace {

constexpr int kReads = 20;
constexpr std::chrono::milliseconds kReadAgain{100};

class FileKeyStore final : public KeyStore {
 public:
  explicit FileKeyStore(std::string path) : path_(std::move(path)) {}

  std::string name() const override { return path_; }
  Result<KeyRing> read() override { return load_server_keys(path_); }
  Result<std::optional<PublicKey>> read_server_key() override {
    DANCE_TRY(const PublicKey key, claim_server_key());
    return std::optional(key);
  }
  Result<PublicKey> claim_server_key() override {
    DANCE_TRY(const PrivateKey identity, server_identity(path_));
    return identity.public_key();
  }
  Result<bool> add(const KeyEntry& entry) override {
    return change([&](KeyRing& ring) {
      ring.remove_expired(entry.name.view(), utc_now_s());
      return ring.add(entry);
    });
  }
  Result<bool> invite(const KeyEntry& entry) override {
    return change([&](KeyRing& ring) {
      ring.remove_expired(entry.name.view(), utc_now_s());
      return ring.invite(entry);
    });
  }
  Result<Binding> bind(const std::string& name, const PublicKey& house) override {
    Binding binding = Binding::kUnknown;
    DANCE_TRY([[maybe_unused]] const bool is_written, change([&](KeyRing& ring) {
                const auto settled = ring.settled_binding(name, house, utc_now_s());
                binding = settled ? *settled : ring.bind(name, house, utc_now_s());
                return !settled;
              }));
    return binding;
  }
  Result<bool> remove(const std::string& name) override {
    return change([&](KeyRing& ring) { return ring.remove(name); });
  }

 private:
  // Nothing is written where `work` says that nothing has changed.
  template <class Work>
  Result<bool> change(const Work& work) {
    DANCE_TRY(const FileLock lock, FileLock::of_folder(path_));
    DANCE_TRY(KeyRing ring, read());
    if (!work(ring)) return false;
    ring.forget_invitations(utc_now_s());
    if (auto written = write_secret(path_, ring.text()); !written)
      return tl::make_unexpected(written.error());
    return true;
  }

  std::string path_;
};

class ClusterKeyStore final : public KeyStore {
 public:
  ClusterKeyStore(const NatsOptions& options, const PublicKey& own,
                  std::unique_ptr<NatsStore> store)
      : name_("the cluster at " + shown_urls(options)), own_(own), store_(std::move(store)) {}

  std::string name() const override { return name_; }
  Result<KeyRing> read() override {
    DANCE_TRY(const auto values, store_->read_all());
    ClusterKeys keys;
    for (const auto& [name, value] : values) {
      keys.take(name, value);
      if (const auto wrong = keys.take_wrong()) talk::warn("{}", *wrong);
    }
    KeyRing ring;
    for (const auto& [name, entry] : keys.entries()) ring.add(entry);
    return ring;
  }
  Result<std::optional<PublicKey>> read_server_key() override {
    DANCE_TRY(const auto values, store_->read_all());
    const auto kept = values.find(std::string(kClusterIdentity));
    return kept == values.end() ? std::nullopt : PublicKey::parse(kept->second);
  }
  Result<PublicKey> claim_server_key() override {
    DANCE_TRY(const bool is_first, store_->add(kClusterIdentity, own_.text()));
    if (is_first) {
      talk::info(
          "this machine's server-identity.key is the cluster's from now on: copy it to each "
          "server");
      return own_;
    }
    DANCE_TRY(auto kept, read_server_key());
    // A NATS server may not know yet a value that another one has accepted.
    for (int i = 0; i < kReads && !kept; ++i) {
      std::this_thread::sleep_for(kReadAgain);
      DANCE_TRY(kept, read_server_key());
    }
    if (kept != own_) return fail(other_cluster_identity_line(name_));
    return own_;
  }
  Result<bool> add(const KeyEntry& entry) override {
    DANCE_TRY(const auto values, store_->read_all());
    if (values.size() >= KeyRing::kMost)
      return fail(name_ + " has " + std::to_string(values.size()) + " keys, and takes no more");
    return store_->add(entry.name.view(), line_of(entry));
  }
  Result<bool> invite(const KeyEntry& entry) override {
    return fail(no_invitations_line(entry.name.view()));
  }
  Result<Binding> bind(const std::string&, const PublicKey&) override { return Binding::kNotHere; }
  Result<bool> remove(const std::string& name) override {
    DANCE_TRY(const auto values, store_->read_all());
    // Of a wrong entry too: that is its cure.
    if (!values.contains(name)) return false;
    if (auto erased = store_->erase(name); !erased) return tl::make_unexpected(erased.error());
    return true;
  }

 private:
  std::string name_;
  PublicKey own_;
  std::unique_ptr<NatsStore> store_;
};

}  // namespace

// Its servers may read its keys only: none of them could put another in an invitation's place.
std::string no_invitations_line(std::string_view guest) {
  return "a cluster takes no invitations, as its servers may not write its keys: make a key with "
         "--new-guest " +
         std::string(guest) + ", for the guest to paste into dance key";
}

std::unique_ptr<KeyStore> file_key_store(const std::string& path) {
  return std::make_unique<FileKeyStore>(path);
}

Result<std::unique_ptr<KeyStore>> cluster_key_store(const NatsOptions& options,
                                                    const PublicKey& own) {
  NatsOptions of = options;
  of.bucket = kKeysBucket;
  DANCE_TRY(auto store, NatsStore::connect(of));
  return std::make_unique<ClusterKeyStore>(options, own, std::move(store));
}

}  // namespace dance
