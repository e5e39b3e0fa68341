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
  for (const std::string script : {"fuzz", "load_test", "sanitize", "soak"}) {
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

TEST(Scripts, WithoutSudoTheyPrintOneLineToPasteWithAllThatTheyNeed) {
  for (const std::string script :
       {"build.sh --tests", "test.sh", "test.sh --no-lint", "demo.sh --headless"}) {
    const ShellResult result = inSourceFolder(R"(bash -c '
        dpkg-query() { :; }
        id() { echo 1000; }
        command() { if [ "$2" = sudo ]; then return 1; else builtin command "$@"; fi; }
        export -f dpkg-query id command
        . scripts/packages.sh
        needed=("${packages_build[@]}" "${packages_run[@]}")
        case "$1" in
          *test*) needed+=("${packages_test[@]}") ;;
        esac
        if [ "$1" = test.sh ]; then needed+=("${packages_lint[@]}"); fi
        line=$(scripts/$1 2>&1 </dev/null | grep "^apt-get update && apt-get install ")
        for package in "${needed[@]}"; do case " $line " in *" $package "*) ;; *) echo "lacks $package" ;; esac; done
        wc -l <<<"$line"' - ')" + script + "'");
    EXPECT_EQ(result.output, "1\n") << script;
  }
}

TEST(Scripts, WithNodesTheyEndAtCtrlCAlsoWhenWhatTheyWaitForEndsWithoutAnError) {
  const ShellResult result = inSourceFolder(R"(bash -c '
      . scripts/environment.sh
      roscore() { :; }
      startMaster
      bash -c "kill -INT \$PPID; sleep 0.2"  # as roslaunch, which makes no error of it
      echo "went on"')");
  EXPECT_EQ(result.status, 130) << result.output;
  EXPECT_EQ(result.output, "");
}

TEST(Scripts, BuildIntoAPipeShowsEachLineWhenItComes) {
  // The stand-in for the build goes on when its first line was read.
  const ShellResult result = inSourceFolder(R"(bash -c '
      export SEEN=$(mktemp -u)
      dpkg-query() { printf "installed %s\n" "$@"; }
      cmake() {
        if [ "$1" = -S ]; then return; fi
        echo "first line"
        for i in $(seq 200); do if [ -e "$SEEN" ]; then echo "was seen"; return; fi; sleep 0.1; done
        echo "was not seen"
      }
      export -f dpkg-query cmake
      scripts/build.sh | { read -r line; touch "$SEEN"; echo "$line"; cat; }
      rm "$SEEN"')");
  EXPECT_EQ(result.output, "first line\nwas seen\n");
}

}  // namespace
}  // namespace tet_line_tracker
