#include <filesystem>
#include <string>
#include <vector>

#include <gtest/gtest.h>

#include "shell_command.h"

namespace tet_line_tracker {
namespace {

namespace fs = std::filesystem;

ShellResult inSourceFolder(const std::string& command) {
  return runShell("cd " + quoted(TET_SOURCE_DIRECTORY) + " && " + command);
}

/// Shell scripts that are started, not sourced.
std::vector<std::string> startedScripts() {
  std::vector<std::string> scripts;
  for (const fs::directory_entry& entry : fs::directory_iterator(TET_SOURCE_DIRECTORY "/scripts")) {
    const bool executable = (entry.status().permissions() & fs::perms::owner_exec) != fs::perms::none;
    if (executable && entry.path().extension() == ".sh")
      scripts.push_back("scripts/" + entry.path().filename().string());
  }
  return scripts;
}

TEST(Scripts, EachAnswersHelpInsteadOfStartingWork) {
  const std::vector<std::string> scripts = startedScripts();
  ASSERT_FALSE(scripts.empty());
  for (const std::string& script : scripts) {
    const ShellResult result = inSourceFolder("timeout 60 " + script + " --help");
    EXPECT_EQ(result.status, 0) << script << ": " << result.output;
    EXPECT_NE(result.output.find("  " + script), std::string::npos) << script << ": " << result.output;
  }
}

TEST(Scripts, AnUnknownOptionIsRefusedInsteadOfTakenForAValue) {
  for (const std::string script : {"fuzz", "sanitize", "soak"}) {
    const ShellResult result = inSourceFolder("timeout 60 scripts/" + script + ".sh --unheard-of");
    EXPECT_EQ(result.status, 1) << script << ": " << result.output;
    EXPECT_NE(result.output.find("unknown option --unheard-of"), std::string::npos) << result.output;
  }
}

TEST(Scripts, BuildInstallsWhatReadmeStartsAfterIt) {
  // Stand-ins: every package that is asked for counts as installed, and the build ends where CMake would
  // begin.
  const ShellResult result = inSourceFolder(R"(bash -c '
      export ASKED=$(mktemp)
      dpkg-query() { printf "installed %s\n" "$@"; printf "%s\n" "$@" >>"$ASKED"; }
      cmake() { echo "CMake begins"; exit 0; }
      export -f dpkg-query cmake
      scripts/build.sh
      . scripts/packages.sh
      for package in "${packages_run[@]}"; do grep -qxF "$package" "$ASKED" || echo "not asked for: $package"; done
      rm "$ASKED"')");
  EXPECT_EQ(result.output, "CMake begins\n");
}

}  // namespace
}  // namespace tet_line_tracker
