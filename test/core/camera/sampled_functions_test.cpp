#include "camera/sampled_functions.h"

#include <array>
#include <cmath>
#include <limits>

#include <gtest/gtest.h>

namespace tet_line_tracker {
namespace {

TEST(SampledFunctions, AreAsCloseAsTheyAreTrustedToBe) {
  const auto exact = [](double x) { return std::array<double, 2>{std::sin(x), std::exp(-x)}; };
  const SampledFunctions<2> sampled(exact, 3.0, 300, 1e-9);
  for (double x = 0.0; x < 3.0; x += 0.00137) {
    ASSERT_TRUE(sampled.knows(x));
    for (std::size_t k = 0; k < 2; ++k) ASSERT_NEAR(sampled.at(x)[k], exact(x)[k], 2e-9) << x;
  }
  EXPECT_FALSE(sampled.knows(3.0));
  EXPECT_FALSE(sampled.knows(std::numeric_limits<double>::quiet_NaN()));
}

TEST(SampledFunctions, AreNotTrustedWhereTheFunctionIsTooSteep) {
  // A square root rises without bound at 2.
  const auto exact = [](double x) { return std::array<double, 1>{std::sqrt(std::fabs(2.0 - x))}; };
  const SampledFunctions<1> sampled(exact, 3.0, 300, 1e-9);
  EXPECT_FALSE(sampled.knows(2.0));
  EXPECT_FALSE(sampled.knows(2.5)) << "smooth again, but behind what is not";
  int known = 0;
  for (double x = 0.0; sampled.knows(x); x += 0.001) {
    ++known;
    ASSERT_NEAR(sampled.at(x)[0], exact(x)[0], 2e-9) << x;
  }
  EXPECT_GT(known, 1000);
}

TEST(SampledFunctions, KnowNothingOfARangeThatIsNone) {
  const auto exact = [](double x) { return std::array<double, 1>{x}; };
  for (const double last : {0.0, -1.0, std::numeric_limits<double>::infinity(),
                            std::numeric_limits<double>::quiet_NaN(), 1e-320}) {
    const SampledFunctions<1> sampled(exact, last, 10, 1e-9);
    EXPECT_FALSE(sampled.knows(0.0)) << last;
  }
}

}  // namespace
}  // namespace tet_line_tracker
