#include <algorithm>
#include <cmath>
#include <cstdio>
#include <cstdlib>
#include <filesystem>
#include <fstream>
#include <sstream>
#include <stdexcept>
#include <string>
#include <vector>

#include <gtest/gtest.h>

#include "shell_command.h"

namespace tet_line_tracker {
namespace {

namespace fs = std::filesystem;

/// Grey rectangle on a dark ground; its edges lie between pixels.
constexpr int kLeft = 80, kTop = 60, kRight = 240, kBottom = 180;

void writeImage(const fs::path& path, int dx, int dy) {
  std::ofstream file(path, std::ios::binary);
  file << "P5 320 240 255\n";
  for (int y = 0; y < 240; ++y) {
    for (int x = 0; x < 320; ++x) {
      const bool inside = x >= kLeft + dx && x < kRight + dx && y >= kTop + dy && y < kBottom + dy;
      file.put(static_cast<char>(inside ? 180 : 40));
    }
  }
}

class TemporaryFolder {
 public:
  TemporaryFolder() {
    std::string pattern = (fs::temp_directory_path() / "core_package_XXXXXX").string();
    if (mkdtemp(pattern.data()) == nullptr) throw std::runtime_error("cannot make " + pattern);
    path_ = pattern;
  }
  ~TemporaryFolder() {
    std::error_code ignored;
    fs::remove_all(path_, ignored);
  }
  TemporaryFolder(const TemporaryFolder&) = delete;
  TemporaryFolder& operator=(const TemporaryFolder&) = delete;

  fs::path operator/(const fs::path& name) const { return path_ / name; }

 private:
  fs::path path_;
};

/// CMake of the core alone, in `folder`, with these options.
ShellResult configure(const fs::path& folder, const std::string& options) {
  return runShell(quoted(TET_CMAKE) + " -S " + quoted(TET_SOURCE_DIRECTORY "/src/core") + " -B " +
                  quoted(folder) + " -G '" TET_GENERATOR "' -DCMAKE_CXX_COMPILER='" TET_COMPILER "' " +
                  options);
}

TEST(CorePackage, ConfiguresWithoutCatkin) {
  const TemporaryFolder folder;
  // A disabled package that is REQUIRED is an error.
  const ShellResult result = configure(folder / "build", "-DCMAKE_DISABLE_FIND_PACKAGE_catkin=ON");
  EXPECT_EQ(result.status, 0) << result.output;
}

TEST(CorePackage, ConfiguresWithoutItsTestsAndGoogleTest) {
  const TemporaryFolder folder;
  const ShellResult result =
      configure(folder / "build", "-DTET_TESTS=OFF -DCMAKE_DISABLE_FIND_PACKAGE_GTest=ON");
  EXPECT_EQ(result.status, 0) << result.output;
}

TEST(CorePackage, AProgramOutsideTheTreeFindsItAndTracksTwoImages) {
  const TemporaryFolder folder;
  const fs::path prefix = folder / "prefix", examples = folder / "examples", build = folder / "build";
  const std::string cmake = quoted(TET_CMAKE);
  const ShellResult install =
      runShell(cmake + " --install " + quoted(TET_CORE_BUILD_DIRECTORY) + " --prefix " + quoted(prefix));
  ASSERT_EQ(install.status, 0) << install.output;
  EXPECT_NE(
      runShell("grep -rF --include=*.cmake " + quoted(TET_SOURCE_DIRECTORY) + " " + quoted(prefix)).status, 0)
      << "the installed package leads back to the source folder";

  // Copies, so that nothing beside them is found.
  fs::create_directories(examples / "core_only");
  for (const std::string name : {"track_two_images.cpp", "core_only/CMakeLists.txt"}) {
    fs::copy_file(fs::path(TET_SOURCE_DIRECTORY) / "examples" / name, examples / name);
  }
  const ShellResult configure = runShell(
      cmake + " -S " + quoted(examples / "core_only") + " -B " + quoted(build) + " -G '" TET_GENERATOR "'" +
      " -DCMAKE_CXX_COMPILER='" TET_COMPILER "' -DCMAKE_CXX_FLAGS='" TET_FLAGS "' -DCMAKE_PREFIX_PATH=" +
      quoted(prefix));
  ASSERT_EQ(configure.status, 0) << configure.output;
  EXPECT_EQ(runShell("grep " + quoted("tet_line_tracker_core_DIR:PATH=" + prefix.string()) + " " +
                     quoted(build / "CMakeCache.txt"))
                .status,
            0)
      << "another installation was found";
  const ShellResult compile = runShell(cmake + " --build " + quoted(build));
  ASSERT_EQ(compile.status, 0) << compile.output;

  const int dx = 3, dy = 2;
  writeImage(folder / "first.pgm", 0, 0);
  writeImage(folder / "second.pgm", dx, dy);
  const std::string program = quoted(build / "track_two_images");
  const std::string images = " " + quoted(folder / "first.pgm") + " " + quoted(folder / "second.pgm");
  const ShellResult track = runShell(program + images);
  ASSERT_EQ(track.status, 0) << track.output;
  std::istringstream lines(track.output);
  int tracked = 0;
  for (std::string line; std::getline(lines, line); ++tracked) {
    unsigned long long id = 0;
    double x0 = 0.0, y0 = 0.0, x1 = 0.0, y1 = 0.0;
    ASSERT_EQ(std::sscanf(line.c_str(), "line %llu: (%lf, %lf) to (%lf, %lf)", &id, &x0, &y0, &x1, &y1), 5)
        << line;
    const bool vertical = std::abs(x1 - x0) < std::abs(y1 - y0);
    const std::vector<double> edges = vertical ? std::vector<double>{kLeft + dx - 0.5, kRight + dx - 0.5}
                                               : std::vector<double>{kTop + dy - 0.5, kBottom + dy - 0.5};
    for (const double end : vertical ? std::vector<double>{x0, x1} : std::vector<double>{y0, y1}) {
      EXPECT_LT(std::min(std::abs(end - edges[0]), std::abs(end - edges[1])), 0.25) << line;
    }
  }
  EXPECT_EQ(tracked, 4) << track.output;

  const ShellResult calibrated =
      runShell(program + images + " " + quoted(TET_SOURCE_DIRECTORY "/config/euroc_cam0.yaml"));
  EXPECT_EQ(calibrated.status, 0) << calibrated.output;
  EXPECT_EQ(calibrated.output.rfind("line ", 0), 0U) << calibrated.output;

  const ShellResult missing = runShell(program + images + "_missing");
  EXPECT_EQ(missing.status, 1) << missing.output;
  EXPECT_NE(missing.output.find("second.pgm_missing"), std::string::npos) << missing.output;
}

}  // namespace
}  // namespace tet_line_tracker
