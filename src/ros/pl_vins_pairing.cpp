#include "pl_vins_pairing.h"

#include <cmath>
#include <limits>
#include <unordered_set>
#include <utility>

#include <boost/make_shared.hpp>

namespace tet_line_tracker {
namespace {

/// Messages of lines that are kept for point messages still to come: 10 s at 50 Hz.
constexpr std::size_t kMaxKept = 500;

/// Whether the estimator's floats hold the endpoints.
bool isFinite(const Line& line) {
  const auto fits = [](double value) {
    return std::abs(value) <= static_cast<double>(std::numeric_limits<float>::max());
  };
  return fits(line.start_normalized[0]) && fits(line.start_normalized[1]) && fits(line.end_normalized[0]) &&
         fits(line.end_normalized[1]);
}

/// Whether `next`, whose stamp is before that of `lines`, comes from a stream that began after it and is not
/// just out of order: the tracker was reset, or a new one begins.
bool isNewStream(const LineArray& lines, const LineArray& next) {
  constexpr std::uint64_t kFarthestOutOfOrder = 5;  // images
  return next.epoch > lines.epoch || (next.image_count == 1 && lines.image_count > kFarthestOutOfOrder);
}

}  // namespace

ParameterTable tableOf(PlVinsParameters& p) {
  ParameterTable table;
  table.add("preset", p.preset, {"pl_vins", "eplf_vins"},
            "Topics of the estimator; PL-VIO has those of pl_vins");
  table.add("points_topic", p.points_topic, {}, "Point messages to follow; empty: as preset says");
  table.add("output_topic", p.output_topic, {}, "Line messages to the estimator; empty: as preset says");
  table.add("follow", p.follow, {"points", "frequency"},
            "What decides on the images that are sent: the point messages, or PL-VINS's gate alone");
  table.add("max_wait", p.max_wait, 0.0, 60.0, "s",
            "A point message waits this long for late lines by the wall clock, then none are sent with it");
  table.add("frequency", p.frequency, 0.1, 1000.0, "Hz", "freq of PL-VINS's configuration, for its gate");
  table.add("max_lines", p.max_lines, 0, 1000, "", "Lines in a message at most, the oldest tracks first");
  table.add("extra_channels", p.extra_channels,
            "Pixel endpoints, age, uncertainty and cut as further channels, which PL-VINS does not read");
  return table;
}

PlVinsTopics topicsOf(const PlVinsParameters& parameters) {
  PlVinsTopics topics{"/feature_tracker/feature", "/linefeature_tracker/linefeature"};
  if (parameters.preset == "eplf_vins") {
    topics = {"/lf_feature_tracker/feature", "/lf_linefeature_tracker/linefeature"};
  }
  if (!parameters.points_topic.empty()) topics.points = parameters.points_topic;
  if (!parameters.output_topic.empty()) topics.output = parameters.output_topic;
  return topics;
}

PlVinsPairing::PlVinsPairing(const PlVinsParameters& parameters, std::uint32_t first_id)
    : parameters_(parameters), ids_(first_id), gate_(parameters.frequency) {}

void PlVinsPairing::addLines(const LineArray::ConstPtr& lines) {
  const ros::Time stamp = lines->header.stamp;
  const bool jumped_back =
      newest_lines_ && stamp <= newest_lines_->header.stamp && isNewStream(*newest_lines_, *lines);
  const bool in_order = !newest_lines_ || jumped_back || stamp > newest_lines_->header.stamp;
  if (in_order) newest_lines_ = lines;

  if (!followsPoints()) {
    if (!in_order) {
      ++counts_.late;
      return;
    }
    if (jumped_back) gate_ = FrequencyGate(parameters_.frequency);
    if (gate_.pass(stamp.toSec())) gated_.push_back(toPointCloud(stamp, lines.get()));
    return;
  }
  if (jumped_back) {
    // A bag started again, for one: what lies ahead belongs to the run before.
    lines_.erase(lines_.upper_bound(stamp), lines_.end());
  } else if (last_sent_ && stamp <= *last_sent_) {
    ++counts_.late;
  }
  lines_[stamp] = lines;
  if (lines_.size() > kMaxKept) lines_.erase(lines_.begin());
}

void PlVinsPairing::addPoints(const std_msgs::Header& header, double now_s) {
  ++counts_.points;
  countMissedPoints(header, now_s);
  if (followsPoints()) waiting_.push_back({header.stamp, now_s + parameters_.max_wait});
}

void PlVinsPairing::addNoPublisher(double now_s) {
  no_publisher_s_ = now_s;
  last_sequence_.reset();
  first_points_.reset();
}

/// A publisher counts its messages from 0 or 1, also those that nobody heard; a player of recordings does not
/// count, and its messages have the numbers of the recording.
void PlVinsPairing::countMissedPoints(const std_msgs::Header& header, double now_s) {
  if (!last_sequence_) {
    if (header.seq > 1) first_points_ = First{header.seq, header.stamp, now_s};
  } else if (header.seq > *last_sequence_ + 1) {
    counts_.points_missed += header.seq - *last_sequence_ - 1;
  }
  if (last_sequence_ && first_points_) {
    const std::uint32_t before = first_points_->sequence - 1;
    const double period_s = (header.stamp - first_points_->stamp).toSec();
    const bool is_recording = no_publisher_s_ && before * period_s > first_points_->now_s - *no_publisher_s_;
    if (!is_recording) counts_.points_missed += before;
    first_points_.reset();
  }
  last_sequence_ = header.seq;
}

std::vector<sensor_msgs::PointCloudPtr> PlVinsPairing::take(double now_s) {
  std::vector<sensor_msgs::PointCloudPtr> due = std::move(gated_);
  gated_.clear();
  while (!waiting_.empty()) {
    const ros::Time stamp = waiting_.front().stamp;
    const auto lines = lines_.find(stamp);
    if (lines == lines_.end() && now_s < waiting_.front().deadline_s) break;
    waiting_.pop_front();
    if (lines == lines_.end()) ++counts_.sent_without_input;
    due.push_back(toPointCloud(stamp, lines == lines_.end() ? nullptr : lines->second.get()));
    // Lines of this stamp stay: a second point message may carry it.
    if (!last_sent_ || stamp >= *last_sent_) lines_.erase(lines_.begin(), lines_.lower_bound(stamp));
    last_sent_ = stamp;
  }
  return due;
}

std::optional<double> PlVinsPairing::deadline() const {
  if (waiting_.empty()) return std::nullopt;
  return waiting_.front().deadline_s;
}

sensor_msgs::PointCloudPtr PlVinsPairing::toPointCloud(const ros::Time& stamp, const LineArray* array) {
  auto cloud = boost::make_shared<sensor_msgs::PointCloud>();
  cloud->header.stamp = stamp;
  cloud->header.frame_id = "world";
  for (const char* name : {"id", "end_x", "end_y"}) {
    cloud->channels.emplace_back();
    cloud->channels.back().name = name;
  }
  if (parameters_.extra_channels) {
    for (const char* name : {"start_px_x", "start_px_y", "end_px_x", "end_px_y", "age", "sigma_px",
                             "var_start_px2", "cov_px2", "var_end_px2", "cut"}) {
      cloud->channels.emplace_back();
      cloud->channels.back().name = name;
    }
  }
  ++counts_.sent;
  if (array == nullptr) {
    ids_.assignNone();
    return cloud;
  }

  std::vector<const Line*> lines;
  std::unordered_set<std::uint64_t> seen;
  for (const Line& line : array->lines) {
    if (!isFinite(line)) {
      ++counts_.lines_not_in_front;
    } else if (!seen.insert(line.id).second) {
      ++counts_.lines_repeated;
    } else if (lines.size() >= static_cast<std::size_t>(parameters_.max_lines)) {
      ++counts_.lines_over_limit;
    } else {
      lines.push_back(&line);
    }
  }
  const std::vector<std::uint32_t> ids = ids_.assign(*array, lines);
  counts_.lines_sent += lines.size();
  for (std::size_t i = 0; i < lines.size(); ++i) {
    const Line& line = *lines[i];
    geometry_msgs::Point32 start;
    start.x = static_cast<float>(line.start_normalized[0]);
    start.y = static_cast<float>(line.start_normalized[1]);
    start.z = 1.0F;
    cloud->points.push_back(start);
    const float values[] = {static_cast<float>(ids[i]),
                            static_cast<float>(line.end_normalized[0]),
                            static_cast<float>(line.end_normalized[1]),
                            line.start_px[0],
                            line.start_px[1],
                            line.end_px[0],
                            line.end_px[1],
                            static_cast<float>(line.age),
                            line.sigma_px,
                            line.covariance_px[0],
                            line.covariance_px[1],
                            line.covariance_px[2],
                            static_cast<float>(line.cut)};
    for (std::size_t c = 0; c < cloud->channels.size(); ++c) cloud->channels[c].values.push_back(values[c]);
  }
  return cloud;
}

}  // namespace tet_line_tracker
