#include "pl_vins_pairing.h"

#include <cmath>
#include <limits>
#include <random>
#include <set>

#include <gtest/gtest.h>
#include <boost/make_shared.hpp>

namespace tet_line_tracker {
namespace {

Line lineOf(std::uint64_t id, std::uint32_t age) {
  Line line;
  line.id = id;
  line.age = age;
  const float x = static_cast<float>(id % 50);
  line.start_px = {x, 10.0F};
  line.end_px = {x, 90.0F};
  line.start_normalized = {0.01 * x, -0.1};
  line.end_normalized = {0.01 * x, 0.1};
  line.sigma_px = 0.2F;
  return line;
}

ros::Time at(double seconds) {
  return ros::Time(100.0 + seconds);
}

std_msgs::Header pointsAt(double seconds) {
  std_msgs::Header header;
  header.stamp = at(seconds);
  return header;
}

/// Images of a tracker, one every 50 ms, with lines that come and go.
class FakeTracker {
 public:
  LineArray::Ptr image(double seconds) {
    for (auto& line : lines_) ++line.age;
    ++image_count_;
    auto array = boost::make_shared<LineArray>();
    array->header.stamp = at(seconds);
    array->epoch = epoch_;
    array->image_count = image_count_;
    array->lines = lines_;
    return array;
  }
  void add() { lines_.push_back(lineOf(next_id_++, 0)); }
  void drop(std::uint64_t id) {
    for (auto line = lines_.begin(); line != lines_.end(); ++line) {
      if (line->id == id) {
        lines_.erase(line);
        return;
      }
    }
  }
  void reset() {
    ++epoch_;
    image_count_ = next_id_ = 0;
    lines_.clear();
  }

 private:
  std::uint32_t epoch_{0};
  std::uint64_t image_count_{0};
  std::uint64_t next_id_{0};
  std::vector<Line> lines_;
};

std::vector<float> idsOf(const sensor_msgs::PointCloud& cloud) {
  return cloud.channels.at(0).values;
}

PlVinsParameters followingPoints() {
  PlVinsParameters parameters;
  parameters.max_wait = 0.2;
  return parameters;
}

TEST(PlVinsPairing, SendsStartAndEndInTheLayoutOfTheEstimator) {
  PlVinsPairing pairing(followingPoints());
  FakeTracker tracker;
  tracker.add();
  tracker.add();
  pairing.addLines(tracker.image(0.0));
  pairing.addPoints(pointsAt(0.0), 0.0);
  const auto sent = pairing.take(0.0);
  ASSERT_EQ(sent.size(), 1U);
  const sensor_msgs::PointCloud& cloud = *sent[0];
  EXPECT_EQ(cloud.header.stamp, at(0.0));
  EXPECT_EQ(cloud.header.frame_id, "world");
  ASSERT_EQ(cloud.channels.size(), 3U);
  ASSERT_EQ(cloud.points.size(), 2U);
  EXPECT_FLOAT_EQ(cloud.points[1].x, 0.01F);
  EXPECT_FLOAT_EQ(cloud.points[1].y, -0.1F);
  EXPECT_EQ(cloud.points[1].z, 1.0F);
  EXPECT_FLOAT_EQ(cloud.channels[1].values[1], 0.01F);
  EXPECT_FLOAT_EQ(cloud.channels[2].values[1], 0.1F);
}

TEST(PlVinsPairing, AddsFurtherChannelsOnlyOnRequest) {
  PlVinsParameters parameters = followingPoints();
  parameters.extra_channels = true;
  PlVinsPairing pairing(parameters);
  FakeTracker tracker;
  tracker.add();
  const auto image = boost::make_shared<LineArray>(*tracker.image(0.0));
  image->lines[0].covariance_px = {0.04F, -0.01F, 0.09F};
  image->lines[0].cut = 2;
  pairing.addLines(image);
  pairing.addPoints(pointsAt(0.0), 0.0);
  pairing.addPoints(pointsAt(0.1), 0.0);
  const auto sent = pairing.take(1.0);
  ASSERT_EQ(sent.size(), 2U);
  ASSERT_EQ(sent[0]->channels.size(), 13U);
  EXPECT_EQ(sent[0]->channels[6].name, "end_px_y");
  EXPECT_EQ(sent[0]->channels[6].values, std::vector<float>{90.0F});
  const std::vector<std::pair<std::string, float>> uncertainty{
      {"var_start_px2", 0.04F}, {"cov_px2", -0.01F}, {"var_end_px2", 0.09F}, {"cut", 2.0F}};
  for (std::size_t i = 0; i < uncertainty.size(); ++i) {
    EXPECT_EQ(sent[0]->channels[9 + i].name, uncertainty[i].first);
    EXPECT_EQ(sent[0]->channels[9 + i].values, std::vector<float>{uncertainty[i].second});
  }
  EXPECT_EQ(sent[1]->channels.size(), 13U);
}

TEST(PlVinsPairing, WaitsForLateLinesButNotForEver) {
  PlVinsPairing pairing(followingPoints());
  FakeTracker tracker;
  tracker.add();
  pairing.addPoints(pointsAt(0.0), 10.0);
  pairing.addPoints(pointsAt(0.1), 10.1);
  EXPECT_TRUE(pairing.take(10.15).empty());
  ASSERT_TRUE(pairing.deadline());
  EXPECT_DOUBLE_EQ(*pairing.deadline(), 10.2);
  const auto first = tracker.image(0.0);
  pairing.addLines(tracker.image(0.1));  // the first is late and would overtake
  EXPECT_TRUE(pairing.take(10.19).empty());
  auto sent = pairing.take(10.21);
  ASSERT_EQ(sent.size(), 2U);
  EXPECT_EQ(sent[0]->header.stamp, at(0.0));
  EXPECT_TRUE(sent[0]->points.empty());
  ASSERT_EQ(sent[0]->channels.size(), 3U);
  EXPECT_EQ(sent[1]->points.size(), 1U);
  pairing.addLines(first);
  EXPECT_TRUE(pairing.take(11.0).empty());
  EXPECT_EQ(pairing.counts().late, 1U);
  EXPECT_EQ(pairing.counts().sent_without_input, 1U);
  EXPECT_FALSE(pairing.deadline());
}

TEST(PlVinsPairing, GivesANewIdAfterAGapInWhatIsSent) {
  PlVinsPairing pairing(followingPoints());
  FakeTracker tracker;
  tracker.add();
  const auto send = [&](double seconds, bool with_lines) {
    const auto lines = tracker.image(seconds);
    if (with_lines) pairing.addLines(lines);
    pairing.addPoints(pointsAt(seconds), seconds);
    return idsOf(*pairing.take(seconds + 1.0).at(0));
  };
  const auto first = send(0.0, true);
  EXPECT_EQ(send(0.1, true), first);
  EXPECT_TRUE(send(0.2, false).empty());
  const auto after = send(0.3, true);
  ASSERT_EQ(after.size(), 1U);
  EXPECT_NE(after, first);
}

TEST(PlVinsPairing, KeepsIdsOverImagesThatAreNotAskedFor) {
  PlVinsPairing pairing(followingPoints());
  FakeTracker tracker;
  tracker.add();
  std::set<float> ids;
  for (int i = 0; i < 20; ++i) {
    pairing.addLines(tracker.image(0.05 * i));
    if (i % 2 != 0) continue;
    pairing.addPoints(pointsAt(0.05 * i), 0.05 * i);
    const auto sent = pairing.take(0.05 * i);
    ASSERT_EQ(sent.size(), 1U);
    for (float id : idsOf(*sent[0])) ids.insert(id);
  }
  EXPECT_EQ(ids.size(), 1U);
}

TEST(PlVinsPairing, GivesNewIdsAfterAResetAndAfterARestartWithTheSameNumbers) {
  PlVinsPairing pairing(followingPoints());
  FakeTracker tracker;
  std::set<float> ids;
  const auto send = [&](double seconds) {
    pairing.addLines(tracker.image(seconds));
    pairing.addPoints(pointsAt(seconds), seconds);
    for (float id : idsOf(*pairing.take(seconds).at(0))) ids.insert(id);
  };
  for (int i = 0; i < 3; ++i) tracker.add();
  send(0.0);
  tracker.reset();
  for (int i = 0; i < 3; ++i) tracker.add();
  send(0.1);
  EXPECT_EQ(ids.size(), 6U);

  // A new process: epoch 0 and ids from 0 again. It runs longer than the one before when its first message
  // gets through, so neither epoch nor image_count step back.
  PlVinsPairing over_restart(followingPoints());
  ids.clear();
  for (int process = 0; process < 2; ++process) {
    FakeTracker fresh;
    for (int unseen = 0; unseen < 5 * process; ++unseen) fresh.image(1.0 + 0.05 * unseen);
    fresh.add();
    over_restart.addLines(fresh.image(2.0 + process));
    over_restart.addPoints(pointsAt(2.0 + process), 2.0 + process);
    for (float id : idsOf(*over_restart.take(2.0 + process).at(0))) ids.insert(id);
  }
  EXPECT_EQ(ids.size(), 2U);
}

TEST(PlVinsPairing, LeavesOutWhatAnEstimatorCannotUse) {
  PlVinsParameters parameters = followingPoints();
  parameters.max_lines = 3;
  PlVinsPairing pairing(parameters);
  FakeTracker tracker;
  for (int i = 0; i < 6; ++i) tracker.add();
  const auto lines = tracker.image(0.0);
  lines->lines[1].end_normalized[0] = std::numeric_limits<double>::quiet_NaN();
  lines->lines[2].id = lines->lines[0].id;
  pairing.addLines(lines);
  pairing.addPoints(pointsAt(0.0), 0.0);
  const auto sent = pairing.take(0.0);
  EXPECT_EQ(sent.at(0)->points.size(), 3U);
  EXPECT_EQ(pairing.counts().lines_not_in_front, 1U);
  EXPECT_EQ(pairing.counts().lines_repeated, 1U);
  EXPECT_EQ(pairing.counts().lines_over_limit, 1U);
}

TEST(PlVinsPairing, LeavesOutLinesThatFloatsDoNotHold) {
  for (const double value : {std::numeric_limits<double>::infinity(), 1e39, -1e300}) {
    PlVinsPairing pairing(followingPoints());
    FakeTracker tracker;
    for (int i = 0; i < 3; ++i) tracker.add();
    const auto lines = tracker.image(0.0);
    lines->lines[0].start_normalized[1] = lines->lines[2].end_normalized[0] = value;
    pairing.addLines(lines);
    pairing.addPoints(pointsAt(0.0), 0.0);
    EXPECT_EQ(pairing.take(0.0).at(0)->points.size(), 1U) << value;
    EXPECT_EQ(pairing.counts().lines_not_in_front, 2U) << value;
  }
}

TEST(PlVinsPairing, StartsAgainWhenABagDoes) {
  PlVinsPairing pairing(followingPoints());
  FakeTracker tracker;
  for (int run = 0; run < 2; ++run) {
    for (int i = 0; i < 10; ++i) {
      tracker.add();
      pairing.addLines(tracker.image(0.1 * i));
      pairing.addPoints(pointsAt(0.1 * i), 10.0 * run + 0.1 * i);
      const auto sent = pairing.take(10.0 * run + 0.1 * i);
      ASSERT_EQ(sent.size(), 1U);
      ASSERT_EQ(sent[0]->header.stamp, at(0.1 * i));
      ASSERT_EQ(sent[0]->points.size(), i + 1U) << "run " << run;
    }
    // Images after the last points of the run: their stamps come again in the next.
    tracker.reset();
  }
  EXPECT_EQ(pairing.counts().sent_without_input, 0U);
}

TEST(PlVinsPairing, CountsPointMessagesThatItNeverSaw) {
  PlVinsPairing pairing(followingPoints());
  std_msgs::Header header = pointsAt(0.0);
  for (const std::uint32_t sequence : {3U, 4U, 7U, 0U, 1U}) {
    header.seq = sequence;
    pairing.addPoints(header, 0.0);
  }
  EXPECT_EQ(pairing.counts().points_missed, 2U + 2U);
}

/// What is missed of points at 10 Hz from number `first` on, the publisher of which came up to 0.5 s ago.
std::uint64_t missedFrom(PlVinsPairing& pairing, std::uint32_t first, double now_s) {
  const std::uint64_t before = pairing.counts().points_missed;
  for (std::uint32_t i = 0; i < 5; ++i) {
    std_msgs::Header header = pointsAt(now_s + 0.1 * i);
    header.seq = first + i;
    pairing.addPoints(header, now_s + 0.1 * i);
  }
  return pairing.counts().points_missed - before;
}

TEST(PlVinsPairing, MissesNothingOfARecordingThatIsPlayedFromItsMiddle) {
  PlVinsPairing pairing(followingPoints());
  pairing.addNoPublisher(9.5);
  EXPECT_EQ(missedFrom(pairing, 601, 10.0), 0U);
  // Played again from its middle, and by a publisher that counts.
  pairing.addNoPublisher(19.5);
  EXPECT_EQ(missedFrom(pairing, 3601, 20.0), 0U);
  pairing.addNoPublisher(29.5);
  EXPECT_EQ(missedFrom(pairing, 1, 30.0), 0U);
}

TEST(PlVinsPairing, CountsWhatAPublisherMayHaveSentBeforeItWasHeard) {
  PlVinsPairing late(followingPoints());  // the publisher was there before
  EXPECT_EQ(missedFrom(late, 601, 10.0), 600U);
  PlVinsPairing soon(followingPoints());  // 0.5 s are enough for four messages
  soon.addNoPublisher(9.5);
  EXPECT_EQ(missedFrom(soon, 5, 10.0), 4U);
  PlVinsPairing gap(followingPoints());
  gap.addNoPublisher(9.5);
  missedFrom(gap, 601, 10.0);
  EXPECT_EQ(missedFrom(gap, 609, 10.5), 3U);
}

TEST(PlVinsPairing, AnswersEachPointMessageOnceWhateverHappensToTheLines) {
  std::mt19937 random(5);
  std::uniform_real_distribution<double> uniform(0.0, 1.0);
  PlVinsPairing pairing(followingPoints());
  FakeTracker tracker;
  std::multimap<double, LineArray::ConstPtr> lines_at;
  std::multimap<double, double> points_at;
  for (int i = 0; i < 4000; ++i) {
    const double t = 0.05 * i;
    if (i % 7 == 0) tracker.add();
    if (i % 11 == 0) tracker.drop(static_cast<std::uint64_t>(i / 14));
    if (i == 1000 || i == 2500) tracker.reset();
    const auto lines = tracker.image(t);
    const double fate = uniform(random);
    if (fate > 0.05) lines_at.emplace(t + (fate < 0.15 ? 0.4 : 0.03) * uniform(random), lines);
    if (fate > 0.95) lines_at.emplace(t + 0.1, lines);
    if (i % 2 == 0) points_at.emplace(t + 0.06 * uniform(random), t);
  }
  std::vector<sensor_msgs::PointCloudPtr> sent;
  std::vector<ros::Time> asked;
  auto lines = lines_at.begin();
  auto points = points_at.begin();
  for (double now = 0.0; now < 201.0; now += 0.01) {
    for (; lines != lines_at.end() && lines->first <= now; ++lines) pairing.addLines(lines->second);
    for (; points != points_at.end() && points->first <= now; ++points) {
      pairing.addPoints(pointsAt(points->second), now);
      asked.push_back(at(points->second));
    }
    for (auto& message : pairing.take(now)) sent.push_back(std::move(message));
  }
  ASSERT_EQ(sent.size(), asked.size());
  std::set<float> all;
  std::set<float> before;
  std::size_t with_lines = 0;
  for (std::size_t i = 0; i < sent.size(); ++i) {
    ASSERT_EQ(sent[i]->header.stamp, asked[i]);
    std::set<float> here;
    for (float id : idsOf(*sent[i])) {
      ASSERT_TRUE(here.insert(id).second) << "twice: " << id;
      ASSERT_TRUE(before.count(id) == 1 || all.count(id) == 0) << "returned: " << id;
      all.insert(id);
    }
    with_lines += here.empty() ? 0 : 1;
    before = here;
  }
  EXPECT_GT(with_lines, sent.size() * 8 / 10);
  EXPECT_LT(with_lines, sent.size());
}

TEST(PlVinsPairing, PicksTheImagesThatPlVinsPicksWithoutPoints) {
  PlVinsParameters parameters;
  parameters.follow = "frequency";
  parameters.frequency = 10.0;
  PlVinsPairing pairing(parameters);
  FakeTracker tracker;
  tracker.add();
  std::vector<double> sent_at;
  for (int i = 0; i < 400; ++i) {
    pairing.addLines(tracker.image(0.05 * i));
    if (i == 200) pairing.addLines(tracker.image(0.05 * 100));  // late
    for (const auto& message : pairing.take(0.0))
      sent_at.push_back((message->header.stamp - at(0.0)).toSec());
  }
  // The gate by hand at 20 Hz: t = 0 is 1/0; 0.05 is round(20) > 10; 0.1 is 10, passes and starts the count
  // anew with 1 passed since 0.1; 0.15 is 20; 0.2 is 10; and so on.
  ASSERT_EQ(sent_at.size(), 199U);
  for (std::size_t i = 0; i < sent_at.size(); ++i) {
    EXPECT_NEAR(sent_at[i], 0.1 * static_cast<double>(i + 1), 1e-6);
  }
  EXPECT_EQ(pairing.counts().late, 1U);
}

TEST(FrequencyGate, FollowsTheFormulaAtAnOddRate) {
  // 30 Hz images, freq 10: round(n / t) <= 10 lets a rate of 10.49 pass.
  FrequencyGate gate(10.0);
  std::vector<int> passed;
  for (int i = 0; i <= 12; ++i) {
    if (gate.pass(5.0 + i / 30.0)) passed.push_back(i);
  }
  EXPECT_EQ(passed, (std::vector<int>{3, 6, 9, 12}));
}

TEST(ContiguousIds, StayWholeNumbersOfAFloatForEver) {
  ContiguousIds ids(ContiguousIds::kLast - 5);
  LineArray array;
  Line long_lived = lineOf(0, 1);
  std::vector<std::uint32_t> last_two;
  std::uint32_t kept = 0;
  bool wrapped = false;
  for (int i = 0; i < 40; ++i) {
    array.image_count = static_cast<std::uint64_t>(i);
    const Line fresh = lineOf(static_cast<std::uint64_t>(i) + 1, 1);
    const auto given = ids.assign(array, {&long_lived, &fresh});
    ASSERT_EQ(given.size(), 2U);
    if (i == 0) kept = given[0];
    EXPECT_EQ(given[0], kept);
    EXPECT_NE(given[1], kept);
    for (const std::uint32_t id : given) {
      EXPECT_GE(id, ContiguousIds::kFirst);
      EXPECT_LE(id, ContiguousIds::kLast);
      EXPECT_EQ(static_cast<std::uint32_t>(static_cast<float>(id)), id);
      EXPECT_EQ(static_cast<int>(static_cast<double>(static_cast<float>(id)) + 0.5), static_cast<int>(id));
    }
    wrapped = wrapped || given[1] == ContiguousIds::kFirst;
    ++long_lived.age;
  }
  EXPECT_TRUE(wrapped);
}

TEST(ContiguousIds, UseNoNumberASecondTimeBeforeAllOthers) {
  ContiguousIds ids;
  LineArray array;
  // One line lives on while all numbers pass by once and a second round begins.
  Line long_lived = lineOf(0, 1);
  std::vector<Line> fresh(1000);
  std::vector<const Line*> lines{&long_lived};
  for (const Line& line : fresh) lines.push_back(&line);
  std::vector<bool> used(1U << 24, false);
  std::uint64_t tracker_id = 1;
  std::uint64_t given_before_reuse = 0;
  bool reused = false;
  for (std::uint64_t message = 0; message < 17000 && !reused; ++message) {
    array.image_count = message;
    if (message % 1000 == 999) {
      // Across a reset of the tracker.
      ++array.epoch;
      long_lived.age = 1;
    }
    for (Line& line : fresh) {
      line.id = tracker_id++;
      line.age = 1;
    }
    const auto given = ids.assign(array, lines);
    for (std::size_t i = 1; i < given.size(); ++i) {
      ASSERT_NE(given[i], given[0]);
      reused = reused || used[given[i]];
      used[given[i]] = true;
      if (!reused) ++given_before_reuse;
    }
    used[given[0]] = true;
    ++long_lived.age;
  }
  EXPECT_TRUE(reused);
  EXPECT_GT(given_before_reuse, 16700000U);
}

TEST(PlVinsParameters, NameTheTopicsOfTheEstimators) {
  PlVinsParameters parameters;
  EXPECT_EQ(topicsOf(parameters).points, "/feature_tracker/feature");
  EXPECT_EQ(topicsOf(parameters).output, "/linefeature_tracker/linefeature");
  parameters.preset = "eplf_vins";
  EXPECT_EQ(topicsOf(parameters).points, "/lf_feature_tracker/feature");
  EXPECT_EQ(topicsOf(parameters).output, "/lf_linefeature_tracker/linefeature");
  parameters.output_topic = "/own/lines";
  EXPECT_EQ(topicsOf(parameters).output, "/own/lines");
  EXPECT_TRUE(tableOf(parameters).check().empty());
  parameters.preset = "plvins";
  EXPECT_EQ(tableOf(parameters).check().size(), 1U);
}

}  // namespace
}  // namespace tet_line_tracker
