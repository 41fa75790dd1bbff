// HandContacts: hands that touch another hand or a partner's body do so on the avatars too. For
// each pair of palms, and each palm and body, that are near each other in the dance, the place of
// one seen from the other is kept; far apart hands are left where the retargeting put them, and
// between there is a smooth transition by distance. Both hands of a pair move half of the way,
// unless one cannot reach: then the other comes the rest.
//
// Units/frames: metres in W. A palm is 40 % of the way from the wrist to the finger tips.
// Ownership:    keeps its lists from picture to picture; allocates only when there are more figures
//               than ever before.
// Threads:      none inside.
// Failure:      beyond kMostContacts the furthest pairs in order are left as they are.
// Source:       Jacobi iterations over the pairs, projected onto what each arm reaches (Müller et
//               al., Position based dynamics, 2007).
#pragma once

#include <cstdint>
#include <span>
#include <utility>
#include <vector>

#include "viewer/figure/figure_fit.h"

namespace dance {

class HandContacts {
 public:
  static constexpr std::size_t kMostContacts = 4096;

  void reserve(std::size_t figures);
  // Moves arms, and shoulders and backs where arms alone do not reach.
  void fit(std::span<FigureFit> figures);

 private:
  struct Hand {
    Eigen::Vector3f danced_W_m;  // the palm
    Eigen::Vector3f natural_W_m;
    Eigen::Vector3f wanted_W_m;
    Eigen::Vector3f shoulder_W_m;
    Eigen::Vector3f from_palm_m;  // to the wrist
    Eigen::Vector3f pull = Eigen::Vector3f::Zero();
    float pull_weight = 0.0f;
    float held = 0.0f;                                  // the weight of the pair that counts most
    Eigen::Vector3f danced_arm_m;                       // from the shoulder to the wrist
    Eigen::Vector3f outward = Eigen::Vector3f::Zero();  // to where hands go that are too near
    float reach_m = 0.0f;
    float folded_m = 0.0f;  // the wrist gets no nearer to the shoulder
    float help_m = 0.0f;    // by which shoulder, back and stretch may add to it
  };
  struct Contact {
    std::uint32_t a = 0;  // hands
    std::int32_t b = -1;  // or a body
    // From a to b as danced; or, of a body, the place for a's palm.
    Eigen::Vector3f wanted_m;
    float weight = 0.0f;
  };

  void list_hands(std::span<const FigureFit> figures);
  void find(std::span<const FigureFit> figures);
  void settle_shares();
  void add_pair(std::size_t a, std::size_t b);
  void add_body(std::size_t hand, const FigureFit& body);
  bool is_off() const;
  Eigen::Vector3f shown_correction(const Hand& hand, const FigureFit& figure,
                                   std::size_t side) const;
  void relax(bool with_help);
  static Eigen::Vector3f reachable(const Hand& hand, const Eigen::Vector3f& palm_W_m, float help_m);

  std::vector<Hand> hands_;  // two of each figure
  std::vector<Contact> contacts_;
  std::vector<std::pair<std::uint32_t, std::uint32_t>> near_;  // figures
};

}  // namespace dance
