#pragma once

#include <array>
#include <cstdint>
#include <functional>
#include <memory>
#include <vector>

#include <Eigen/Geometry>
#include <opencv2/core.hpp>

#include "tet_line_tracker/camera/camera_model.h"
#include "world.h"

namespace tet_line_tracker {

/// Where the camera is at one moment.
struct View {
  Eigen::Isometry3d world_from_camera;
  std::int64_t stamp_ns{0};  ///< places moving bodies
};

/// Renders a world through a camera model by casting a ray per pixel. Textures are averaged over the pixel's
/// footprint on them; pixels on an outline are sampled many times. Mirrors show the world once: a mirror in a
/// mirror has its texture alone. The result does not depend on the number of threads.
class Renderer {
 public:
  /// The world must outlive the renderer. The camera's calibration must say its size. Throws
  /// std::invalid_argument when it does not.
  Renderer(std::shared_ptr<const CameraModel> camera, const World& world, int threads);

  /// Mean radiance over the views (several: motion blur), CV_32FC1, 8-bit gray levels. Pixels that the model
  /// maps to no ray are 0. Pixels outside `rows` need not be rendered.
  cv::Mat render(const std::vector<View>& views, const cv::Range& rows = cv::Range::all());

 private:
  struct PixelRay {
    Eigen::Vector3f ray;           // unit, NaN where there is none
    Eigen::Vector3f per_x, per_y;  // its change from pixel to pixel
  };
  /// Square of pixels, with planes through the camera that enclose all its rays.
  struct Tile {
    cv::Rect pixels;
    bool bounded{false};
    std::array<Eigen::Vector3d, 4> normals;
    std::array<double, 4> slacks;  // a ray r of the tile has normal.dot(r) >= slack
    Eigen::Vector3f middle;
  };
  /// A rectangle as the camera of one view sees it; d is any ray of the camera.
  struct SeenRectangle {
    int surface;
    Eigen::Vector3f inverse_depth;  // inverse_depth.dot(d) = 1 / distance along d
    Eigen::Vector3f u_axis, v_axis;
    float u, v;  // of the camera's foot on the plane
    float width, height;
    std::array<Eigen::Vector3d, 4> corners;
    std::array<double, 4> distances;  // of the corners
  };

  struct Reflection {
    int surface;
    float share;
    cv::Mat_<float> radiance;  // where the mirror is
  };
  /// What is rendered in one go: the world, or what a mirror shows of it.
  struct Pass {
    std::vector<SeenRectangle> rectangles;
    std::int64_t stamp_ns;
    const SeenRectangle* mirror{nullptr};  // what lies beyond its plane is rendered, where it is seen
    std::vector<Reflection> reflections;
    std::size_t views;  // of the image
    cv::Range rows;
  };

  const PixelRay& rayAt(const cv::Point& pixel) const { return rayAt(pixel.x, pixel.y); }
  const PixelRay& rayAt(int x, int y) const {
    return rays_[static_cast<std::size_t>(y) * static_cast<std::size_t>(size_.width) +
                 static_cast<std::size_t>(x)];
  }
  void makeRays(const CameraModel& camera);
  void makeTiles();
  void bound(Tile& tile) const;
  void parallelTiles(const std::function<void(std::size_t)>& body) const { parallel(tiles_.size(), body); }
  void parallel(std::size_t count, const std::function<void(std::size_t)>& body) const;
  std::vector<SeenRectangle> see(const Eigen::Isometry3d& camera_from_world, std::int64_t stamp_ns) const;
  Pass makePass(const View& view, const std::vector<View>& views, const cv::Range& rows);
  /// Adds its radiance, times `share`.
  void render(const Pass& pass, float share, cv::Mat_<float>& radiance);
  /// Those that a tile may see.
  static std::vector<const SeenRectangle*> within(const Tile& tile,
                                                  const std::vector<const SeenRectangle*>& seen);
  /// The same, nearest first.
  static std::vector<const SeenRectangle*> candidates(const Tile& tile,
                                                      const std::vector<const SeenRectangle*>& seen);
  /// Position in `candidates` of the nearest one (beyond a mirror), -1: none.
  static int nearest(const std::vector<const SeenRectangle*>& candidates, const SeenRectangle* mirror,
                     const Eigen::Vector3f& ray);
  /// Gray of a surface where `ray`, of a pixel, meets it.
  float shade(const Pass& pass, const SeenRectangle& seen, const Eigen::Vector3f& ray,
              const cv::Point& pixel) const;
  float shadeOutline(const Pass& pass, const std::vector<const SeenRectangle*>& candidates,
                     const cv::Point& pixel) const;
  bool onOutline(const cv::Point& pixel) const;

  std::shared_ptr<const CameraModel> camera_;
  const World& world_;
  int threads_;
  cv::Size size_;
  std::vector<PixelRay> rays_;
  std::vector<Tile> tiles_;
  std::vector<Tile> blocks_;           // of many tiles, to leave out at once what none of them sees
  std::vector<std::size_t> block_of_;  // of each tile
  cv::Mat_<std::int32_t> surface_;     // nearest at each pixel's centre
};

}  // namespace tet_line_tracker
