#include "formats/avatar/make/skirt_maker.h"

#include <array>
#include <cmath>

#include "formats/body/implicit_surface.h"

namespace dance {

using Eigen::Vector3f;

namespace {

constexpr float kBandHalf_m = 0.025f;

Vector3f direction(float turn) { return {std::sin(turn), 0.0f, std::cos(turn)}; }

// What of a skirt hangs from the hips, before its chains begin.
constexpr float kChainBegins = 0.1f;

// Ties a vertex between two chains, `aside` of the way to the second, to their joints there. Joint
// j turns what hangs between it and the next.
void hang(AvatarVertex& vertex, float down, const std::vector<int>& left,
          const std::vector<int>& right, float aside) {
  const auto joints_of = static_cast<int>(left.size());
  const float at =
      (down - kChainBegins) / (1.0f - kChainBegins) * static_cast<float>(joints_of - 1);
  if (at <= 0.0f) {
    tie(vertex, kHipsJoint);
    return;
  }
  const float from_middle = std::clamp(at - 0.5f, -1.0f, static_cast<float>(joints_of - 2));
  const int above = static_cast<int>(std::floor(from_middle));
  const float share = from_middle - static_cast<float>(above);
  const auto joint = [&](const std::vector<int>& of, int j) {
    return j < 0 ? kHipsJoint : of[static_cast<std::size_t>(std::min(j, joints_of - 2))];
  };
  const std::array<int, 4> joints{joint(left, above), joint(right, above), joint(left, above + 1),
                                  joint(right, above + 1)};
  const std::array<float, 4> shares{(1 - share) * (1 - aside), (1 - share) * aside,
                                    share * (1 - aside), share * aside};
  int rest = 255;
  for (std::size_t k = 0; k < 4; ++k) {
    const int weight = std::min(rest, static_cast<int>(std::lround(255.0f * shares[k])));
    vertex.joints[k] = static_cast<std::uint16_t>(weight > 0 ? joints[k] : 0);
    vertex.weights[k] = static_cast<std::uint8_t>(weight);
    rest -= weight;
  }
  vertex.weights[0] = static_cast<std::uint8_t>(vertex.weights[0] + rest);
  if (rest > 0) vertex.joints[0] = static_cast<std::uint16_t>(joints[0]);
}

}  // namespace

SkirtMaker::SkirtMaker(const Skeleton& skeleton, std::span<const FigureLayer> clothes)
    : weighting_(skeleton), places_(skeleton), clothes_(clothes) {}

float SkirtMaker::waist_y_m(float turn) const {
  return places_.at(Bone::kHips).y() + places_.scale * (0.092f + 0.008f * std::cos(turn));
}

float SkirtMaker::radius_m(float turn, float y_m) const {
  constexpr int kHalvings = 14;
  float most_m = 0.0f;
  const Vector3f axis(0.0f, y_m, places_.at(Bone::kHips).z());
  for (const FigureLayer& layer : clothes_) {
    float inside_m = 0.0f;
    float outside_m = places_.scale * 0.3f;
    for (int i = 0; i < kHalvings; ++i) {
      const float r = 0.5f * (inside_m + outside_m);
      (signed_distance_m(layer, axis + r * direction(turn)) < 0.0f ? inside_m : outside_m) = r;
    }
    most_m = std::max(most_m, inside_m);
  }
  return most_m;
}

Vector3f SkirtMaker::around(float turn, float y_m, float lift_m) const {
  const Vector3f axis(0.0f, y_m, places_.at(Bone::kHips).z());
  return axis + (radius_m(turn, y_m) + places_.scale * lift_m) * direction(turn);
}

Sheet SkirtMaker::band() const {
  constexpr int kColumns = 28;
  constexpr int kRows = 5;
  constexpr std::array<float, kRows> kHeights{-1.0f, -0.85f, 0.0f, 0.85f, 1.0f};
  constexpr std::array<float, kRows> kLifts_m{0.0f, 0.005f, 0.0075f, 0.005f, 0.0f};
  FigureLayer as_top;
  as_top.skinning = FigureSkinning::kTop;
  Sheet sheet;
  for (int row = 0; row < kRows; ++row)
    for (int column = 0; column < kColumns; ++column) {
      const float turn = kTwoPi * static_cast<float>(column) / kColumns;
      const auto r = static_cast<std::size_t>(row);
      const float y_m = waist_y_m(turn) + places_.scale * kBandHalf_m * kHeights[r];
      AvatarVertex vertex = vertex_at(around(turn, y_m, kLifts_m[r]));
      const SkinWeights skin = weighting_.weights_at(vertex.place_m, as_top);
      for (std::size_t k = 0; k < 4; ++k) vertex.joints[k] = skin.joints[k];
      vertex.weights = skin.weights;
      sheet.vertices.push_back(vertex);
    }
  join_rows(sheet, 0, kRows, kColumns, RowEnds::kJoined);
  set_normals(sheet);
  return sheet;
}

// From waist to hem: close to the hips, then out.
Vector3f SkirtMaker::skirt_place_m(float turn, float down, float fold) const {
  const float scale = places_.scale;
  const float hem_y_m = places_.at(Bone::kLeftLowerLeg).y() + scale * 0.02f;
  const float top_m = waist_y_m(turn);
  const float y_m = top_m + down * (hem_y_m - top_m);
  const float close_m = radius_m(turn, std::max(y_m, places_.at(Bone::kHips).y())) +
                        scale * (0.004f + 0.03f * smooth_step(0.0f, 0.3f, down));
  const float flare_m = scale * 0.19f * std::pow(down, 1.25f);
  const float folds = 1.0f + fold * 0.06f * smooth_step(0.1f, 1.0f, down);
  return Vector3f(0.0f, y_m, places_.at(Bone::kHips).z()) +
         (close_m + flare_m) * folds * direction(turn);
}

Sheet SkirtMaker::skirt(ModelBuilder& builder, const std::vector<std::uint32_t>& colliders) const {
  constexpr int kChains = 12;
  constexpr int kJoints = 5;  // of a chain; the last is its end
  constexpr int kColumnsOfChain = 4;
  constexpr int kRows = 9;
  constexpr int kColumns = kChains * kColumnsOfChain;
  constexpr float kFolds = 8.0f;
  std::vector<std::vector<int>> chains;
  for (int c = 0; c < kChains; ++c) {
    const float turn = kTwoPi * static_cast<float>(c) / kChains;
    std::vector<int> chain;
    for (int j = 0; j < kJoints; ++j) {
      const float down =
          kChainBegins + (1.0f - kChainBegins) * static_cast<float>(j) / (kJoints - 1);
      chain.push_back(builder.add_node(
          "skirt" + std::to_string(c + 1) + "-" + std::to_string(j + 1),
          chain.empty() ? kHipsJoint : chain.back(), skirt_place_m(turn, down, 0)));
    }
    builder.add_spring(chain, {0.5f, 0.4f, 0.3f, places_.scale * 0.035f}, colliders);
    chains.push_back(std::move(chain));
  }
  Sheet sheet;
  for (int row = kRows - 1; row >= 0; --row)
    for (int column = 0; column <= kColumns; ++column) {  // the last lies on the first
      const float turn = kTwoPi * static_cast<float>(column % kColumns) / kColumns;
      const float down = static_cast<float>(row) / (kRows - 1);
      AvatarVertex vertex = vertex_at(skirt_place_m(turn, down, std::cos(kFolds * turn)),
                                      {8.0f * static_cast<float>(column) / kColumns, 3.2f * down});
      const int chain = column % kColumns / kColumnsOfChain;
      hang(vertex, down, chains[static_cast<std::size_t>(chain)],
           chains[static_cast<std::size_t>((chain + 1) % kChains)],
           static_cast<float>(column % kColumnsOfChain) / kColumnsOfChain);
      sheet.vertices.push_back(vertex);
    }
  join_rows(sheet, 0, kRows, kColumns + 1, RowEnds::kOpen);
  set_normals(sheet);
  return sheet;
}

Vector3f SkirtMaker::sash_middle_m(const SashEnd& end, float down) const {
  const float top_m = waist_y_m(end.turn);
  const float y_m = top_m - down * end.length_m;
  const auto out_m = [](const Vector3f& p) { return std::hypot(p.x(), p.z()); };
  // It hangs from where the hips are widest.
  Vector3f place = around(end.turn, y_m, end.lift_m);
  for (float above_m = y_m; above_m < top_m; above_m += 0.02f) {
    const Vector3f higher = around(end.turn, above_m, end.lift_m);
    if (out_m(higher) > out_m(place)) place = Vector3f(higher.x(), y_m, higher.z());
  }
  return place;
}

Sheet SkirtMaker::sash_end(const SashEnd& end, const std::vector<int>& chain) const {
  constexpr int kRows = 10;
  constexpr int kColumns = 4;
  const auto last = static_cast<float>(chain.size() - 1);
  const float scale = places_.scale;
  const Vector3f aside = direction(end.turn + 0.25f * kTwoPi);
  Sheet sheet;
  for (int row = kRows - 1; row >= 0; --row)
    for (int column = 0; column < kColumns; ++column) {
      const float down = static_cast<float>(row) / (kRows - 1);
      const float across = 2.0f * static_cast<float>(column) / (kColumns - 1) - 1.0f;
      const float half_m = scale * 0.032f * (0.45f + 0.55f * smooth_step(0.0f, 0.35f, down));
      const float wave_m = scale * 0.004f * std::sin(3.0f * across + 6.0f * down);
      // Cut at a slant.
      const float slant_m = down > 0.95f ? scale * 0.02f * across : 0.0f;
      AvatarVertex vertex =
          vertex_at(sash_middle_m(end, down) + across * half_m * aside +
                        wave_m * direction(end.turn) + slant_m * Vector3f::UnitY(),
                    {across, down});
      const float at = std::clamp(down * last - 0.5f, 0.0f, last - 1.0f);
      const auto above = static_cast<std::size_t>(at);
      tie(vertex, chain[above], chain[std::min(above + 1, chain.size() - 2)],
          at - static_cast<float>(above));
      if (row == 0) tie(vertex, kHipsJoint);
      sheet.vertices.push_back(vertex);
    }
  join_rows(sheet, 0, kRows, kColumns, RowEnds::kOpen);
  set_normals(sheet);
  return sheet;
}

Sheet SkirtMaker::sash_ends(ModelBuilder& builder,
                            const std::vector<std::uint32_t>& colliders) const {
  constexpr int kJoints = 4;
  const float scale = places_.scale;
  const std::array<SashEnd, 2> ends{
      {{0.62f, scale * 0.34f, 0.016f}, {0.86f, scale * 0.28f, 0.012f}}};
  Sheet sheet;
  for (std::size_t e = 0; e < ends.size(); ++e) {
    std::vector<int> chain;
    for (int j = 0; j < kJoints; ++j)
      chain.push_back(
          builder.add_node("sash" + std::to_string(e + 1) + "-" + std::to_string(j + 1),
                           chain.empty() ? kHipsJoint : chain.back(),
                           sash_middle_m(ends[e], static_cast<float>(j) / (kJoints - 1))));
    builder.add_spring(chain, {0.25f, 0.5f, 0.3f, scale * 0.012f}, colliders);
    add_to(sheet, sash_end(ends[e], chain));
  }
  return sheet;
}

Sheet SkirtMaker::collar() const {
  constexpr int kColumns = 22;
  const Vector3f neck = places_.at(Bone::kNeck);
  const float scale = places_.scale;
  FigureLayer as_top;
  as_top.skinning = FigureSkinning::kBody;
  // Up from the shirt, and folded down outside; open in front.
  constexpr std::array<float, 4> kHeights_m{0.026f, 0.046f, 0.07f, 0.03f};
  constexpr std::array<float, 4> kRadii_m{0.082f, 0.076f, 0.064f, 0.058f};
  Sheet sheet;
  for (std::size_t row = 0; row < 4; ++row)
    for (int column = 0; column < kColumns; ++column) {
      const float t = static_cast<float>(column) / (kColumns - 1);
      const float turn = 0.32f + (kTwoPi - 0.64f) * t;
      const float front = 0.5f + 0.5f * std::cos(turn);
      const float point_m = row == 0 ? 0.035f * front * front * front : 0.0f;
      const float r = scale * (kRadii_m[row] + (row == 0 ? 0.01f * front : 0.0f));
      const Vector3f place =
          neck + scale * Vector3f(0, kHeights_m[row] - point_m - 0.026f * front, 0.006f) +
          r * Vector3f(std::sin(turn) * 1.02f, 0.0f, std::cos(turn) * 0.96f);
      AvatarVertex vertex = vertex_at(place);
      const SkinWeights skin = weighting_.weights_at(neck + 0.5f * (place - neck), as_top);
      for (std::size_t k = 0; k < 4; ++k) vertex.joints[k] = skin.joints[k];
      vertex.weights = skin.weights;
      sheet.vertices.push_back(vertex);
    }
  join_rows(sheet, 0, 4, kColumns, RowEnds::kOpen);
  set_normals(sheet);
  return sheet;
}

}  // namespace dance
