#include "kernels/kernels.h"

#include <algorithm>
#include <cmath>
#include <cstring>
#include <random>
#include <vector>

#include <gtest/gtest.h>

namespace tet_line_tracker {
namespace kernels {
namespace {

constexpr int kWidth = 64;
constexpr int kHeight = 64;

std::vector<std::uint8_t> noise() {
  std::mt19937 generator(3);
  std::vector<std::uint8_t> pixels(kWidth * kHeight);
  for (std::uint8_t& pixel : pixels) pixel = static_cast<std::uint8_t>(generator() & 255U);
  return pixels;
}

struct Template {
  explicit Template(const PatchShape& shape) : values(static_cast<std::size_t>(3 * shape.floats()), 0.0F) {
    patch.gray = values.data();
    patch.gradient_x = values.data() + shape.floats();
    patch.gradient_y = values.data() + 2 * shape.floats();
  }
  std::vector<float> values;
  PatchTemplate patch{};
};

PatchPlace placeAt(const std::vector<std::uint8_t>& image, int x, int y, float fx, float fy) {
  return {image.data() + y * kWidth + x, kWidth, fx, fy};
}

TEST(Kernels, ReadAPatchByBilinearInterpolation) {
  const std::vector<std::uint8_t> image = noise();
  const PatchShape shape = PatchShape::ofSide(7);
  Template nothing(shape);
  std::vector<float> patch(static_cast<std::size_t>(shape.floats()));
  AlignmentSums sums{};
  active().align(placeAt(image, 11, 20, 0.3F, 0.8F), shape, nothing.patch, patch.data(), &sums);
  Template made(shape);
  active().makeTemplate(placeAt(image, 10, 19, 0.3F, 0.8F), shape, false, &made.patch);
  const auto between = [&image](int x, int y) {
    const auto at = [&image](int px, int py) { return static_cast<float>(image[py * kWidth + px]); };
    const float upper = 0.7F * at(x, y) + 0.3F * at(x + 1, y);
    const float lower = 0.7F * at(x, y + 1) + 0.3F * at(x + 1, y + 1);
    return 0.2F * upper + 0.8F * lower;
  };
  for (int y = 0; y < 7; ++y) {
    for (int x = 0; x < 7; ++x) {
      const int i = y * kLanes + x;
      EXPECT_NEAR(patch[i], between(11 + x, 20 + y), 1e-3F);
      EXPECT_NEAR(made.patch.gray[i] + made.patch.mean, between(11 + x, 20 + y), 1e-3F);
      EXPECT_NEAR(made.patch.gradient_x[i], 0.5F * (between(12 + x, 20 + y) - between(10 + x, 20 + y)),
                  1e-3F);
      EXPECT_NEAR(made.patch.gradient_y[i], 0.5F * (between(11 + x, 21 + y) - between(11 + x, 19 + y)),
                  1e-3F);
    }
  }
}

TEST(Kernels, DifferencesAreThoseOfThePixels) {
  const std::vector<std::uint8_t> image = noise();
  for (const int side : {7, 9, 21}) {
    const PatchShape shape = PatchShape::ofSide(side);
    Template made(shape);
    active().makeTemplate(placeAt(image, 4, 5, 0.3F, 0.8F), shape, false, &made.patch);
    const PatchPlace place = placeAt(image, 9, 12, 0.6F, 0.1F);
    std::vector<float> patch(static_cast<std::size_t>(shape.floats()));
    AlignmentSums aligned{};
    active().align(place, shape, made.patch, patch.data(), &aligned);
    double x = 0, y = 0, square = 0, absolute = 0;
    for (int i = 0; i < shape.floats(); ++i) {
      const double d = patch[i] - made.patch.gray[i];
      x += d * made.patch.gradient_x[i];
      y += d * made.patch.gradient_y[i];
      square += d * d;
      absolute += std::abs(d);
    }
    DifferenceSums sums{};
    active().subtract(place, shape, made.patch, &sums);
    EXPECT_NEAR(sums.x, x, 1e-5 * square);
    EXPECT_NEAR(sums.y, y, 1e-5 * square);
    EXPECT_NEAR(sums.square, square, 1e-5 * square);
    EXPECT_NEAR(sums.absolute, absolute, 1e-5 * square);
  }
}

TEST(Kernels, SumsOfATemplateAreThoseOfItsPixels) {
  const std::vector<std::uint8_t> image = noise();
  for (const int side : {3, 7, 9, 21}) {
    for (const bool project : {false, true}) {
      const PatchShape shape = PatchShape::ofSide(side);
      Template made(shape);
      active().makeTemplate(placeAt(image, 10, 19, 0.3F, 0.8F), shape, project, &made.patch);
      double gray = 0, gg = 0, gx = 0, xx = 0, xy = 0, yy = 0;
      for (int i = 0; i < shape.floats(); ++i) {
        const double g = made.patch.gray[i], x = made.patch.gradient_x[i], y = made.patch.gradient_y[i];
        gray += g;
        gg += g * g;
        gx += g * x;
        xx += x * x;
        xy += x * y;
        yy += y * y;
      }
      const double tolerance = 1e-5 * (gg + xx + yy);
      EXPECT_NEAR(gray, 0.0, tolerance);
      EXPECT_NEAR(made.patch.gray_gray, gg, tolerance);
      if (project) {
        EXPECT_NEAR(gx, 0.0, tolerance);
      }
      EXPECT_NEAR(made.patch.xx, xx, tolerance);
      EXPECT_NEAR(made.patch.xy, xy, tolerance);
      EXPECT_NEAR(made.patch.yy, yy, tolerance);
    }
  }
}

TEST(Kernels, ATemplateThatIsProjectedIsBlindToGainAndOffset) {
  const std::vector<std::uint8_t> image = noise();
  const PatchShape shape = PatchShape::ofSide(7);
  Template made(shape);
  active().makeTemplate(placeAt(image, 10, 10, 0.0F, 0.0F), shape, true, &made.patch);
  // The same pixels through another gain and offset.
  std::vector<std::uint8_t> brighter(image.size());
  for (std::size_t i = 0; i < image.size(); ++i) brighter[i] = static_cast<std::uint8_t>(image[i] / 2 + 40);
  std::vector<float> patch(static_cast<std::size_t>(shape.floats()));
  AlignmentSums sums{};
  active().align({brighter.data() + 11 * kWidth + 11, kWidth, 0.0F, 0.0F}, shape, made.patch, patch.data(),
                 &sums);
  // What stays is the rounding of image / 2.
  EXPECT_NEAR(sums.i_x / made.patch.xx, 0.0F, 5e-3F);
  EXPECT_NEAR(sums.i_y / made.patch.yy, 0.0F, 5e-3F);
  EXPECT_NEAR(sums.i_gray / made.patch.gray_gray, 0.5F, 5e-3F);
}

TEST(Kernels, SupportCountsSamplesNearTheFitThatAreSteep) {
  //                          on it   far    flat   on it  beyond the count
  const float places[kLanes] = {-1.0F, -0.5F, 0.0F, 1.0F, 0.0F, 0.0F, 0.0F, 0.0F};
  const float offsets[kLanes] = {0.5F, 3.0F, 1.0F, 1.75F, 1.0F, 1.0F, 1.0F, 1.0F};
  const float slopes[kLanes] = {6.0F, 9.0F, 1.0F, 10.0F, 9.0F, 9.0F, 9.0F, 9.0F};
  const float widths[kLanes] = {1.5F, 7.0F, 7.0F, 2.0F, 7.0F, 7.0F, 7.0F, 7.0F};
  float sums[4];
  active().sumSupport({places, offsets, slopes, widths, 4}, {1.0F, 0.5F}, 1.0F, 2.0F, sums);
  EXPECT_EQ(sums[0], 2.0F);
  EXPECT_EQ(sums[1], 16.0F);
  EXPECT_EQ(sums[2], 0.0625F);
  EXPECT_EQ(sums[3], 3.5F);
}

TEST(Kernels, AnEdgeIsAsWideAsItsHeightOverItsSteepestStep) {
  // In each column a rise of 120 gray levels over one more step than in the one before, from row 6 on.
  constexpr int kRows = kMaxProfile;
  std::vector<std::uint8_t> image(kRows * kLanes);
  ProfileBatch batch{};
  for (int lane = 0; lane < kLanes; ++lane) {
    for (int row = 0; row < kRows; ++row) {
      const int steps = std::min(lane + 1, std::max(0, row - 6));
      image[static_cast<std::size_t>(row * kLanes + lane)] =
          static_cast<std::uint8_t>(60 + 120 * steps / (lane + 1));
    }
    batch.pixels[lane] = image.data() + lane;
    batch.centre[lane] = 8.0F;
  }
  batch.step = kLanes;
  batch.count = kRows;
  batch.polarity = 1.0F;
  batch.distance_scale = 0.1F;
  batch.peak_share = 0.3F;
  float places[kLanes], slopes[kLanes], widths[kLanes];
  active().findEdges(batch, places, slopes, widths);
  for (int lane = 0; lane < kLanes; ++lane) {
    EXPECT_NEAR(widths[lane], static_cast<float>(lane + 1), 0.3F) << lane;
    EXPECT_NEAR(places[lane], 6.0F + 0.5F * static_cast<float>(lane + 1), 0.2F) << lane;
  }
}

TEST(Kernels, ProfilesAlongRowsAndColumnsOfTheSamePixelsGiveTheSameEdges) {
  const std::vector<std::uint8_t> image = noise();
  for (int count = 3; count <= kMaxProfile; ++count) {
    // The profiles again side by side, so that their pixels lie below each other.
    std::vector<std::uint8_t> columns(static_cast<std::size_t>(count * kLanes));
    ProfileBatch batch{};
    for (int lane = 0; lane < kLanes; ++lane) {
      batch.pixels[lane] = image.data() + (lane + 2) * kWidth + 5 * lane;
      batch.centre[lane] = 0.5F * static_cast<float>(count);
      for (int k = 0; k < count; ++k) {
        columns[static_cast<std::size_t>(k * kLanes + lane)] = batch.pixels[lane][k];
      }
    }
    batch.step = 1;
    batch.count = count;
    batch.polarity = 1.0F;
    batch.distance_scale = 0.1F;
    batch.peak_share = 0.4F;
    float along_rows[3][kLanes], along_columns[3][kLanes];
    active().findEdges(batch, along_rows[0], along_rows[1], along_rows[2]);
    for (int lane = 0; lane < kLanes; ++lane) batch.pixels[lane] = columns.data() + lane;
    batch.step = kLanes;
    active().findEdges(batch, along_columns[0], along_columns[1], along_columns[2]);
    EXPECT_EQ(std::memcmp(along_rows, along_columns, sizeof along_rows), 0) << count;
  }
}

TEST(Kernels, EveryInstructionSetGivesTheSameBits) {
  int count = 0;
  const KernelTable* const* tables = available(&count);
  const std::vector<std::uint8_t> image = noise();
  for (int t = 1; t < count; ++t) {
    for (const int side : {3, 7, 9, 15, 21}) {
      const PatchShape shape = PatchShape::ofSide(side);
      for (const bool project : {false, true}) {
        Template a(shape), b(shape);
        tables[0]->makeTemplate(placeAt(image, 5, 6, 0.37F, 0.61F), shape, project, &a.patch);
        tables[t]->makeTemplate(placeAt(image, 5, 6, 0.37F, 0.61F), shape, project, &b.patch);
        ASSERT_EQ(std::memcmp(a.values.data(), b.values.data(), a.values.size() * sizeof(float)), 0) << side;
        EXPECT_EQ(a.patch.xx, b.patch.xx);
        EXPECT_EQ(a.patch.gray_gray, b.patch.gray_gray);
        std::vector<float> patch_a(static_cast<std::size_t>(shape.floats())), patch_b(patch_a);
        AlignmentSums sums_a{}, sums_b{};
        const PatchPlace place{image.data() + 9 * kWidth + 7, kWidth, 0.12F, 0.93F};
        tables[0]->align(place, shape, a.patch, patch_a.data(), &sums_a);
        tables[t]->align(place, shape, b.patch, patch_b.data(), &sums_b);
        EXPECT_EQ(std::memcmp(&sums_a, &sums_b, sizeof sums_a), 0) << side;
        EXPECT_EQ(patch_a, patch_b);
        DifferenceSums differences_a{}, differences_b{};
        tables[0]->subtract(place, shape, a.patch, &differences_a);
        tables[t]->subtract(place, shape, b.patch, &differences_b);
        EXPECT_EQ(std::memcmp(&differences_a, &differences_b, sizeof differences_a), 0) << side;
        EXPECT_EQ(tables[0]->absoluteDifference(patch_a.data(), shape, a.patch, 0.9F, 3.0F),
                  tables[t]->absoluteDifference(patch_b.data(), shape, b.patch, 0.9F, 3.0F));
      }
    }
    for (const int count : {7, 13, kMaxProfile}) {
      ProfileBatch batch{};
      for (int lane = 0; lane < kLanes; ++lane) {
        batch.pixels[lane] = image.data() + lane * 3 * kWidth + 5 * lane;
        batch.centre[lane] = 0.5F * static_cast<float>(count) + 0.1F * static_cast<float>(lane);
      }
      batch.step = kWidth;
      batch.count = count;
      batch.polarity = -1.0F;
      batch.distance_scale = 0.3F;
      batch.peak_share = 0.4F;
      float places_a[kLanes], places_b[kLanes], slopes_a[kLanes], slopes_b[kLanes], sums_a[5], sums_b[5];
      float widths_a[kLanes], widths_b[kLanes];
      tables[0]->findEdges(batch, places_a, slopes_a, widths_a);
      tables[t]->findEdges(batch, places_b, slopes_b, widths_b);
      EXPECT_EQ(std::memcmp(widths_a, widths_b, sizeof widths_a), 0) << count;
      EXPECT_EQ(std::memcmp(places_a, places_b, sizeof places_a), 0) << count;
      EXPECT_EQ(std::memcmp(slopes_a, slopes_b, sizeof slopes_a), 0) << count;
      const EdgeSamples samples{places_a, places_b, slopes_a, widths_a, kLanes};
      tables[0]->sumOffsets(samples, {5.0F, 0.2F}, 9.0F, 1.0F, sums_a);
      tables[t]->sumOffsets(samples, {5.0F, 0.2F}, 9.0F, 1.0F, sums_b);
      EXPECT_EQ(std::memcmp(sums_a, sums_b, sizeof sums_a), 0) << count;
      tables[0]->sumSupport(samples, {5.0F, 0.2F}, 9.0F, 1.0F, sums_a);
      tables[t]->sumSupport(samples, {5.0F, 0.2F}, 9.0F, 1.0F, sums_b);
      EXPECT_EQ(std::memcmp(sums_a, sums_b, 4 * sizeof(float)), 0) << count;
    }
    for (int width = 16; width <= kWidth; ++width) {
      std::vector<std::uint16_t> row(static_cast<std::size_t>(width) + kRowPadding);
      std::vector<std::uint8_t> a(static_cast<std::size_t>(width)), b(a);
      const std::uint8_t* above = image.data();
      tables[0]->halveRow(above, above + kWidth, above + 2 * kWidth, width, row.data(), a.data());
      tables[t]->halveRow(above, above + kWidth, above + 2 * kWidth, width, row.data(), b.data());
      EXPECT_EQ(a, b) << width;
    }
  }
  if (count == 1) GTEST_SKIP() << "this processor runs the baseline kernels only";
}

}  // namespace
}  // namespace kernels
}  // namespace tet_line_tracker
