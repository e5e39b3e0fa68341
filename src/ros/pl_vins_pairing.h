#pragma once

#include <cstdint>
#include <deque>
#include <map>
#include <optional>
#include <string>
#include <vector>

#include <sensor_msgs/PointCloud.h>
#include <std_msgs/Header.h>

#include "contiguous_ids.h"
#include "frequency_gate.h"
#include "tet_line_tracker/LineArray.h"
#include "tet_line_tracker/parameters/parameter_table.h"

namespace tet_line_tracker {

/// How lines are sent to PL-VINS and its relatives.
struct PlVinsParameters {
  std::string preset{"pl_vins"};  ///< topics of the estimator: pl_vins (also PL-VIO) or eplf_vins
  std::string points_topic;       ///< point messages to follow; empty: as preset says
  std::string output_topic;       ///< line messages to the estimator; empty: as preset says
  std::string follow{"points"};   ///< points: one message for each point message; frequency: PL-VINS's gate
  double max_wait{0.2};    ///< a point message waits this long for late lines, by the wall clock, 0..60 [s]
  double frequency{10.0};  ///< of the gate, 0.1..1000 [Hz]
  int max_lines{150};      ///< in a message, oldest tracks first, 0..1000 (PL-VINS has room for 1000)
  bool extra_channels{false};  ///< pixels, age and uncertainty after the three channels that are read
};

/// Entries bound to the fields of `parameters`, which must outlive the table.
ParameterTable tableOf(PlVinsParameters& parameters);

/// Topics as `parameters` say, presets filled in.
struct PlVinsTopics {
  std::string points;
  std::string output;
};
PlVinsTopics topicsOf(const PlVinsParameters& parameters);

/// Turns messages of lines into what PL-VINS's estimator reads. It pairs line and point messages by their
/// place in the queue, so in mode `points` exactly one message leaves for each point message: same stamp,
/// same order, without lines when none came in time. Not thread-safe. Times are seconds of any steady clock.
class PlVinsPairing {
 public:
  struct Counts {
    std::uint64_t points{0};              ///< point messages (mode points)
    std::uint64_t points_missed{0};       ///< published, by the gaps in header.seq, but never seen here
    std::uint64_t sent{0};                ///< line messages sent
    std::uint64_t sent_without_input{0};  ///< of these, without lines since none came in time
    std::uint64_t late{0};                ///< messages of lines that came when theirs was already sent
    std::uint64_t lines_sent{0};
    std::uint64_t lines_not_in_front{0};  ///< left out: no finite normalised endpoints
    std::uint64_t lines_repeated{0};      ///< left out: second use of an id in a message
    std::uint64_t lines_over_limit{0};    ///< left out: more than max_lines
  };

  /// `first_id`: see ContiguousIds.
  explicit PlVinsPairing(const PlVinsParameters& parameters, std::uint32_t first_id = ContiguousIds::kFirst);

  void addLines(const LineArray::ConstPtr& lines);
  void addPoints(const std_msgs::Header& header, double now_s);
  /// Nobody publishes point messages now: the next one begins a count of its own. What was published before
  /// it is known to be missed unless it cannot be: when the publisher has not been there for long enough to
  /// have sent all of it, as one that plays a recording from its middle.
  void addNoPublisher(double now_s);

  /// Messages that are due, in the order in which they must leave.
  std::vector<sensor_msgs::PointCloudPtr> take(double now_s);
  /// When the next message leaves without further input, if any waits [s].
  std::optional<double> deadline() const;

  const Counts& counts() const { return counts_; }

 private:
  /// The first point message of a publisher: tells by the second one what was missed before.
  struct First {
    std::uint32_t sequence;
    ros::Time stamp;
    double now_s;
  };

  void countMissedPoints(const std_msgs::Header& header, double now_s);

  struct Waiting {
    ros::Time stamp;
    double deadline_s;
  };

  bool followsPoints() const { return parameters_.follow == "points"; }
  sensor_msgs::PointCloudPtr toPointCloud(const ros::Time& stamp, const LineArray* lines);

  PlVinsParameters parameters_;
  ContiguousIds ids_;
  FrequencyGate gate_;
  std::deque<Waiting> waiting_;                     ///< point messages without an answer, in their order
  std::map<ros::Time, LineArray::ConstPtr> lines_;  ///< that a point message may still ask for
  LineArray::ConstPtr newest_lines_;                ///< of the stream that began last
  std::optional<ros::Time> last_sent_;
  std::optional<std::uint32_t> last_sequence_;     ///< of the point messages
  std::optional<First> first_points_;              ///< while they wait for the second
  std::optional<double> no_publisher_s_;           ///< when there was none of point messages last
  std::vector<sensor_msgs::PointCloudPtr> gated_;  ///< due in mode frequency
  Counts counts_;
};

}  // namespace tet_line_tracker
