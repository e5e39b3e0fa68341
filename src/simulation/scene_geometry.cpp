#include "scene_geometry.h"

#include <algorithm>
#include <array>
#include <cmath>
#include <limits>
#include <sstream>
#include <stdexcept>

namespace tet_line_tracker {
namespace {

constexpr char kFirstLine[] = "tet_line_tracker_scene 1";
constexpr char kLastLine[] = "end";
constexpr std::array<const char*, kSurfaceKinds> kKindNames{"solid",  "round",  "cable", "foliage",
                                                            "person", "mirror", "screen"};

std::ostream& operator<<(std::ostream& out, const Eigen::Vector3d& v) {
  return out << v.x() << ' ' << v.y() << ' ' << v.z();
}

std::istream& operator>>(std::istream& in, Eigen::Vector3d& v) {
  return in >> v.x() >> v.y() >> v.z();
}

bool allFinite(const Rectangle& r) {
  return r.origin.allFinite() && r.u_axis.allFinite() && r.v_axis.allFinite() && std::isfinite(r.width) &&
         std::isfinite(r.height);
}

/// Distance along the ray and position on the rectangle, all in the rectangle's frame.
std::optional<RayHit> meet(const Rectangle& rectangle, const Eigen::Vector3d& origin,
                           const Eigen::Vector3d& direction) {
  const Eigen::Vector3d normal = rectangle.u_axis.cross(rectangle.v_axis);
  const double approach = normal.dot(direction);
  if (approach == 0.0) return std::nullopt;
  const double distance = normal.dot(rectangle.origin - origin) / approach;
  if (!(distance > 0.0)) return std::nullopt;
  const Eigen::Vector3d from_corner = origin + distance * direction - rectangle.origin;
  RayHit hit;
  hit.distance = distance;
  hit.point.position = {from_corner.dot(rectangle.u_axis), from_corner.dot(rectangle.v_axis)};
  const auto [u, v] = std::make_pair(hit.point.position.x(), hit.point.position.y());
  if (!(u >= 0.0 && u <= rectangle.width && v >= 0.0 && v <= rectangle.height)) return std::nullopt;
  return hit;
}

/// The word at the end of a line, if there is one; nothing: it is no kind.
std::optional<SurfaceKind> readKind(std::istream& in) {
  if ((in >> std::ws).eof()) return SurfaceKind::kSolid;
  std::string word;
  in >> word;
  const auto* const name = std::find(kKindNames.begin(), kKindNames.end(), word);
  if (name == kKindNames.end()) return std::nullopt;
  return static_cast<SurfaceKind>(name - kKindNames.begin());
}

[[noreturn]] void throwBadLine(std::size_t number, const std::string& line, const std::string& why) {
  throw std::runtime_error("scene text: line " + std::to_string(number) + " (\"" + line.substr(0, 60) +
                           "\") " + why);
}

}  // namespace

const char* nameOf(SurfaceKind kind) {
  return kKindNames[static_cast<std::size_t>(kind)];
}

Eigen::Isometry3d MovingBody::worldFromBody(std::int64_t stamp_ns) const {
  const double time_s = 1e-9 * static_cast<double>(stamp_ns - origin_ns);
  const double swing_phase = std::sin(2.0 * M_PI * time_s / swing_period_s);
  const double turn_phase = std::sin(2.0 * M_PI * time_s / turn_period_s);
  Eigen::Isometry3d pose = Eigen::Isometry3d::Identity();
  pose.translate(centre + swing_phase * swing);
  pose.rotate(Eigen::AngleAxisd(turn_phase * turn_rad, Eigen::Vector3d::UnitZ()));
  return pose;
}

int SceneGeometry::addRectangle(const Rectangle& rectangle) {
  rectangles_.push_back(rectangle);
  return static_cast<int>(rectangles_.size()) - 1;
}

int SceneGeometry::addBody(const MovingBody& body) {
  bodies_.push_back(body);
  return static_cast<int>(bodies_.size()) - 1;
}

std::string SceneGeometry::toText() const {
  std::ostringstream out;
  out.precision(std::numeric_limits<double>::max_digits10);
  out << kFirstLine << '\n';
  for (const auto& [name, value] : arguments_) out << "argument " << name << ' ' << value << '\n';
  for (const MovingBody& b : bodies_) {
    out << "body " << b.origin_ns << ' ' << b.centre << ' ' << b.swing << ' ' << b.swing_period_s << ' '
        << b.turn_rad << ' ' << b.turn_period_s << '\n';
  }
  for (const Rectangle& r : rectangles_) {
    out << "rectangle " << r.body << ' ' << r.origin << ' ' << r.u_axis << ' ' << r.v_axis << ' ' << r.width
        << ' ' << r.height;
    if (r.kind != SurfaceKind::kSolid) out << ' ' << nameOf(r.kind);
    out << '\n';
  }
  for (const TrueEdge& e : edges_) out << "edge " << e.start << ' ' << e.end << '\n';
  out << kLastLine << '\n';
  return out.str();
}

SceneGeometry SceneGeometry::fromText(const std::string& text) {
  std::istringstream lines(text);
  std::string line;
  std::size_t number = 1;
  if (!std::getline(lines, line) || line != kFirstLine) {
    throw std::runtime_error("scene text: starts with \"" + line.substr(0, 60) + "\", needs \"" + kFirstLine +
                             "\"");
  }
  SceneGeometry scene;
  bool ended = false;
  while (!ended && std::getline(lines, line)) {
    ++number;
    std::istringstream in(line);
    std::string kind;
    in >> kind;
    if (kind == kLastLine) {
      ended = true;
    } else if (kind == "argument") {
      std::string name;
      std::string value;
      in >> name >> std::ws;
      if (!in.eof()) std::getline(in, value);
      scene.addArgument(name, value);
      continue;
    } else if (kind == "body") {
      MovingBody b;
      in >> b.origin_ns >> b.centre >> b.swing >> b.swing_period_s >> b.turn_rad >> b.turn_period_s;
      if (!(b.swing_period_s > 0.0 && b.turn_period_s > 0.0)) {
        throwBadLine(number, line, "needs periods above 0");
      }
      scene.addBody(b);
    } else if (kind == "rectangle") {
      Rectangle r;
      in >> r.body >> r.origin >> r.u_axis >> r.v_axis >> r.width >> r.height;
      if (!in.fail() && !allFinite(r)) throwBadLine(number, line, "needs finite numbers");
      if (r.body < -1 || r.body >= static_cast<int>(scene.bodies_.size())) {
        throwBadLine(number, line, "names a body that was not described above it");
      }
      if (!in.fail()) {
        const auto surface_kind = readKind(in);
        if (!surface_kind) throwBadLine(number, line, "ends with a word that is no kind of surface");
        r.kind = *surface_kind;
        in.clear();
      }
      scene.addRectangle(r);
    } else if (kind == "edge") {
      TrueEdge e;
      in >> e.start >> e.end;
      scene.addEdge(e);
    } else {
      throwBadLine(number, line, "is of no known kind");
    }
    if (in.fail()) throwBadLine(number, line, "has too few numbers");
  }
  if (!ended) {
    throw std::runtime_error("scene text: stops after line " + std::to_string(number) + " without \"" +
                             kLastLine + "\"");
  }
  return scene;
}

std::optional<RayHit> SceneGeometry::raycast(const Eigen::Vector3d& origin,
                                             const Eigen::Vector3d& unit_direction,
                                             std::int64_t stamp_ns) const {
  std::optional<RayHit> nearest;
  int pose_of = -1;
  Eigen::Isometry3d body_from_world = Eigen::Isometry3d::Identity();
  for (std::size_t i = 0; i < rectangles_.size(); ++i) {
    const Rectangle& rectangle = rectangles_[i];
    std::optional<RayHit> hit;
    if (rectangle.body < 0) {
      hit = meet(rectangle, origin, unit_direction);
    } else {
      if (pose_of != rectangle.body) {
        pose_of = rectangle.body;
        body_from_world = bodies_[static_cast<std::size_t>(pose_of)].worldFromBody(stamp_ns).inverse();
      }
      hit = meet(rectangle, body_from_world * origin, body_from_world.linear() * unit_direction);
    }
    if (!hit || (nearest && nearest->distance <= hit->distance)) continue;
    nearest = hit;
    nearest->point.surface = static_cast<int>(i);
  }
  return nearest;
}

Eigen::Vector3d SceneGeometry::pointAt(const SurfacePoint& point, std::int64_t stamp_ns) const {
  const Rectangle& r = rectangles_.at(static_cast<std::size_t>(point.surface));
  Eigen::Vector3d in_body = r.origin + point.position.x() * r.u_axis + point.position.y() * r.v_axis;
  if (r.body < 0) return in_body;
  return bodies_[static_cast<std::size_t>(r.body)].worldFromBody(stamp_ns) * in_body;
}

}  // namespace tet_line_tracker
