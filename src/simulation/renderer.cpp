#include "renderer.h"

#include <algorithm>
#include <atomic>
#include <cmath>
#include <limits>
#include <stdexcept>
#include <thread>

namespace tet_line_tracker {
namespace {

constexpr int kTileSide = 16;
constexpr int kBlockSide = 8 * kTileSide;
constexpr int kMostOutlineSamples = 34;
constexpr int kNothing = -1;

/// Fibonacci lattice over a pixel, which leaves no direction badly sampled. The views of a blurred image are
/// displaced against each other and need fewer samples each.
struct OutlineLattice {
  int samples, stride;
  Eigen::Vector2f offset(int i) const {
    const auto inPixel = [this](int k) {
      return (static_cast<float>(k) + 0.5F) / static_cast<float>(samples) - 0.5F;
    };
    return {inPixel(i), inPixel(i * stride % samples)};
  }
};

OutlineLattice outlineLattice(std::size_t views) {
  if (views == 1) return {kMostOutlineSamples, 21};
  return views <= 3 ? OutlineLattice{13, 8} : OutlineLattice{8, 5};
}

Eigen::Vector3f rayOrNan(const CameraModel& camera, double x, double y) {
  const auto ray = camera.unproject({x, y});
  if (!ray) return Eigen::Vector3f::Constant(std::numeric_limits<float>::quiet_NaN());
  return ray->cast<float>();
}

}  // namespace

Renderer::Renderer(std::shared_ptr<const CameraModel> camera, const World& world, int threads)
    : camera_(std::move(camera)),
      world_(world),
      threads_(std::max(1, threads)),
      size_(camera_->calibration().width, camera_->calibration().height) {
  if (size_.width < 2 || size_.height < 2) {
    throw std::invalid_argument("calibration: size is " + std::to_string(size_.width) + " x " +
                                std::to_string(size_.height) + ", rendering needs at least 2 x 2");
  }
  makeTiles();
  makeRays(*camera_);
  parallelTiles([&](std::size_t number) { bound(tiles_[number]); });
  parallel(blocks_.size(), [&](std::size_t number) { bound(blocks_[number]); });
  surface_.create(size_);
}

void Renderer::makeTiles() {
  const auto split = [&](int side, std::vector<Tile>& tiles) {
    for (int y = 0; y < size_.height; y += side) {
      for (int x = 0; x < size_.width; x += side) {
        tiles.emplace_back();
        tiles.back().pixels = cv::Rect(x, y, side, side) & cv::Rect(cv::Point(), size_);
      }
    }
  };
  split(kTileSide, tiles_);
  split(kBlockSide, blocks_);
  const int blocks_per_row = (size_.width + kBlockSide - 1) / kBlockSide;
  for (const Tile& tile : tiles_) {
    block_of_.push_back(
        static_cast<std::size_t>(tile.pixels.y / kBlockSide * blocks_per_row + tile.pixels.x / kBlockSide));
  }
}

void Renderer::makeRays(const CameraModel& camera) {
  const auto width = static_cast<std::size_t>(size_.width);
  const auto indexOf = [&](int x, int y) {
    return static_cast<std::size_t>(y) * width + static_cast<std::size_t>(x);
  };
  rays_.resize(width * static_cast<std::size_t>(size_.height));
  parallelTiles([&](std::size_t number) {
    const cv::Rect& area = tiles_[number].pixels;
    for (int y = area.y; y < area.y + area.height; ++y) {
      for (int x = area.x; x < area.x + area.width; ++x) rays_[indexOf(x, y)].ray = rayOrNan(camera, x, y);
    }
  });
  parallelTiles([&](std::size_t number) {
    const cv::Rect& area = tiles_[number].pixels;
    const auto ray = [&](int x, int y) -> Eigen::Vector3f {
      const bool inside = x >= 0 && y >= 0 && x < size_.width && y < size_.height;
      return inside ? rays_[indexOf(x, y)].ray : rayOrNan(camera, x, y);
    };
    for (int y = area.y; y < area.y + area.height; ++y) {
      for (int x = area.x; x < area.x + area.width; ++x) {
        PixelRay& pixel = rays_[indexOf(x, y)];
        pixel.per_x = 0.5F * (ray(x + 1, y) - ray(x - 1, y));
        pixel.per_y = 0.5F * (ray(x, y + 1) - ray(x, y - 1));
        // Where the model ends a pixel counts as a point.
        if (!pixel.per_x.allFinite()) pixel.per_x.setZero();
        if (!pixel.per_y.allFinite()) pixel.per_y.setZero();
      }
    }
  });
}

void Renderer::bound(Tile& tile) const {
  const cv::Rect& area = tile.pixels;
  tile.middle = rayAt(area.x + area.width / 2, area.y + area.height / 2).ray;
  if (area.width < 2 || area.height < 2) return;
  const int right = area.x + area.width - 1;
  const int bottom = area.y + area.height - 1;
  const std::array<Eigen::Vector3d, 4> corners{
      rayAt(area.x, area.y).ray.cast<double>(), rayAt(right, area.y).ray.cast<double>(),
      rayAt(right, bottom).ray.cast<double>(), rayAt(area.x, bottom).ray.cast<double>()};
  bool complete = true;
  for (std::size_t side = 0; side < 4; ++side) {
    Eigen::Vector3d normal = corners[side].cross(corners[(side + 1) % 4]).normalized();
    if (normal.dot(tile.middle.cast<double>()) < 0.0) normal = -normal;
    double lowest = 0.0;
    for (int y = area.y; y <= bottom; ++y) {
      for (int x = area.x; x <= right; ++x) {
        const PixelRay& pixel = rayAt(x, y);
        complete = complete && pixel.ray.allFinite();
        const double half_pixel = 0.5 * static_cast<double>(pixel.per_x.norm() + pixel.per_y.norm());
        lowest = std::min(lowest, normal.dot(pixel.ray.cast<double>()) - half_pixel);
      }
    }
    tile.normals[side] = normal;
    tile.slacks[side] = lowest;
  }
  tile.bounded = complete;
}

void Renderer::parallel(std::size_t count, const std::function<void(std::size_t)>& body) const {
  std::atomic<std::size_t> next{0};
  const auto work = [&] {
    constexpr std::size_t kRun = 8;
    for (std::size_t first = next.fetch_add(kRun); first < count; first = next.fetch_add(kRun)) {
      for (std::size_t i = first; i < std::min(first + kRun, count); ++i) body(i);
    }
  };
  std::vector<std::thread> helpers;
  for (int i = 1; i < threads_; ++i) helpers.emplace_back(work);
  work();
  for (std::thread& helper : helpers) helper.join();
}

std::vector<Renderer::SeenRectangle> Renderer::see(const Eigen::Isometry3d& camera_from_world,
                                                   std::int64_t stamp_ns) const {
  const SceneGeometry& geometry = world_.geometry;
  std::vector<Eigen::Isometry3d> camera_from_body;
  for (const MovingBody& body : geometry.bodies()) {
    camera_from_body.push_back(camera_from_world * body.worldFromBody(stamp_ns));
  }
  std::vector<SeenRectangle> all;
  all.reserve(geometry.rectangles().size());
  for (std::size_t i = 0; i < geometry.rectangles().size(); ++i) {
    const Rectangle& r = geometry.rectangles()[i];
    const Eigen::Isometry3d& pose =
        r.body < 0 ? camera_from_world : camera_from_body[static_cast<std::size_t>(r.body)];
    const Eigen::Vector3d origin = pose * r.origin;
    const Eigen::Vector3d u_axis = pose.linear() * r.u_axis;
    const Eigen::Vector3d v_axis = pose.linear() * r.v_axis;
    const Eigen::Vector3d normal = u_axis.cross(v_axis);
    const double distance = normal.dot(origin);
    if (std::abs(distance) < 1e-6) continue;  // seen edge-on
    SeenRectangle seen;
    seen.surface = static_cast<int>(i);
    seen.inverse_depth = (normal / distance).cast<float>();
    seen.u_axis = u_axis.cast<float>();
    seen.v_axis = v_axis.cast<float>();
    seen.u = static_cast<float>(-u_axis.dot(origin));
    seen.v = static_cast<float>(-v_axis.dot(origin));
    seen.width = static_cast<float>(r.width);
    seen.height = static_cast<float>(r.height);
    seen.corners = {origin, origin + r.width * u_axis, origin + r.width * u_axis + r.height * v_axis,
                    origin + r.height * v_axis};
    for (std::size_t k = 0; k < 4; ++k) seen.distances[k] = seen.corners[k].norm();
    all.push_back(seen);
  }
  return all;
}

std::vector<const Renderer::SeenRectangle*> Renderer::within(const Tile& tile,
                                                             const std::vector<const SeenRectangle*>& seen) {
  std::vector<const SeenRectangle*> result;
  for (const SeenRectangle* rectangle : seen) {
    bool outside = false;
    for (std::size_t side = 0; tile.bounded && !outside && side < 4; ++side) {
      // The points beyond a shifted plane form a convex cone: with all corners the whole rectangle is in it.
      outside = true;
      for (std::size_t k = 0; outside && k < 4; ++k) {
        outside = tile.normals[side].dot(rectangle->corners[k]) < tile.slacks[side] * rectangle->distances[k];
      }
    }
    if (!outside) result.push_back(rectangle);
  }
  return result;
}

std::vector<const Renderer::SeenRectangle*> Renderer::candidates(
    const Tile& tile, const std::vector<const SeenRectangle*>& seen) {
  std::vector<const SeenRectangle*> result = within(tile, seen);
  // Nearest first, so that the others need no more than a look at their depth.
  std::stable_sort(result.begin(), result.end(), [&](const SeenRectangle* a, const SeenRectangle* b) {
    return a->inverse_depth.dot(tile.middle) > b->inverse_depth.dot(tile.middle);
  });
  return result;
}

int Renderer::nearest(const std::vector<const SeenRectangle*>& candidates, const SeenRectangle* mirror,
                      const Eigen::Vector3f& ray) {
  const float limit =
      mirror == nullptr ? std::numeric_limits<float>::infinity() : mirror->inverse_depth.dot(ray);
  int best = kNothing;
  float best_inverse = 0.0F;
  for (std::size_t i = 0; i < candidates.size(); ++i) {
    const SeenRectangle& seen = *candidates[i];
    const float inverse = seen.inverse_depth.dot(ray);
    if (!(inverse > best_inverse && inverse < limit)) continue;
    const float distance = 1.0F / inverse;
    const float u = seen.u + distance * seen.u_axis.dot(ray);
    if (!(u >= 0.0F && u <= seen.width)) continue;
    const float v = seen.v + distance * seen.v_axis.dot(ray);
    if (!(v >= 0.0F && v <= seen.height)) continue;
    best = static_cast<int>(i);
    best_inverse = inverse;
  }
  return best;
}

float Renderer::shade(const Pass& pass, const SeenRectangle& seen, const Eigen::Vector3f& ray,
                      const cv::Point& pixel) const {
  const float distance = 1.0F / seen.inverse_depth.dot(ray);
  const float along_u = seen.u_axis.dot(ray);
  const float along_v = seen.v_axis.dot(ray);
  const auto footprint = [&](const Eigen::Vector3f& step) {
    const float farther = -distance * distance * seen.inverse_depth.dot(step);
    return Eigen::Vector2f(distance * seen.u_axis.dot(step) + farther * along_u,
                           distance * seen.v_axis.dot(step) + farther * along_v);
  };
  const Eigen::Vector2f per_x = footprint(rayAt(pixel).per_x);
  const Eigen::Vector2f per_y = footprint(rayAt(pixel).per_y);
  const float u = std::min(std::max(seen.u + distance * along_u, 0.0F), seen.width);
  const float v = std::min(std::max(seen.v + distance * along_v, 0.0F), seen.height);
  float gray = world_.textureAt(seen.surface, pass.stamp_ns)
                   .gray(u, v, {per_x.x(), per_y.x()}, {per_x.y(), per_y.y()});
  for (const Reflection& reflection : pass.reflections) {
    if (reflection.surface == seen.surface) gray += reflection.share * (reflection.radiance(pixel) - gray);
  }
  return gray;
}

float Renderer::shadeOutline(const Pass& pass, const std::vector<const SeenRectangle*>& candidates,
                             const cv::Point& pixel) const {
  const OutlineLattice lattice = outlineLattice(pass.views);
  const auto rayTo = [&](const Eigen::Vector2f& offset) -> Eigen::Vector3f {
    const PixelRay& middle = rayAt(pixel);
    return middle.ray + offset.x() * middle.per_x + offset.y() * middle.per_y;
  };
  struct Part {
    int candidate;
    int samples;
    Eigen::Vector2f sum;
  };
  std::array<Part, kMostOutlineSamples> parts{};
  std::size_t count = 0;
  for (int i = 0; i < lattice.samples; ++i) {
    const Eigen::Vector2f offset = lattice.offset(i);
    const int candidate = nearest(candidates, pass.mirror, rayTo(offset));
    if (candidate == kNothing) continue;
    std::size_t k = 0;
    while (k < count && parts[k].candidate != candidate) ++k;
    if (k == count) parts[count++] = {candidate, 0, Eigen::Vector2f::Zero()};
    ++parts[k].samples;
    parts[k].sum += offset;
  }
  float gray = 0.0F;
  for (std::size_t k = 0; k < count; ++k) {
    const auto samples = static_cast<float>(parts[k].samples);
    const SeenRectangle& seen = *candidates[static_cast<std::size_t>(parts[k].candidate)];
    gray += samples * shade(pass, seen, rayTo(parts[k].sum / samples), pixel);
  }
  return gray / static_cast<float>(lattice.samples);
}

bool Renderer::onOutline(const cv::Point& pixel) const {
  const int own = surface_(pixel);
  for (int j = std::max(0, pixel.y - 1); j <= std::min(size_.height - 1, pixel.y + 1); ++j) {
    for (int i = std::max(0, pixel.x - 1); i <= std::min(size_.width - 1, pixel.x + 1); ++i) {
      if (surface_(j, i) != own) return true;
    }
  }
  return false;
}

cv::Mat Renderer::render(const std::vector<View>& views, const cv::Range& rows) {
  cv::Mat_<float> radiance(size_, 0.0F);
  const float share = 1.0F / static_cast<float>(views.size());
  for (const View& view : views) render(makePass(view, views, rows), share, radiance);
  return std::move(radiance);
}

Renderer::Pass Renderer::makePass(const View& view, const std::vector<View>& views, const cv::Range& rows) {
  const Eigen::Isometry3d camera_from_world = view.world_from_camera.inverse();
  Pass pass{see(camera_from_world, view.stamp_ns), view.stamp_ns, nullptr, {}, views.size(), rows};
  for (const Mirror& mirror : world_.mirrors) {
    const auto isMirror = [&](const SeenRectangle& seen) { return seen.surface == mirror.surface; };
    const auto seen = std::find_if(pass.rectangles.begin(), pass.rectangles.end(), isMirror);
    if (seen == pass.rectangles.end()) continue;
    // All that is mirrored at its plane, seen by the same camera.
    const Rectangle& plane = world_.geometry.rectangles()[static_cast<std::size_t>(mirror.surface)];
    const Eigen::Vector3d normal = plane.u_axis.cross(plane.v_axis);
    Eigen::Isometry3d reflection = Eigen::Isometry3d::Identity();
    reflection.linear() -= 2.0 * normal * normal.transpose();
    reflection.translation() = 2.0 * normal.dot(plane.origin) * normal;
    Pass mirrored{
        see(camera_from_world * reflection, view.stamp_ns), view.stamp_ns, &*seen, {}, views.size(), rows};
    mirrored.rectangles.erase(
        std::remove_if(mirrored.rectangles.begin(), mirrored.rectangles.end(), isMirror),
        mirrored.rectangles.end());
    cv::Mat_<float> radiance(size_, 0.0F);
    render(mirrored, 1.0F, radiance);
    pass.reflections.push_back({mirror.surface, mirror.share, radiance});
  }
  return pass;
}

void Renderer::render(const Pass& pass, float share, cv::Mat_<float>& radiance) {
  // Whether a pixel is on an outline, its neighbours tell.
  constexpr int kNeighbours = 2;
  const auto isWanted = [&](std::size_t number) {
    const cv::Rect& area = tiles_[number].pixels;
    if (pass.mirror != nullptr && within(tiles_[number], {pass.mirror}).empty()) return false;
    return pass.rows == cv::Range::all() ||
           (area.y < pass.rows.end + kNeighbours && area.y + area.height > pass.rows.start - kNeighbours);
  };
  std::vector<const SeenRectangle*> seen;
  seen.reserve(pass.rectangles.size());
  for (const SeenRectangle& rectangle : pass.rectangles) seen.push_back(&rectangle);
  std::vector<std::vector<const SeenRectangle*>> block_candidates(blocks_.size());
  parallel(blocks_.size(), [&](std::size_t i) { block_candidates[i] = within(blocks_[i], seen); });
  std::vector<std::vector<const SeenRectangle*>> tile_candidates(tiles_.size());
  const auto forEachPixel = [&](std::size_t number, const auto& body) {
    const cv::Rect& area = tiles_[number].pixels;
    for (int y = area.y; y < area.y + area.height; ++y) {
      for (int x = area.x; x < area.x + area.width; ++x) body(cv::Point(x, y));
    }
  };
  surface_ = kNothing;
  parallelTiles([&](std::size_t number) {
    if (!isWanted(number)) return;
    tile_candidates[number] = candidates(tiles_[number], block_candidates[block_of_[number]]);
    const auto& near = tile_candidates[number];
    forEachPixel(number, [&](const cv::Point& pixel) {
      const int candidate = nearest(near, pass.mirror, rayAt(pixel).ray);
      surface_(pixel) = candidate == kNothing ? kNothing : near[static_cast<std::size_t>(candidate)]->surface;
    });
  });
  parallelTiles([&](std::size_t number) {
    if (!isWanted(number)) return;
    const auto& near = tile_candidates[number];
    const SeenRectangle* last = nullptr;
    forEachPixel(number, [&](const cv::Point& pixel) {
      if (onOutline(pixel)) {
        radiance(pixel) += share * shadeOutline(pass, near, pixel);
        return;
      }
      const int surface = surface_(pixel);
      if (surface == kNothing) return;
      if (last == nullptr || last->surface != surface) {
        last = *std::find_if(near.begin(), near.end(),
                             [&](const SeenRectangle* s) { return s->surface == surface; });
      }
      radiance(pixel) += share * shade(pass, *last, rayAt(pixel).ray, pixel);
    });
  });
}

}  // namespace tet_line_tracker
