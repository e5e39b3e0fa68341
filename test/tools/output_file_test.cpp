/// No tool replaces what is not its own, and a tool that fails leaves nothing behind.

#include <gtest/gtest.h>
#include <sys/mount.h>
#include <sys/socket.h>
#include <sys/stat.h>
#include <sys/sysmacros.h>
#include <sys/un.h>
#include <unistd.h>

#include <cerrno>
#include <csignal>
#include <cstring>
#include <fstream>
#include <functional>
#include <iterator>

#include "tool_run.h"

namespace tet_line_tracker {
namespace {

namespace fs = std::filesystem;

std::string bytesOf(const fs::path& path) {
  std::ifstream in(path, std::ios::binary);
  return {std::istreambuf_iterator<char>(in), std::istreambuf_iterator<char>()};
}

struct Tool {
  std::string name;
  std::function<std::vector<std::string>(const std::string& input, const std::string& output)> arguments;
  bool reads_a_bag{true};
};

std::vector<Tool> toolsThatWrite(const std::string& folder) {
  using Arguments = std::vector<std::string>;
  using Text = const std::string&;
  return {{"track_bag",
           [](Text input, Text output) {
             return Arguments{input, output};
           }},
          {"map_bag",
           [](Text input, Text output) {
             return Arguments{input, output};
           }},
          {"paint_tracks",
           [](Text input, Text output) {
             return Arguments{input, output};
           }},
          {"evaluate_tracks",
           [](Text input, Text output) {
             return Arguments{input, "--csv", output};
           }},
          {"evaluate_tracks",
           [](Text input, Text output) {
             return Arguments{input, "--json", output};
           }},
          {"dataset_to_bag",
           [](Text input, Text output) {
             return Arguments{"video", input, output};
           }},
          {"dataset_to_bag",
           [folder](Text, Text output) {
             return Arguments{"images", folder, output};
           },
           false},
          {"simulate_bag",
           [](Text, Text output) {
             return Arguments{output, "--seconds", "0.1"};
           },
           false},
          {"list_parameters",
           [](Text, Text output) {
             return Arguments{"--update", output};
           },
           false}};
}

/// Stands for all where the kind of the output is what matters.
Tool trackBag() {
  return toolsThatWrite({}).front();
}

class OutputFile : public ::testing::Test {
 protected:
  std::string in(const std::string& name) const { return folder_.path() / name; }
  std::size_t files() const {
    return static_cast<std::size_t>(
        std::distance(fs::directory_iterator(folder_.path()), fs::directory_iterator()));
  }

  /// The tools refuse `output`, each before it reads its input, and leave it alone.
  void expectRefusal(const std::string& output, const std::string& what, const std::vector<Tool>& tools) {
    // No tool can read it: each speaks of its output first.
    writeText(in("input"), "no bag");
    struct stat before {};
    ASSERT_EQ(lstat(output.c_str(), &before), 0);
    const std::size_t files_before = files();
    for (const Tool& tool : tools) {
      const ToolRun run = runTool(tool.name, tool.arguments(in("input"), output), "timeout -s KILL 60 ");
      EXPECT_EQ(run.status, 1) << tool.name;
      EXPECT_EQ(run.errors, tool.name + ": cannot write " + output + ": it is " + what +
                                ", needs a new or a regular file\n");
      struct stat after {};
      ASSERT_EQ(lstat(output.c_str(), &after), 0) << tool.name;
      EXPECT_EQ(after.st_ino, before.st_ino) << tool.name;
      EXPECT_EQ(after.st_mode, before.st_mode) << tool.name;
      EXPECT_EQ(files(), files_before) << tool.name;
    }
  }

  TemporaryFolder folder_;
};

TEST_F(OutputFile, IsNeverTheInputByWhateverName) {
  writeText(in("input"), "a recording");
  fs::create_hard_link(in("input"), in("hard_link"));
  fs::create_symlink("input", in("link"));
  for (const Tool& tool : toolsThatWrite({})) {
    if (!tool.reads_a_bag) continue;
    for (const char* const name : {"input", "hard_link", "link"}) {
      const ToolRun run = runTool(tool.name, tool.arguments(in("input"), in(name)));
      EXPECT_EQ(run.status, 1) << tool.name;
      EXPECT_EQ(run.errors, tool.name + ": cannot write " + in(name) + ": it is the same file as the input " +
                                in("input") + "\n");
      EXPECT_EQ(bytesOf(in("input")), "a recording") << tool.name;
      EXPECT_TRUE(fs::is_symlink(in("link"))) << tool.name;
    }
  }
}

TEST_F(OutputFile, IsNeverAConfigurationOrACalibration) {
  writeText(in("config.yaml"), "max_lines: 100\n");
  const ToolRun track = runTool("track_bag", {in("a.bag"), in("config.yaml"), "--config", in("config.yaml")});
  EXPECT_NE(track.errors.find("the same file as the input"), std::string::npos) << track.errors;
  writeText(in("map.yaml"), "min_views: 3\n");
  const ToolRun map = runTool("map_bag", {in("a.bag"), in("map.yaml"), "--config", in("map.yaml")});
  EXPECT_NE(map.errors.find("the same file as the input"), std::string::npos) << map.errors;
  const ToolRun flight = runTool("simulate_bag", {in("config.yaml"), "--camera-info", in("config.yaml")});
  EXPECT_NE(flight.errors.find("the same file as the input"), std::string::npos) << flight.errors;
  EXPECT_EQ(bytesOf(in("config.yaml")), "max_lines: 100\n");
}

TEST_F(OutputFile, DoesNotReplaceAFolder) {
  fs::create_directory(in("out.png"));
  expectRefusal(in("out.png"), "a folder", toolsThatWrite(in("images")));
}

TEST_F(OutputFile, DoesNotReplaceASymbolicLink) {
  writeText(in("target"), "of somebody else");
  fs::create_symlink("target", in("out.png"));
  expectRefusal(in("out.png"), "a symbolic link", toolsThatWrite(in("images")));
  EXPECT_EQ(bytesOf(in("target")), "of somebody else");
  fs::remove(in("target"));
  expectRefusal(in("out.png"), "a symbolic link", {trackBag()});
}

TEST_F(OutputFile, DoesNotReplaceAFifo) {
  ASSERT_EQ(mkfifo(in("out.png").c_str(), 0600), 0);
  expectRefusal(in("out.png"), "a fifo", {trackBag()});
}

TEST_F(OutputFile, DoesNotReplaceASocket) {
  sockaddr_un address{};
  address.sun_family = AF_UNIX;
  ASSERT_LT(in("out.png").size(), sizeof(address.sun_path));
  std::strcpy(address.sun_path, in("out.png").c_str());
  const int server = socket(AF_UNIX, SOCK_STREAM, 0);
  ASSERT_EQ(bind(server, reinterpret_cast<const sockaddr*>(&address), sizeof(address)), 0);
  expectRefusal(in("out.png"), "a socket", {trackBag()});
  close(server);
}

TEST_F(OutputFile, DoesNotReplaceADevice) {
  if (mknod(in("out.png").c_str(), S_IFCHR | 0600, makedev(1, 3)) != 0) {
    GTEST_SKIP() << "skipped: this user may not make a device node";
  }
  expectRefusal(in("out.png"), "a device", {trackBag()});
}

TEST_F(OutputFile, NeedsAFolderThatIsThere) {
  for (const Tool& tool : toolsThatWrite(in("images"))) {
    const ToolRun run = runTool(tool.name, tool.arguments(in("input"), in("nowhere/out.png")));
    EXPECT_EQ(run.status, 1) << tool.name;
    EXPECT_EQ(run.errors, tool.name + ": cannot write " + in("nowhere/out.png") + ": there is no folder " +
                              in("nowhere") + "\n");
  }
}

/// Files that fail at their beginning, in their middle, and when the last bytes are written.
std::vector<std::uintmax_t> sizesBelow(std::uintmax_t size) {
  return {4096, size / 2, size - 5000, size - 1024};
}

void expectNoSpace(const ToolRun& run, const std::string& tool, const std::string& output,
                   const std::string& reason) {
  EXPECT_EQ(run.status, 1) << run.errors;
  const std::string errors = run.errors.substr(0, run.errors.find("profiling:"));
  EXPECT_EQ(errors, tool + ": cannot write " + output + ": " + reason + "\n");
}

/// As a full disk, but for any user: files cannot grow beyond a limit.
TEST_F(OutputFile, IsNotLeftBehindWhenItCannotGrow) {
  ASSERT_EQ(runTool("simulate_bag", {in("flight.bag"), "--seconds", "0.1"}).status, 0);
  ASSERT_EQ(runTool("track_bag", {in("flight.bag"), in("tracks.bag")}).status, 0);
  const auto limited = [](std::uintmax_t bytes) {
    // The counters of scripts/coverage.sh are kept out of it, and say so.
    return "export GCOV_PREFIX=/dev/null; trap '' XFSZ; ulimit -f " + std::to_string(bytes / 512) + "; ";
  };
  for (const std::uintmax_t size : sizesBelow(fs::file_size(in("flight.bag")))) {
    const ToolRun run = runTool("simulate_bag", {in("out.bag"), "--seconds", "0.1"}, limited(size));
    expectNoSpace(run, "simulate_bag", in("out.bag"), "File too large");
    EXPECT_EQ(files(), 2U) << "limit " << size;
  }
  for (const std::uintmax_t size : sizesBelow(fs::file_size(in("tracks.bag")))) {
    const ToolRun run = runTool("track_bag", {in("flight.bag"), in("out.bag")}, limited(size));
    expectNoSpace(run, "track_bag", in("out.bag"), "File too large");
    EXPECT_EQ(files(), 2U) << "limit " << size;
  }
  // An older output stays as it was.
  const std::string before = bytesOf(in("tracks.bag"));
  EXPECT_EQ(runTool("track_bag", {in("flight.bag"), in("tracks.bag")}, limited(4096)).status, 1);
  EXPECT_TRUE(bytesOf(in("tracks.bag")) == before);
  const ToolRun json =
      runTool("evaluate_tracks", {in("tracks.bag"), "--json", in("out.json"), "--pairs"}, limited(2048));
  expectNoSpace(json, "evaluate_tracks", in("out.json"), "File too large");
  EXPECT_EQ(files(), 2U);
}

TEST_F(OutputFile, IsNotLeftBehindOnAFullDisk) {
  ASSERT_EQ(runTool("simulate_bag", {in("flight.bag"), "--seconds", "0.1"}).status, 0);
  const std::string disk = in("disk");
  fs::create_directory(disk);
  if (mount("none", disk.c_str(), "tmpfs", 0, "size=256k") != 0) {
    GTEST_SKIP() << "skipped: this user may not mount a small tmpfs (" << std::strerror(errno) << ")";
  }
  const ToolRun flight = runTool("simulate_bag", {disk + "/out.bag", "--seconds", "0.1"});
  const ToolRun tracks = runTool("track_bag", {in("flight.bag"), disk + "/out.bag", "--with-images"});
  const bool empty = fs::is_empty(disk);
  EXPECT_EQ(umount(disk.c_str()), 0);
  expectNoSpace(flight, "simulate_bag", disk + "/out.bag", "No space left on device");
  expectNoSpace(tracks, "track_bag", disk + "/out.bag", "No space left on device");
  EXPECT_TRUE(empty);
}

TEST_F(OutputFile, IsNotLeftBehindByASignal) {
  for (const int signal : {SIGHUP, SIGINT, SIGTERM}) {
    const ToolRun run =
        signalTool("simulate_bag", {in("out.bag"), "--seconds", "60"}, signal, [&] { return files() > 0; });
    EXPECT_EQ(run.status, 1) << signal;
    EXPECT_EQ(run.errors, "simulate_bag: interrupted, nothing was written\n") << signal;
    EXPECT_EQ(files(), 0U) << signal;
  }
}

TEST_F(OutputFile, IsWrittenUnderNohupThoughTheTerminalGoes) {
  const auto before = std::signal(SIGHUP, SIG_IGN);
  const ToolRun run =
      signalTool("simulate_bag", {in("out.bag"), "--seconds", "1"}, SIGHUP, [&] { return files() > 0; });
  std::signal(SIGHUP, before);
  EXPECT_EQ(run.status, 0) << run.errors;
  EXPECT_TRUE(fs::exists(in("out.bag")));
}

}  // namespace
}  // namespace tet_line_tracker
