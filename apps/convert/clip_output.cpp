#include "apps/convert/clip_output.h"

#include <algorithm>
#include <vector>

#include "consumers/output_file.h"
#include "formats/bvh/bvh.h"
#include "formats/recorded/counted.h"
#include "formats/recording/steady_clip.h"

namespace dance {
namespace {

constexpr double kUsualFrames_hz = 60.0;
constexpr std::size_t kMostGuests = 64;

class ClipOutput : public ConvertSink {
 public:
  ClipOutput(const SinkOptions& options, std::size_t most_clips)
      : options_(options), most_clips_(most_clips) {}

  void on_skeleton(const GuestId& guest, const Skeleton& skeleton, std::int64_t) override {
    if (SteadyClip* clip = clip_of(guest)) clip->set_skeleton(skeleton);
  }
  void on_pose(const GuestId& guest, const Pose& pose, std::int64_t) override {
    if (SteadyClip* clip = clip_of(guest)) clip->add(pose);
  }
  void on_hands(const GuestId& guest, const Hands& hands, std::int64_t) override {
    if (SteadyClip* clip = clip_of(guest)) clip->add(hands);
  }
  void on_beat(const Beat&, std::int64_t) override {}

  std::uint64_t frames() const override {
    std::uint64_t count = 0;
    for (const Guest& guest : guests_)
      if (guest.clip) count += guest.clip->body().frames.size();
    return count;
  }
  std::string left_out() const override {
    return listed({{all_counters().beyond_bound, "frames beyond an hour at 60 Hz"},
                   {beyond_guests_, "messages of too many guests"}});
  }
  std::string note() const override {
    return listed({{all_counters().gaps, "silences cut out"},
                   {all_counters().not_newer, "poses and hands that were not newer"}});
  }

 protected:
  SteadyClip::Counters all_counters() const {
    SteadyClip::Counters all;
    for (const Guest& guest : guests_) {
      if (!guest.clip) continue;
      all.not_newer += guest.clip->counters().not_newer;
      all.gaps += guest.clip->counters().gaps;
      all.beyond_bound += guest.clip->counters().beyond_bound;
    }
    return all;
  }

  struct Guest {
    GuestId id;
    std::unique_ptr<SteadyClip> clip;  // none of guests beyond most_clips_
  };

  SteadyClip* clip_of(const GuestId& id) {
    auto found = std::find_if(guests_.begin(), guests_.end(),
                              [&](const Guest& each) { return each.id == id; });
    if (found == guests_.end()) {
      if (guests_.size() == kMostGuests) {
        ++beyond_guests_;
        return nullptr;
      }
      const double hz = options_.hz > 0.0 ? options_.hz : kUsualFrames_hz;
      auto clip = guests_.size() < most_clips_ ? std::make_unique<SteadyClip>(hz) : nullptr;
      found = guests_.insert(guests_.end(), {id, std::move(clip)});
    }
    return found->clip.get();
  }

  SinkOptions options_;
  std::size_t most_clips_;
  std::vector<Guest> guests_;
  std::uint64_t beyond_guests_ = 0;
};

class BvhOutput : public ClipOutput {
 public:
  explicit BvhOutput(const SinkOptions& options) : ClipOutput(options, 1) {}

  Result<void> finish() override {
    if (guests_.empty()) return fail(options_.name + ": not written, as nobody dances");
    if (guests_.size() > 1) {
      std::string names;
      for (const Guest& guest : guests_)
        names += (names.empty() ? "" : ", ") + std::string(guest.id.view());
      return fail(options_.name + ": a BVH holds one dancer, and here are " + names +
                  "; choose with --guest, or write a .glb");
    }
    DANCE_TRY(const auto file, OutputFile::open(options_.path));
    file->write(write_bvh(guests_[0].clip->with_hands()));
    return file->flush();
  }
};

}  // namespace

std::unique_ptr<ConvertSink> make_bvh_output(const SinkOptions& options) {
  return std::make_unique<BvhOutput>(options);
}

}  // namespace dance
