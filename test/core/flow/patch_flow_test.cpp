#include "flow/patch_flow.h"

#include <array>

#include <gtest/gtest.h>

namespace tet_line_tracker {
namespace {

TEST(GemanMcClureWeights, APatchThatIsMuchWorseThanTheOthersHardlyCounts) {
  std::array<PatchMatch, 5> matches;
  for (PatchMatch& match : matches) match.square = 100.0F;
  matches[2].square = 2500.0F;
  computeGemanMcClureWeights(matches.data(), matches.size());
  EXPECT_NEAR(matches[0].weight, 1.0F / (1.444F * 1.444F), 1e-3F);
  EXPECT_LT(matches[2].weight, 0.02F * matches[0].weight);
}

TEST(GemanMcClureWeights, PatchesThatAllMatchCountAlike) {
  // Below the noise that any picture has, differences between patches say nothing.
  std::array<PatchMatch, 4> matches;
  for (std::size_t i = 0; i < matches.size(); ++i) matches[i].square = 0.05F * static_cast<float>(i);
  computeGemanMcClureWeights(matches.data(), matches.size());
  for (const PatchMatch& match : matches) EXPECT_GT(match.weight, 0.95F);
}

/// Patches whose gradients see a movement of the ends by m1 and m2: the steps that undo it are known.
class JointEquationsTest : public testing::Test {
 protected:
  JointEquationsTest() {
    const float fractions[] = {0.0F, 0.3F, 0.6F, 1.0F};
    for (std::size_t i = 0; i < patches_.size(); ++i) {
      patches_[i].fraction = fractions[i];
      patches_[i].reference.xx = 100.0F + 10.0F * static_cast<float>(i);
      patches_[i].reference.xy = 20.0F - 15.0F * static_cast<float>(i);
      patches_[i].reference.yy = 80.0F;
    }
  }

  /// What the patch at `i` says when it must still move by (1 - s) m1 + s m2.
  PatchMatch match(std::size_t i, const Eigen::Vector2f& m1, const Eigen::Vector2f& m2) const {
    const Patch& patch = patches_[i];
    PatchMatch match;
    match.patch = &patch;
    const Eigen::Vector2f missing = (1.0F - patch.fraction) * m1 + patch.fraction * m2;
    match.slope = -(SymmetricMatrix{patch.reference.xx, patch.reference.xy, patch.reference.yy} * missing);
    return match;
  }

  std::array<Patch, 4> patches_;
};

TEST_F(JointEquationsTest, GiveTheMovementsOfBothEndsThatAllPatchesAgreeOn) {
  const Eigen::Vector2f m1(1.5F, -0.5F);
  const Eigen::Vector2f m2(-0.7F, 2.0F);
  JointEquations equations;
  for (std::size_t i = 0; i < patches_.size(); ++i) equations.add(match(i, m1, m2));
  const auto [start, end] = equations.solve();
  EXPECT_LT((start - m1).norm(), 1e-3F);
  EXPECT_LT((end - m2).norm(), 1e-3F);
}

TEST_F(JointEquationsTest, AMatchCountsByItsWeight) {
  const Eigen::Vector2f m1(1.5F, -0.5F);
  const Eigen::Vector2f m2(-0.7F, 2.0F);
  JointEquations equations;
  for (std::size_t i = 0; i < patches_.size(); ++i) equations.add(match(i, m1, m2));
  PatchMatch wrong = match(1, {-9.0F, 9.0F}, {9.0F, 9.0F});
  wrong.weight = 1e-5F;
  equations.add(wrong);
  const auto [start, end] = equations.solve();
  EXPECT_LT((start - m1).norm(), 1e-2F);
  EXPECT_LT((end - m2).norm(), 1e-2F);
}

TEST_F(JointEquationsTest, ThePriorPullsEndsBackToWhereTheyAreExpected) {
  const LineSegment expected{{10.0F, 10.0F}, {60.0F, 10.0F}};
  const LineSegment segment{{13.0F, 10.0F}, {60.0F, 14.0F}};
  JointEquations equations;
  equations.addPrior(segment, expected, 50.0F);
  const auto [start, end] = equations.solve();
  EXPECT_LT((start - Eigen::Vector2f(-3.0F, 0.0F)).norm(), 1e-4F);
  EXPECT_LT((end - Eigen::Vector2f(0.0F, -4.0F)).norm(), 1e-4F);
}

}  // namespace
}  // namespace tet_line_tracker
