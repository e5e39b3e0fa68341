#pragma once

#include <cstdint>
#include <deque>
#include <optional>
#include <unordered_map>
#include <vector>

#include <Eigen/Geometry>

#include "tet_line_tracker/mapping/pluecker_line.h"
#include "tet_line_tracker/parameters/parameter_table.h"
#include "tet_line_tracker/tracking/line_frame.h"

namespace tet_line_tracker {

/// Which tracks make a line in space.
struct LineMapperParameters {
  int min_views{5};          ///< images that see a line, 2..1000
  double min_parallax{3.0};  ///< angle between the two viewing planes furthest apart, 0.01..90 [deg]
  double max_reprojection{
      1.0};                   ///< mean distance of the observed ends from the projected line, 0.01..100 [px]
  double max_sigma{0.03};     ///< of the ends, across the line, 1e-6..100 [m]
  double max_distance{20.0};  ///< of the ends from the camera, 0.1..1e6 [m]
  double default_sigma{0.5};  ///< of a line whose tracker gave none, 0.01..100 [px]
  double sigma_floor{0.2};    ///< added in squares to what the tracker gave, 0..100 [px]
  double correlated_views{15.0};  ///< images in a row in which a tracker errs alike, 1..1000
  int max_views{60};              ///< kept per line, spread over its life, 4..1000
  int max_lines{5000};            ///< finished lines; the oldest are forgotten, 1..1000000
};

/// Entries bound to the fields of `parameters`, which must outlive the table.
ParameterTable tableOf(LineMapperParameters& parameters);

/// A line in space.
struct MappedLine {
  std::uint64_t id{0};                             ///< in the map, never used again
  std::uint32_t epoch{0};                          ///< of the track
  std::uint64_t track{0};                          ///< id of the track in its epoch
  Eigen::Vector3d start{Eigen::Vector3d::Zero()};  ///< [m]
  Eigen::Vector3d end{Eigen::Vector3d::Zero()};    ///< [m]
  double sigma_start{0.0};  ///< standard deviation across the line at its start, in the worst direction [m]
  double sigma_end{0.0};    ///< [m]
  int views{0};             ///< images that saw the line
  double reprojection_px{0.0};  ///< mean distance of the observed ends from the projected line [px]
  double parallax{0.0};         ///< angle between the two viewing planes furthest apart [rad]
  double distance{0.0};         ///< of the middle from the cameras, mean [m]
  bool finished{false};         ///< its track has ended
};

/// Turns tracks seen from known poses into lines in space: the two viewing planes with the widest angle give
/// a first line, all views refine it, the rays of the first and last view give its ends. Not thread-safe.
class LineMapper {
 public:
  /// Why tracks that ended are not in the map.
  struct Rejected {
    std::uint64_t few_views{0}, parallax{0}, reprojection{0}, sigma{0}, ends{0};
  };

  /// Throws std::invalid_argument with every broken rule.
  explicit LineMapper(const LineMapperParameters& parameters);

  /// The lines of one image and the pose of its camera in the world. Lines without normalised endpoints are
  /// not used. Images for which no pose is known are left out; tracks go on over them.
  void add(const LineFrame& frame, const Eigen::Isometry3d& world_from_camera);
  /// Ends all tracks.
  void finish();

  /// Finished lines, the oldest first, then those of tracks that go on.
  std::vector<MappedLine> lines();
  /// Finished lines in the map.
  std::size_t finishedLines() const { return finished_.size(); }
  const Rejected& rejected() const { return rejected_; }

 private:
  struct Track {
    std::uint64_t id;  ///< in the map
    std::uint32_t epoch;
    std::uint64_t track;
    std::uint32_t age;          ///< as the tracker said it
    std::uint64_t image_count;  ///< of the last image that showed it
    int views{0};
    int stride{1};  ///< every so many views one is kept
    std::vector<LineView> kept;
    std::optional<LineView> last;  ///< newest, when it is not among those kept
    bool changed{true};            ///< since `line` was estimated
    std::optional<MappedLine> line;
  };

  void addView(Track& track, const LineView& view) const;
  void finish(Track& track);
  std::optional<MappedLine> estimate(const Track& track, Rejected* rejected) const;

  LineMapperParameters parameters_;
  std::uint64_t next_id_{0};
  std::unordered_map<std::uint64_t, Track> tracks_;  ///< by id of the tracker
  std::deque<MappedLine> finished_;
  Rejected rejected_;
};

}  // namespace tet_line_tracker
