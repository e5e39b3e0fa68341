#include "output_file.h"

#include <sys/stat.h>
#include <unistd.h>

#include <cerrno>
#include <cstdio>
#include <cstring>
#include <filesystem>
#include <fstream>
#include <sstream>
#include <stdexcept>
#include <utility>

namespace tet_line_tracker {
namespace {

namespace fs = std::filesystem;

bool isSameFile(const struct stat& a, const struct stat& b) {
  return a.st_dev == b.st_dev && a.st_ino == b.st_ino;
}

/// What `path` is, when it is there and is no regular file.
std::string foreignKind(const std::string& path) {
  struct stat status {};
  if (lstat(path.c_str(), &status) != 0 || S_ISREG(status.st_mode)) return {};
  if (S_ISDIR(status.st_mode)) return "a folder";
  if (S_ISLNK(status.st_mode)) return "a symbolic link";
  if (S_ISFIFO(status.st_mode)) return "a fifo";
  if (S_ISSOCK(status.st_mode)) return "a socket";
  return "a device";
}

}  // namespace

void checkOutput(const std::string& path, const std::vector<std::string>& inputs) {
  struct stat output {};
  if (stat(path.c_str(), &output) == 0) {
    for (const std::string& input : inputs) {
      struct stat status {};
      if (input.empty() || stat(input.c_str(), &status) != 0 || !isSameFile(status, output)) continue;
      std::ostringstream sentence;
      sentence << "cannot write " << path << ": it is the same file as the input " << input;
      throw std::runtime_error(sentence.str());
    }
  }
  const std::string kind = foreignKind(path);
  if (!kind.empty()) {
    throw std::runtime_error("cannot write " + path + ": it is " + kind + ", needs a new or a regular file");
  }
  const fs::path folder = fs::path(path).parent_path();
  std::error_code ignored;
  if (!folder.empty() && !fs::is_directory(folder, ignored)) {
    throw std::runtime_error("cannot write " + path + ": there is no folder " + folder.string());
  }
}

void checkOutputBesideFolder(const std::string& path, const std::string& folder) {
  struct stat output {};
  std::error_code error;
  if (fs::path(path).extension() == ".bag" || stat(path.c_str(), &output) != 0 ||
      !fs::is_directory(folder, error)) {
    return;
  }
  const auto options = fs::directory_options::skip_permission_denied;
  for (const fs::directory_entry& entry : fs::recursive_directory_iterator(folder, options)) {
    struct stat status {};
    if (stat(entry.path().c_str(), &status) != 0 || !isSameFile(status, output)) continue;
    throw std::runtime_error("cannot write " + path + ": it is " + entry.path().string() + " of the input");
  }
}

TemporaryOutput::TemporaryOutput(std::string path, const std::string& ending)
    : path_(std::move(path)), temporary_path_(path_ + ".part" + std::to_string(getpid()) + ending) {}

TemporaryOutput::~TemporaryOutput() {
  if (!moved_) std::remove(temporary_path_.c_str());
}

void TemporaryOutput::moveIntoPlace() {
  errno = 0;
  if (std::rename(temporary_path_.c_str(), path_.c_str()) != 0) fail("it cannot be renamed");
  moved_ = true;
}

void TemporaryOutput::fail(const std::string& otherwise) const {
  const std::string reason = errno != 0 ? std::strerror(errno) : otherwise;
  throw std::runtime_error("cannot write " + path_ + ": " + reason);
}

void writeOutput(const std::string& path, const std::string& content) {
  TemporaryOutput output(path);
  errno = 0;
  {
    std::ofstream file(output.temporaryPath(), std::ios::binary);
    if (file) file.write(content.data(), static_cast<std::streamsize>(content.size()));
    if (file) file.close();
    if (!file) output.fail("it cannot be opened");
  }
  struct stat before {};
  if (stat(path.c_str(), &before) == 0) chmod(output.temporaryPath().c_str(), before.st_mode & 07777U);
  output.moveIntoPlace();
}

}  // namespace tet_line_tracker
