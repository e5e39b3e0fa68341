#include "detection/candidate_selector.h"

#include <gtest/gtest.h>

namespace tet_line_tracker {
namespace {

LineSegment horizontal(float x, float y, float length) {
  return {{x, y}, {x + length, y}};
}

TEST(CandidateSelector, GivesEachCandidateOnce) {
  const std::vector<LineSegment> candidates{horizontal(10, 10, 40), horizontal(300, 200, 60)};
  CandidateSelector chooser;
  chooser.start(800, 600, candidates);
  EXPECT_EQ(chooser.next(), &candidates[1]);
  EXPECT_EQ(chooser.next(), &candidates[0]);
  EXPECT_EQ(chooser.next(), nullptr);
}

TEST(CandidateSelector, PrefersAnEmptyPartOfTheImageToALongerLineInAFullOne) {
  const std::vector<LineSegment> candidates{horizontal(10, 20, 80), horizontal(610, 420, 50)};
  CandidateSelector chooser;
  chooser.start(800, 600, candidates);
  for (int i = 0; i < 5; ++i) chooser.add(horizontal(10, 40.0F + 10.0F * static_cast<float>(i), 80));
  EXPECT_EQ(chooser.next(), &candidates[1]);
}

TEST(CandidateSelector, ALineThatWasTakenMakesItsNeighboursWait) {
  const std::vector<LineSegment> candidates{horizontal(10, 20, 80), horizontal(10, 60, 80),
                                            horizontal(610, 420, 60)};
  CandidateSelector chooser;
  chooser.start(800, 600, candidates);
  EXPECT_EQ(chooser.next(), &candidates[0]);
  chooser.add(candidates[0]);
  EXPECT_EQ(chooser.next(), &candidates[2]);
}

TEST(CandidateSelector, LeavesOutWhatAddsNothingToCellsThatAreFull) {
  const std::vector<LineSegment> candidates{horizontal(10, 20, 50)};
  CandidateSelector chooser;
  chooser.start(800, 600, candidates);
  for (int i = 0; i < 2; ++i) chooser.add(horizontal(5, 40.0F + 10.0F * static_cast<float>(i), 90));
  EXPECT_EQ(chooser.next(), &candidates[0]);
  chooser.start(800, 600, candidates);
  for (int i = 0; i < 4; ++i) chooser.add(horizontal(5, 40.0F + 10.0F * static_cast<float>(i), 90));
  EXPECT_EQ(chooser.next(), nullptr);
}

}  // namespace
}  // namespace tet_line_tracker
