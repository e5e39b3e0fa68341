#pragma once

#include <cstdint>
#include <deque>
#include <map>
#include <string>
#include <unordered_map>
#include <vector>

#include <ros/time.h>
#include <sensor_msgs/PointCloud.h>
#include <Eigen/Core>

namespace tet_line_tracker {

/// One rule that a stream of line messages broke.
struct ContractFault {
  enum class Rule {
    kMissingMessage,  ///< a point message without its line message
    kExtraMessage,    ///< a line message without its point message
    kStamp,           ///< both there, with different stamps
    kOrder,           ///< stamps of line messages do not grow
    kFrame,           ///< frame_id is not "world"
    kChannels,        ///< fewer than three channels, or one not as long as the points
    kNotFinite,       ///< NaN or infinity in an endpoint
    kDepth,           ///< z is not 1
    kIdNotWhole,      ///< NaN, infinity or a fraction
    kIdNegative,      ///< is read as 0
    kIdTooLarge,      ///< from 2^24 on two ids may share a float
    kIdTwice,         ///< twice in a message
    kIdReturned,      ///< was missing in between
    kIdJumped         ///< another line under the id, or start and end swapped
  };
  Rule rule;
  ros::Time stamp;   ///< of the message at fault
  double id;         ///< of the line at fault; NaN: the whole message
  std::string text;  ///< one sentence
};

/// Name of a rule as the report shows it.
std::string nameOf(ContractFault::Rule rule);

/// Judges a stream of line messages as PL-VINS's estimator reads it: paired with the point messages by their
/// place in the two queues. The estimator never gets over a message too many or too few; the judge reports it
/// once and pairs by stamps from there, so that it finds later faults as well.
class PlVinsContract {
 public:
  /// Angle between the viewing planes of a line in two messages in a row from which it counts as jumped: at
  /// 10 Hz far above what a camera turns, far below the 180 degrees of swapped ends [rad].
  static constexpr double kMaxTurn = 1.05;
  /// Messages after which an id may come back as a new line.
  static constexpr std::uint64_t kForgotten = 10000;
  /// Messages of both topics after which a running stream is judged although no two had one stamp.
  static constexpr std::size_t kJoined = 20;

  /// For a judge that begins while messages flow, before the first one: the two topics are not heard from the
  /// same moment on, so what comes before the first two with one stamp is no fault.
  void joinRunningStream() { joining_ = true; }
  void addPoints(const ros::Time& stamp);
  void addLines(const sensor_msgs::PointCloud& lines);
  /// No more messages will come: point messages that still wait lack their lines.
  void finish();

  /// Faults since the last call.
  std::vector<ContractFault> takeFaults();

  std::uint64_t pairs() const { return pairs_; }
  std::uint64_t lines() const { return lines_; }
  std::uint64_t ids() const { return ids_; }
  std::uint64_t emptyMessages() const { return empty_messages_; }
  /// Faults of each rule so far.
  const std::map<ContractFault::Rule, std::uint64_t>& faults() const { return counts_; }

 private:
  struct Seen {
    std::uint64_t message;
    Eigen::Vector3d plane;  ///< unit normal of start x end
  };

  void pair();
  void join();
  void judge(const sensor_msgs::PointCloud& lines);
  void report(ContractFault::Rule rule, const ros::Time& stamp, double id, const std::string& text);

  std::deque<ros::Time> points_;
  std::deque<ros::Time> line_stamps_;
  bool joining_{false};
  std::unordered_map<std::uint32_t, Seen> seen_;
  ros::Time last_stamp_;
  std::uint64_t messages_{0}, pairs_{0}, lines_{0}, ids_{0}, empty_messages_{0};
  std::vector<ContractFault> new_faults_;
  std::map<ContractFault::Rule, std::uint64_t> counts_;
};

}  // namespace tet_line_tracker
