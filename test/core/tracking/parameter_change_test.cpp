#include <algorithm>
#include <cmath>
#include <set>
#include <stdexcept>
#include <string>
#include <utility>
#include <vector>

#include <gtest/gtest.h>

#include "synthetic_images.h"
#include "tet_line_tracker/tracking/line_tracker.h"

namespace tet_line_tracker {
namespace {

using Change = ParameterTable::Change;

constexpr int kImages = 4;  ///< before a change

/// A tracker that sees the boxes move, as far as its parameters let it.
class Flight {
 public:
  explicit Flight(const LineTrackerParameters& parameters = LineTrackerParameters()) : tracker(parameters) {
    for (int i = 0; i < kImages; ++i) next();
  }
  const LineFrame& next() {
    return at({0.9F * static_cast<float>(image_), 0.4F * static_cast<float>(image_)});
  }
  const LineFrame& at(const Eigen::Vector2f& shift) {
    const std::int64_t stamp_ns = 1000000000 + 50000000 * static_cast<std::int64_t>(++image_);
    return *tracker.process(boxesImage(640, 400, shift), stamp_ns).frame;
  }

  LineTracker tracker;

 private:
  int image_{0};
};

std::set<std::uint64_t> idsOf(const LineFrame& frame) {
  std::set<std::uint64_t> ids;
  for (const TrackedLine& line : frame.lines) ids.insert(line.id);
  return ids;
}

std::size_t shared(const std::set<std::uint64_t>& a, const std::set<std::uint64_t>& b) {
  return static_cast<std::size_t>(
      std::count_if(a.begin(), a.end(), [&b](std::uint64_t id) { return b.count(id) != 0; }));
}

/// Another value that is allowed, not far from the present one.
void changeValue(const ParameterTable::Entry& entry) {
  if (bool* const* flag = std::get_if<bool*>(&entry.field)) {
    **flag = !**flag;
  } else if (int* const* whole = std::get_if<int*>(&entry.field)) {
    const int step = entry.odd ? 2 : 1;
    **whole += static_cast<double>(**whole + step) <= entry.max ? step : -step;
  } else if (double* const* number = std::get_if<double*>(&entry.field)) {
    **number = std::clamp(**number * 1.1, entry.min, entry.max) == **number ? **number * 0.9 : **number * 1.1;
  } else {
    std::string& word = *std::get<std::string*>(entry.field);
    if (entry.choices.empty()) {
      word = "auto";  // imu_time_offset
    } else {
      word = entry.choices[entry.choices[0] == word ? 1 : 0];
    }
  }
}

/// Defaults with one parameter changed, for each parameter that changes so.
std::vector<std::pair<std::string, LineTrackerParameters>> changesOf(Change change) {
  std::vector<std::pair<std::string, LineTrackerParameters>> changes;
  LineTrackerParameters defaults;
  const std::size_t count = tableOf(defaults).entries().size();
  for (std::size_t i = 0; i < count; ++i) {
    LineTrackerParameters parameters;
    const ParameterTable table = tableOf(parameters);
    const ParameterTable::Entry& entry = table.entries()[i];
    if (entry.change != change) continue;
    changeValue(entry);
    changes.emplace_back(entry.name + " " + ParameterTable::valueText(entry), parameters);
  }
  return changes;
}

TEST(ParameterChange, TracksGoOnWithEachParameterThatChangesBetweenImages) {
  const auto changes = changesOf(Change::kBetweenImages);
  ASSERT_GT(changes.size(), 20U);
  for (const auto& [name, parameters] : changes) {
    Flight flight;
    const std::set<std::uint64_t> before = idsOf(flight.next());
    EXPECT_FALSE(flight.tracker.setParameters(parameters)) << name;
    for (int i = 0; i < 3; ++i) {
      const LineFrame& frame = flight.next();
      EXPECT_EQ(frame.epoch, 0U) << name;
      EXPECT_GE(shared(before, idsOf(frame)) + 3, before.size()) << name;
    }
  }
}

TEST(ParameterChange, ANewEpochBeginsWithEachParameterThatTheTemplatesDependOn) {
  const auto changes = changesOf(Change::kNewEpoch);
  ASSERT_GT(changes.size(), 5U);
  for (const auto& [name, parameters] : changes) {
    Flight flight;
    const std::set<std::uint64_t> before = idsOf(flight.next());
    EXPECT_TRUE(flight.tracker.setParameters(parameters)) << name;
    const LineFrame& first = flight.next();
    EXPECT_EQ(first.epoch, 1U) << name;
    EXPECT_EQ(first.image_count, 1U) << name;
    const std::set<std::uint64_t> started = idsOf(first);
    EXPECT_GE(started.size(), 15U) << name;
    EXPECT_EQ(shared(before, started), 0U) << name;
    for (int i = 0; i < 3; ++i) EXPECT_GE(shared(started, idsOf(flight.next())), 12U) << name;
  }
}

TEST(ParameterChange, TheNewValueHoldsInTheNextImage) {
  Flight flight;
  const LineFrame& before = flight.next();
  const auto shorter = [](const TrackedLine& line) { return line.segment.length() < 100.0F; };
  const auto short_lines =
      static_cast<std::size_t>(std::count_if(before.lines.begin(), before.lines.end(), shorter));
  const std::size_t all = before.lines.size();
  ASSERT_GE(short_lines, 4U);
  LineTrackerParameters parameters;
  parameters.detection.min_length = 105.0;
  flight.tracker.setParameters(parameters);
  const LineFrame& after = flight.next();
  EXPECT_TRUE(std::none_of(after.lines.begin(), after.lines.end(), shorter));
  EXPECT_GE(after.lines.size() + short_lines + 3, all);
  EXPECT_EQ(flight.tracker.parameters().detection.min_length, 105.0);

  parameters.detection.border = 65.0;
  flight.tracker.setParameters(parameters);
  for (const TrackedLine& line : flight.next().lines) {
    EXPECT_GE(std::min(line.segment.start.x(), line.segment.end.x()), 65.0F);
    EXPECT_GE(std::min(line.segment.start.y(), line.segment.end.y()), 65.0F);
  }
}

TEST(ParameterChange, AGapCountsByTheNewMaxGap) {
  Flight flight;
  LineTrackerParameters parameters;
  parameters.stream.max_gap = 0.04;
  EXPECT_FALSE(flight.tracker.setParameters(parameters));
  EXPECT_EQ(flight.next().epoch, 1U);
}

TEST(ParameterChange, TheImuIsAskedForByTheNewOffset) {
  Flight flight;
  LineTrackerParameters parameters;
  parameters.motion.imu_time_offset = "0.02";
  flight.tracker.setParameters(parameters);
  EXPECT_EQ(flight.tracker.imuStamp(1000000000), 1020000000);
  parameters.motion.prior = "image";
  flight.tracker.setParameters(parameters);
  EXPECT_FALSE(flight.tracker.usesImu());
}

TEST(ParameterChange, APriorThatWasOffBeginsWithTheNextTwoImages) {
  LineTrackerParameters with;
  with.motion.prior = "image";
  LineTrackerParameters without;
  without.motion.prior = "none";
  Flight flight(with);
  float x = 0.0F;
  const auto prior = [&] { return flight.at({x += 7.0F, 0.0F}).statistics.prior; };
  prior();
  ASSERT_EQ(prior(), "image");
  flight.tracker.setParameters(without);
  EXPECT_EQ(prior(), "none");
  EXPECT_EQ(prior(), "none");
  flight.tracker.setParameters(with);
  EXPECT_EQ(prior(), "none");  // the image before was not seen by the prior
  EXPECT_EQ(prior(), "image");
}

TEST(ParameterChange, NoMovementIsPredictedFromBeforePredictParallaxWasSwitchedOff) {
  LineTrackerParameters parameters;
  parameters.motion.prior = "none";
  Flight flight(parameters);
  float x = 0.0F;
  std::size_t lines = 0;
  for (int step = 3; step <= 36; step += 3) {
    lines = flight.at({x += static_cast<float>(step), 0.0F}).lines.size();
  }
  parameters.motion.predict_parallax = false;
  flight.tracker.setParameters(parameters);
  const LineFrame& stopped = flight.at({x, 0.0F});
  EXPECT_EQ(stopped.statistics.tracks_kept, lines);
}

/// What tells two frames apart, exactly.
std::vector<float> contentOf(const LineFrame& frame) {
  std::vector<float> content{static_cast<float>(frame.epoch), static_cast<float>(frame.image_count)};
  for (const TrackedLine& line : frame.lines) {
    content.insert(content.end(),
                   {static_cast<float>(line.id), static_cast<float>(line.age), line.segment.start.x(),
                    line.segment.start.y(), line.segment.end.x(), line.segment.end.y()});
  }
  return content;
}

TEST(ParameterChange, ARefusedOneLeavesAllAsItWas) {
  Flight undisturbed;
  Flight flight;
  LineTrackerParameters parameters;
  parameters.detection.min_length = 90.0;
  parameters.flow.window_px = 9;
  parameters.detection.min_lines = 200;  // over max_lines
  EXPECT_THROW(flight.tracker.setParameters(parameters), std::invalid_argument);
  parameters.detection.min_lines = 30;
  parameters.flow.window_px = 8;
  EXPECT_THROW(flight.tracker.setParameters(parameters), std::invalid_argument);
  EXPECT_EQ(flight.tracker.parameters().detection.min_length, 30.0);
  for (int i = 0; i < 3; ++i) EXPECT_EQ(contentOf(flight.next()), contentOf(undisturbed.next()));
}

TEST(ParameterChange, ToTheSameValuesChangesNothing) {
  Flight undisturbed;
  Flight flight;
  for (int i = 0; i < 5; ++i) {
    EXPECT_FALSE(flight.tracker.setParameters(flight.tracker.parameters()));
    EXPECT_EQ(contentOf(flight.next()), contentOf(undisturbed.next()));
  }
}

}  // namespace
}  // namespace tet_line_tracker
