#include "pl_vins_contract.h"

#include <algorithm>
#include <cmath>
#include <iomanip>
#include <iterator>
#include <limits>
#include <sstream>
#include <unordered_set>

#include <Eigen/Geometry>

namespace tet_line_tracker {
namespace {

constexpr double kNoId = std::numeric_limits<double>::quiet_NaN();

std::string secondsText(const ros::Time& stamp) {
  std::ostringstream text;
  text << stamp.sec << "." << std::setw(9) << std::setfill('0') << stamp.nsec;
  return text.str();
}

}  // namespace

std::string nameOf(ContractFault::Rule rule) {
  using Rule = ContractFault::Rule;
  switch (rule) {
    case Rule::kMissingMessage:
      return "missing_message";
    case Rule::kExtraMessage:
      return "extra_message";
    case Rule::kStamp:
      return "stamp";
    case Rule::kOrder:
      return "order";
    case Rule::kFrame:
      return "frame";
    case Rule::kChannels:
      return "channels";
    case Rule::kNotFinite:
      return "not_finite";
    case Rule::kDepth:
      return "depth";
    case Rule::kIdNotWhole:
      return "id_not_whole";
    case Rule::kIdNegative:
      return "id_negative";
    case Rule::kIdTooLarge:
      return "id_too_large";
    case Rule::kIdTwice:
      return "id_twice";
    case Rule::kIdReturned:
      return "id_returned";
    case Rule::kIdJumped:
      return "id_jumped";
  }
  return "";
}

void PlVinsContract::addPoints(const ros::Time& stamp) {
  points_.push_back(stamp);
  pair();
}

void PlVinsContract::addLines(const sensor_msgs::PointCloud& lines) {
  line_stamps_.push_back(lines.header.stamp);
  judge(lines);
  pair();
}

void PlVinsContract::finish() {
  for (const ros::Time& stamp : points_) {
    report(ContractFault::Rule::kMissingMessage, stamp, kNoId, "no line message for this point message");
  }
  for (const ros::Time& stamp : line_stamps_) {
    report(ContractFault::Rule::kExtraMessage, stamp, kNoId, "no point message for this line message");
  }
  points_.clear();
  line_stamps_.clear();
}

std::vector<ContractFault> PlVinsContract::takeFaults() {
  std::vector<ContractFault> faults;
  faults.swap(new_faults_);
  return faults;
}

void PlVinsContract::pair() {
  using Rule = ContractFault::Rule;
  if (joining_) join();
  while (!joining_ && !points_.empty() && !line_stamps_.empty()) {
    const ros::Time point = points_.front();
    const ros::Time line = line_stamps_.front();
    if (point == line) {
      ++pairs_;
      points_.pop_front();
      line_stamps_.pop_front();
      continue;
    }
    // The estimator pairs these two all the same. Which of the queues is ahead shows once the stamp of one
    // turns up in the other.
    const auto in_points = std::find(points_.begin(), points_.end(), line);
    const auto in_lines = std::find(line_stamps_.begin(), line_stamps_.end(), point);
    if (in_points != points_.end()) {
      for (auto missing = points_.begin(); missing != in_points; ++missing) {
        report(Rule::kMissingMessage, *missing, kNoId,
               "no line message for this point message: the estimator pairs it with the lines of " +
                   secondsText(line) + " and all later ones wrongly too");
      }
      points_.erase(points_.begin(), in_points);
    } else if (in_lines != line_stamps_.end()) {
      for (auto extra = line_stamps_.begin(); extra != in_lines; ++extra) {
        report(Rule::kExtraMessage, *extra, kNoId,
               "no point message for this line message: the estimator pairs it with the points of " +
                   secondsText(point) + " and all later ones wrongly too");
      }
      line_stamps_.erase(line_stamps_.begin(), in_lines);
    } else if (points_.size() > 1 && line_stamps_.size() > 1) {
      report(Rule::kStamp, line, kNoId, "its point message carries " + secondsText(point));
      points_.pop_front();
      line_stamps_.pop_front();
    } else {
      return;
    }
  }
}

void PlVinsContract::join() {
  for (auto point = points_.begin(); point != points_.end(); ++point) {
    const auto line = std::find(line_stamps_.begin(), line_stamps_.end(), *point);
    if (line == line_stamps_.end()) continue;
    points_.erase(points_.begin(), point);
    line_stamps_.erase(line_stamps_.begin(), line);
    joining_ = false;
    return;
  }
  joining_ = std::min(points_.size(), line_stamps_.size()) < kJoined;
}

void PlVinsContract::judge(const sensor_msgs::PointCloud& lines) {
  using Rule = ContractFault::Rule;
  const ros::Time stamp = lines.header.stamp;
  ++messages_;
  if (messages_ > 1 && stamp <= last_stamp_) {
    report(Rule::kOrder, stamp, kNoId, "the message before carries " + secondsText(last_stamp_));
  }
  last_stamp_ = stamp;
  if (lines.header.frame_id != "world") {
    report(Rule::kFrame, stamp, kNoId, "frame_id is \"" + lines.header.frame_id + "\", needs world");
  }
  if (lines.points.empty()) ++empty_messages_;
  const std::size_t channels = std::min<std::size_t>(3, lines.channels.size());
  bool complete = channels == 3;
  for (std::size_t c = 0; c < channels; ++c) {
    complete = complete && lines.channels[c].values.size() == lines.points.size();
  }
  if (!complete) {
    std::string text = std::to_string(lines.points.size()) + " points, and channels of";
    for (const auto& channel : lines.channels) text += " " + std::to_string(channel.values.size());
    report(Rule::kChannels, stamp, kNoId, text + " values; the estimator reads beyond the end");
    return;
  }

  std::unordered_set<std::uint32_t> here;
  for (std::size_t i = 0; i < lines.points.size(); ++i) {
    ++lines_;
    const double id = static_cast<double>(lines.channels[0].values[i]);
    const Eigen::Vector3d start(lines.points[i].x, lines.points[i].y, 1.0);
    const Eigen::Vector3d end(lines.channels[1].values[i], lines.channels[2].values[i], 1.0);
    if (!start.allFinite() || !end.allFinite()) {
      report(Rule::kNotFinite, stamp, id, "an endpoint is not finite");
      continue;
    }
    if (lines.points[i].z != 1.0F) {
      report(Rule::kDepth, stamp, id, "z is " + std::to_string(lines.points[i].z) + ", needs 1");
    }
    if (!std::isfinite(id) || id != std::floor(id)) {
      report(Rule::kIdNotWhole, stamp, id, "the id is not a whole number");
      continue;
    }
    if (id < 0.0) {
      report(Rule::kIdNegative, stamp, id, "the id is negative and would be read as another one");
      continue;
    }
    if (id >= static_cast<double>(1U << 24)) {
      report(Rule::kIdTooLarge, stamp, id, "two ids may share a 32-bit float from 2^24 on");
      continue;
    }
    const auto key = static_cast<std::uint32_t>(id);
    if (!here.insert(key).second) {
      report(Rule::kIdTwice, stamp, id, "the id is there twice; the estimator reads the first");
      continue;
    }
    const Eigen::Vector3d plane = start.cross(end).normalized();
    const auto before = seen_.find(key);
    if (before == seen_.end()) {
      ++ids_;
    } else if (before->second.message + 1 < messages_) {
      report(Rule::kIdReturned, stamp, id,
             "the id was missing in " + std::to_string(messages_ - 1 - before->second.message) +
                 " message(s) in between; the estimator takes it for the frames in a row");
    } else if (std::acos(std::clamp(plane.dot(before->second.plane), -1.0, 1.0)) > kMaxTurn) {
      report(Rule::kIdJumped, stamp, id, "another line than in the message before, or its ends are swapped");
    }
    seen_[key] = {messages_, plane};
  }
  if (messages_ % 1000 == 0) {
    for (auto it = seen_.begin(); it != seen_.end();) {
      it = it->second.message + kForgotten < messages_ ? seen_.erase(it) : std::next(it);
    }
  }
}

void PlVinsContract::report(ContractFault::Rule rule, const ros::Time& stamp, double id,
                            const std::string& text) {
  ++counts_[rule];
  new_faults_.push_back({rule, stamp, id, text});
}

}  // namespace tet_line_tracker
