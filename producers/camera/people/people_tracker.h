// PeopleTracker: which body of a picture is whose, for two to four people before one camera, also
// while they cross, touch, hide each other and turn. Each keeps the number that it was given first.
//
//   the region of each → its body → whose body it is → whose limbs they are → next regions
//
// Units/frames: pixels as producers/camera/region/picture_region.h has them; times are those of
//               the frames.
// Ownership:    plain value, no heap.
// Threads:      one owner.
// Failure:      none; a person who is hidden is not found until seen apart from the others.
#pragma once

#include <array>
#include <cstdint>
#include <span>

#include "producers/camera/people/limb_owner.h"
#include "producers/camera/people/person_track.h"

namespace dance {

constexpr std::size_t kMostDancers = 4;

struct PeopleOptions {
  std::size_t people = 2;  // 1…kMostDancers
  float least_presence = 0.5f;
  // How often the whole picture is searched while somebody is missing.
  Duration search_interval = Duration::ms(100);
  // For so long after a loss the network looks in every picture where the person is expected.
  Duration probe_for = Duration::s(1);
  // After so long out of sight a person's place says nothing any more, who comes may be another.
  Duration forget_after = Duration::s(10);
};

struct PersonInPicture {
  bool is_found = false;
  bool is_new = false;  // nothing before belongs to this body
  BodyRegion region;    // that the network looked at
  SeenBody body;
  std::bitset<kLandmarkCount> is_covered;  // points that another person hides
};

struct PeopleCounters {
  std::uint64_t pictures = 0;
  std::uint64_t searches = 0;    // of whole pictures
  std::uint64_t reads = 0;       // of regions
  std::uint64_t duplicates = 0;  // two regions that had come to one body
  std::uint64_t exchanged = 0;   // identities that were put right
  std::uint64_t reassigned = 0;  // bodies on another's course, given to that one
  std::uint64_t limbs_hidden = 0;
};

class PeopleTracker {
 public:
  explicit PeopleTracker(const PeopleOptions& options) : options_(options) {}

  // One picture. With `reads` false for a person, the network does not look for that one in this
  // picture (the load is too high), who is still known to be there: nothing is said of that one.
  using Reads = std::array<bool, kMostDancers>;
  std::span<const PersonInPicture> update(PeopleVision& vision, MonoTime now,
                                          const Reads& reads = {true, true, true, true});
  // Another picture size: nothing before says anything.
  void reset();
  // The camera was away: all are searched for, and known by their clothes.
  void lose_all();

  std::size_t people() const { return options_.people; }
  const PersonTrack& track(std::size_t person) const { return tracks_[person]; }
  const PeopleCounters& counters() const { return counters_; }

 private:
  using Looks = std::array<PersonLook, kMostDancers>;
  struct Candidate {
    BodyRegion region;
    ReadBody seen;
    PersonLook look;
  };

  // Of `person`, if it is one who was seen in the last picture.
  bool read(PeopleVision& vision, const BodyRegion& region, MonoTime now,
            std::optional<std::size_t> person, ReadBody& out);
  void read_tracked(PeopleVision& vision, MonoTime now, const Reads& reads);
  void take(std::size_t person, const BodyRegion& region, const ReadBody& seen, bool is_new);
  void reassign_bodies(MonoTime now, const Reads& reads);
  void separate_duplicates(PeopleVision& vision, MonoTime now);
  // As seen in this picture, or in the last one by a person who is left out of this; null: missing.
  const SeenBody* present(std::size_t person) const;
  bool is_of_somebody(const SeenBody& body) const;
  void forget(std::size_t person);
  void probe_missing(PeopleVision& vision, MonoTime now, const Reads& reads);
  std::optional<BodyRegion> region_to_probe(PeopleVision& vision, std::size_t person,
                                            MonoTime now) const;
  std::optional<float> middle_of_colours(PeopleVision& vision, std::size_t person,
                                         const BodyRegion& region) const;
  void search(PeopleVision& vision, MonoTime now, const Reads& reads);
  std::size_t find_candidates(PeopleVision& vision, MonoTime now, std::size_t wanted,
                              bool only_by_look);
  // Of the tracked, who is nearest to the camera first.
  std::array<std::size_t, kMostDancers> from_front() const;
  float cost_of(std::size_t person, const Candidate& candidate, MonoTime now,
                bool only_by_look) const;
  void judge_identities(PeopleVision& vision, MonoTime now);
  bool is_refused(std::size_t person, const PersonLook& look);
  float evidence_of_exchange(std::size_t a, std::size_t b, const Looks& looks) const;
  // How far apart the middles of two persons are, in sides of their regions.
  float distance(std::size_t a, std::size_t b, MonoTime now) const;
  void exchange(std::size_t a, std::size_t b);
  void resolve_all_limbs(MonoTime now);
  void hide_covered();

  PeopleOptions options_;
  std::array<PersonTrack, kMostDancers> tracks_;
  std::array<LimbMotion, kMostDancers> limbs_;
  std::array<float, kMostDancers> lowest_px_{};  // of their feet: how near to the camera they are
  std::array<PersonInPicture, kMostDancers> found_;
  std::array<bool, kMostDancers> is_left_out_{};  // of this picture, and tracked
  std::array<Candidate, kMostDancers> candidates_;
  // Of a pair a < b; positive: the two are taken for each other.
  std::array<std::array<float, kMostDancers>, kMostDancers> evidence_{};
  std::array<float, kMostDancers> doubt_{};  // that a region shows the person it is of
  MonoTime last_search_;
  PeopleCounters counters_;
};

}  // namespace dance
