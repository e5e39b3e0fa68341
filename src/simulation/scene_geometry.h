#pragma once

#include <cstdint>
#include <optional>
#include <string>
#include <utility>
#include <vector>

#include <Eigen/Geometry>

namespace tet_line_tracker {

struct SurfacePoint {
  int surface{-1};           ///< index into SceneGeometry::rectangles()
  Eigen::Vector2d position;  ///< along the rectangle's u and v axis, from its origin [m]
};

struct RayHit {
  double distance{0.0};  ///< along the unit ray [m]
  SurfacePoint point;
};

/// A straight edge of the static world: an outline, or painted (brick joint, poster, door panel) [m].
struct TrueEdge {
  Eigen::Vector3d start;
  Eigen::Vector3d end;
};

/// What a surface is to those who look for lines. Only those on solid ones have a true edge in space.
enum class SurfaceKind {
  kSolid,
  kRound,    ///< facet of a column or a pipe, whose outline slides over it
  kCable,    ///< sags: no part of it is straight
  kFoliage,  ///< leaves in the wind
  kPerson,   ///< walks
  kMirror,   ///< shows what is before it
  kScreen,   ///< shows one picture after the other
};
constexpr int kSurfaceKinds = 7;
/// One word.
const char* nameOf(SurfaceKind kind);

/// An opaque rectangle, seen from both sides, in the frame of its body.
struct Rectangle {
  Eigen::Vector3d origin;  ///< corner at u = v = 0 [m]
  Eigen::Vector3d u_axis;  ///< unit vector
  Eigen::Vector3d v_axis;  ///< unit vector, normal to u_axis
  double width{0.0};       ///< along u [m]
  double height{0.0};      ///< along v [m]
  int body{-1};            ///< index into SceneGeometry::bodies(); -1: does not move, frame is the world
  SurfaceKind kind{SurfaceKind::kSolid};
};

/// A body that swings to and fro and turns about its own vertical, both as sines of time.
struct MovingBody {
  std::int64_t origin_ns{0};   ///< stamp at which both sines are zero
  Eigen::Vector3d centre;      ///< in the world [m]
  Eigen::Vector3d swing;       ///< largest displacement from the centre [m]
  double swing_period_s{1.0};  ///< [s]
  double turn_rad{0.0};        ///< largest angle about z [rad]
  double turn_period_s{1.0};   ///< [s]

  Eigen::Isometry3d worldFromBody(std::int64_t stamp_ns) const;
};

/// Exact geometry of a simulated world: rectangles in space, some of them moving. Serialised into the bag, on
/// kSceneTopic. Const methods may be called from several threads.
class SceneGeometry {
 public:
  /// Line by line: `argument NAME VALUE` (what made the bag), `body ...`, `rectangle ... [KIND]`, `edge ...`.
  /// Numbers come back bit for bit.
  std::string toText() const;
  /// Throws std::runtime_error with one sentence on bad text.
  static SceneGeometry fromText(const std::string& text);

  /// Nearest rectangle that a ray meets in front of its origin.
  std::optional<RayHit> raycast(const Eigen::Vector3d& origin, const Eigen::Vector3d& unit_direction,
                                std::int64_t stamp_ns) const;
  /// Where a point of a surface is in the world at a time; moving surfaces carry it along [m]. Throws
  /// std::out_of_range for an unknown surface.
  Eigen::Vector3d pointAt(const SurfacePoint& point, std::int64_t stamp_ns) const;

  /// Straight edges of the static world. Those on one surface that something in front hides are in as well.
  const std::vector<TrueEdge>& edges() const { return edges_; }
  const std::vector<Rectangle>& rectangles() const { return rectangles_; }
  const std::vector<MovingBody>& bodies() const { return bodies_; }
  /// What made the bag, by name: scene, motion, light, seed...
  const std::vector<std::pair<std::string, std::string>>& arguments() const { return arguments_; }

  int addRectangle(const Rectangle& rectangle);
  int addBody(const MovingBody& body);
  void addEdge(const TrueEdge& edge) { edges_.push_back(edge); }
  /// `name` is one word; `value` is one line.
  void addArgument(const std::string& name, const std::string& value) {
    arguments_.emplace_back(name, value);
  }

 private:
  std::vector<std::pair<std::string, std::string>> arguments_;
  std::vector<MovingBody> bodies_;
  std::vector<Rectangle> rectangles_;
  std::vector<TrueEdge> edges_;
};

/// Where simulate_bag writes SceneGeometry::toText() (std_msgs/String), once, before the first image.
constexpr char kSceneTopic[] = "/simulation/scene";

}  // namespace tet_line_tracker
