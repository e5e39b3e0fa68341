#include "simulation/renderer.h"

#include <algorithm>
#include <cmath>
#include <stdexcept>

#include <gtest/gtest.h>

#include "simulation/simulation.h"

namespace tet_line_tracker {
namespace {

constexpr float kDark = 50.0F;
constexpr float kBright = 200.0F;

void addPlain(World& world, const Rectangle& rectangle, const Texture& texture) {
  world.geometry.addRectangle(rectangle);
  world.textures.push_back(texture);
}

/// A bright wall at z = 4 with a dark board painted on it (left) and a dark board before it at z = 2 (right),
/// turned a little against the pixels; the camera is the world's origin and looks along z.
struct TwoBoards {
  TwoBoards() {
    const Eigen::Matrix3d turn =
        (Eigen::AngleAxisd(0.05, Eigen::Vector3d::UnitZ()) * Eigen::AngleAxisd(0.2, Eigen::Vector3d::UnitY()))
            .toRotationMatrix();
    wall = {turn * Eigen::Vector3d(-8.0, -6.0, 0.0) + Eigen::Vector3d(0.0, 0.0, 4.0),
            turn.col(0),
            turn.col(1),
            16.0,
            12.0,
            -1};
    Texture wall_texture(16.0F, 12.0F, kBright);
    wall_texture.paint({6.2F, 5.3F, 7.4F, 6.5F, kDark});
    addPlain(world, wall, wall_texture);
    board = {Eigen::Vector3d(0.3, -0.35, 2.0), turn.col(0), turn.col(1), 0.5, 0.6, -1};
    addPlain(world, board, Texture(0.5F, 0.6F, kDark));
  }
  World world;
  Rectangle wall, board;
};

/// Largest and mean signed distance between an edge in the image and its projection [px]. Where the edge
/// crosses a row (or column), the brightness summed over a run of pixels says where it is.
struct EdgeError {
  double largest{0.0};
  double mean{0.0};
};
EdgeError edgeError(const cv::Mat_<float>& image, const CameraModel& camera, const Eigen::Vector3d& start,
                    const Eigen::Vector3d& end) {
  EdgeError error;
  int count = 0;
  for (double s = 0.1; s <= 0.9; s += 0.004) {
    const Eigen::Vector3d point = start + s * (end - start);
    const Eigen::Vector2d pixel = *camera.project(point);
    const Eigen::Vector2d ahead = *camera.project(point + 0.01 * (end - start)) - pixel;
    const bool upright = std::abs(ahead.y()) > std::abs(ahead.x());
    const int across = upright ? 0 : 1;
    const int line = static_cast<int>(std::lround(pixel(1 - across)));
    // The edge where it crosses the middle of this row or column.
    const double crossing = pixel(across) + (line - pixel(1 - across)) * ahead(across) / ahead(1 - across);
    constexpr int kReach = 6;
    const int first = static_cast<int>(std::lround(crossing)) - kReach;
    const auto at = [&](int i) { return static_cast<double>(upright ? image(line, i) : image(i, line)); };
    const double before = at(first);
    const double after = at(first + 2 * kReach);
    double sum = 0.0;
    for (int i = first; i <= first + 2 * kReach; ++i) sum += at(i) - after;
    const double measured = first - 0.5 + sum / (before - after);
    error.largest = std::max(error.largest, std::abs(measured - crossing));
    error.mean += measured - crossing;
    ++count;
  }
  error.mean /= count;
  return error;
}

/// The camera of TwoBoards in a world with a bright wall at z = 5 and a turned board at z = 7, or (mirrored
/// at z = 3) with the board behind the camera and the mirror instead.
World worldWithBoard(bool mirrored) {
  World world;
  const Eigen::Vector3d x = Eigen::Vector3d::UnitX();
  const Eigen::Vector3d y = Eigen::Vector3d::UnitY();
  const Eigen::Vector3d slanted = Eigen::Vector3d(0.9, 0.1, mirrored ? -0.4 : 0.4).normalized();
  const Eigen::Vector3d corner(-0.8, -0.6, mirrored ? -1.0 : 7.0);
  Texture board(1.5F, 1.2F, kBright);
  board.paint({0.3F, 0.2F, 0.9F, 0.8F, kDark});
  const Eigen::Vector3d upright = (mirrored ? -1.0 : 1.0) * slanted.cross(x).normalized();
  addPlain(world, {corner, slanted, upright, 1.5, 1.2, -1}, board);
  if (!mirrored) return world;
  addPlain(world, {{-6.0, -5.0, 5.0}, x, y, 12.0, 10.0, -1}, Texture(12.0F, 10.0F, 90.0F));
  addPlain(world, {{-4.0, -4.0, 3.0}, x, y, 8.0, 8.0, -1, SurfaceKind::kMirror}, Texture(8.0F, 8.0F, 20.0F));
  world.mirrors.push_back({2, 0.75F});
  return world;
}

TEST(Renderer, AMirrorShowsWhatIsBeforeItAndNothingFromBehindIt) {
  const auto camera = makeCameraModel(defaultSimulatedCamera());
  const std::vector<View> views{{Eigen::Isometry3d::Identity(), 0}};
  const World plain = worldWithBoard(false);
  const World mirrored = worldWithBoard(true);
  const cv::Mat_<float> expected = Renderer(camera, plain, 1).render(views);
  const cv::Mat_<float> image = Renderer(camera, mirrored, 2).render(views);
  int board_pixels = 0;
  for (int y = 0; y < image.rows; ++y) {
    for (int x = 0; x < image.cols; ++x) {
      ASSERT_NEAR(0.75F * expected(y, x) + 0.25F * 20.0F, image(y, x), 0.02F) << x << ", " << y;
      if (expected(y, x) > 0.0F) ++board_pixels;
    }
  }
  EXPECT_GT(board_pixels, 5000);
}

TEST(Renderer, PutsPaintedEdgesAndOutlinesWhereTheGeometryProjects) {
  const auto camera = makeCameraModel(defaultSimulatedCamera());
  const TwoBoards scene;
  Renderer renderer(camera, scene.world, 2);
  const cv::Mat_<float> image = renderer.render({{Eigen::Isometry3d::Identity(), 0}});
  const auto check = [&](const Rectangle& r, double u0, double v0, double u1, double v1) {
    const auto at = [&](double u, double v) -> Eigen::Vector3d {
      return r.origin + u * r.u_axis + v * r.v_axis;
    };
    const std::pair<Eigen::Vector3d, Eigen::Vector3d> sides[] = {{at(u0, v0), at(u1, v0)},
                                                                 {at(u1, v0), at(u1, v1)},
                                                                 {at(u1, v1), at(u0, v1)},
                                                                 {at(u0, v1), at(u0, v0)}};
    for (const auto& [start, end] : sides) {
      const EdgeError error = edgeError(image, *camera, start, end);
      EXPECT_LT(error.largest, 0.05);
      EXPECT_LT(std::abs(error.mean), 0.01);
    }
  };
  check(scene.wall, 6.2F, 5.3F, 7.4F, 6.5F);
  check(scene.board, 0.0, 0.0, 0.5, 0.6);
}

TEST(Renderer, ShowsTheSurfaceThatARayHits) {
  SimulationOptions options;
  options.moving_object = true;
  options.seconds = 4.0;
  const auto camera = makeCameraModel(defaultSimulatedCamera());
  Simulation simulation(options, camera);
  Renderer renderer(camera, simulation.world(), 1);
  bool object_seen = false;
  int compared = 0;
  int different = 0;
  for (double t = 0.3; t < 4.0; t += 1.5) {
    const Eigen::Isometry3d pose = simulation.trajectory().worldFromCamera(t);
    const std::int64_t stamp = simulation.stampAt(t);
    const cv::Mat_<float> image = renderer.render({{pose, stamp}});
    for (int y = 5; y < image.rows; y += 7) {
      for (int x = 5; x < image.cols; x += 7) {
        const auto hit = simulation.geometry().raycast(pose.translation(),
                                                       pose.linear() * *camera->unproject({x, y}), stamp);
        ASSERT_TRUE(hit);
        const Rectangle& seen =
            simulation.geometry().rectangles()[static_cast<std::size_t>(hit->point.surface)];
        object_seen = object_seen || seen.body >= 0;
        ++compared;
        const float expected = simulation.world().gray(hit->point, 0.006F);
        if (std::abs(expected - image(y, x)) > 25.0F) ++different;  // edges and fine detail differ
      }
    }
  }
  EXPECT_TRUE(object_seen);
  EXPECT_LT(different, compared / 30);
}

TEST(Renderer, GivesTheSameImagesWithOneThreadAndThree) {
  for (const char* light : {"normal", "low,gain_jumps"}) {
    SimulationOptions options;
    options.motion = "fast";
    options.seconds = 0.2;
    options.light = light;
    CameraCalibration upper_left = defaultSimulatedCamera();
    upper_left.width = 200;
    upper_left.height = 130;
    const auto camera = makeCameraModel(upper_left);
    Simulation one(options, camera);
    options.threads = 3;
    Simulation three(options, camera);
    options.seed = 2;
    Simulation other_seed(options, camera);
    for (int i = 0; i < 3; ++i) {
      const cv::Mat image = one.nextImage();
      EXPECT_EQ(0.0, cv::norm(image, three.nextImage(), cv::NORM_INF));
      EXPECT_LT(5.0, cv::norm(image, other_seed.nextImage(), cv::NORM_INF));
    }
  }
}

TEST(Renderer, RefusesACameraWithoutASize) {
  CameraCalibration camera = defaultSimulatedCamera();
  camera.width = 0;
  const TwoBoards scene;
  EXPECT_THROW(Renderer(makeCameraModel(camera), scene.world, 1), std::invalid_argument);
}

}  // namespace
}  // namespace tet_line_tracker
