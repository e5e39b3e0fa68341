#include "world_builder.h"

#include <cmath>

namespace tet_line_tracker {

WorldBuilder::WorldBuilder(std::uint64_t seed)
    : random_(seed, 1), grain_(std::make_shared<Grain>(hash64(seed, 2))) {}

void WorldBuilder::addRectangle(const Rectangle& rectangle, float gray, float grain,
                                const Decoration& decorate) {
  world_.geometry.addRectangle(rectangle);
  Texture texture(static_cast<float>(rectangle.width), static_cast<float>(rectangle.height), gray);
  const auto offset_u = static_cast<float>(random_.uniform(0.0, 4.0));
  const auto offset_v = static_cast<float>(random_.uniform(0.0, 4.0));
  texture.setGrain(grain_, grain, {offset_u, offset_v});

  // Faces that look different ways get different light, so that the edge between them shows.
  const Eigen::Vector3d normal = rectangle.u_axis.cross(rectangle.v_axis);
  const Eigen::Vector3d towards_lamp = Eigen::Vector3d(0.5, -0.3, 0.81).normalized();
  const double light = 0.88 + 0.16 * normal.dot(towards_lamp);
  texture.setLight(static_cast<float>(light), static_cast<float>(random_.uniform(-0.15, 0.15)),
                   static_cast<float>(random_.uniform(-0.05, 0.15)));
  if (decorate) decorate(texture);

  if (rectangle.body < 0 && rectangle.kind == SurfaceKind::kSolid) {
    const auto inWorld = [&](double u, double v) -> Eigen::Vector3d {
      return rectangle.origin + u * rectangle.u_axis + v * rectangle.v_axis;
    };
    const double w = rectangle.width;
    const double h = rectangle.height;
    world_.geometry.addEdge({inWorld(0, 0), inWorld(w, 0)});
    world_.geometry.addEdge({inWorld(0, h), inWorld(w, h)});
    world_.geometry.addEdge({inWorld(0, 0), inWorld(0, h)});
    world_.geometry.addEdge({inWorld(w, 0), inWorld(w, h)});
    for (const TextureEdge& edge : texture.edges()) {
      world_.geometry.addEdge({inWorld(edge.start.x(), edge.start.y()), inWorld(edge.end.x(), edge.end.y())});
    }
  }
  world_.textures.push_back(std::move(texture));
}

void WorldBuilder::addWall(const Eigen::Vector2d& start, const Eigen::Vector2d& end, double height,
                           float gray, float grain, const Decoration& decorate) {
  Rectangle wall;
  wall.origin = {start.x(), start.y(), 0.0};
  wall.u_axis = Eigen::Vector3d(end.x() - start.x(), end.y() - start.y(), 0.0).normalized();
  wall.v_axis = Eigen::Vector3d::UnitZ();
  wall.width = (end - start).norm();
  wall.height = height;
  addRectangle(wall, gray, grain, decorate);
}

void WorldBuilder::addBox(const Eigen::Vector3d& foot, const Eigen::Vector3d& size, double yaw,
                          unsigned faces, float gray, float grain, const Decoration& decorate, int body) {
  const Eigen::Vector3d x(std::cos(yaw), std::sin(yaw), 0.0);
  const Eigen::Vector3d y(-std::sin(yaw), std::cos(yaw), 0.0);
  const Eigen::Vector3d z = Eigen::Vector3d::UnitZ();
  const Eigen::Vector3d corner = foot - 0.5 * size.x() * x - 0.5 * size.y() * y;
  const Eigen::Vector3d far_x = corner + size.x() * x;
  const Eigen::Vector3d far_y = corner + size.y() * y;
  const Eigen::Vector3d far_xy = far_x + size.y() * y;
  // u runs to the right for who looks at the face from outside, so normals point outwards.
  const auto add = [&](unsigned face, const Eigen::Vector3d& origin, const Eigen::Vector3d& u,
                       const Eigen::Vector3d& v, double width, double height) {
    if ((faces & face) != 0) addRectangle({origin, u, v, width, height, body}, gray, grain, decorate);
  };
  add(kFront, corner, x, z, size.x(), size.z());
  add(kRight, far_x, y, z, size.y(), size.z());
  add(kBack, far_xy, -x, z, size.x(), size.z());
  add(kLeft, far_y, -y, z, size.y(), size.z());
  add(kBottom, far_y, x, -y, size.x(), size.y());
  add(kTop, corner + size.z() * z, x, y, size.x(), size.y());
}

}  // namespace tet_line_tracker
