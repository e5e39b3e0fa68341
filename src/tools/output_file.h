#pragma once

#include <string>
#include <vector>

namespace tet_line_tracker {

/// To be asked before any work: throws std::runtime_error with one sentence when `path` is one of `inputs`
/// (the same file by device and inode, whatever its name; empty names are passed over), when it is there and
/// is no regular file (a folder, symbolic link, device or fifo would be replaced), or when its folder is not
/// there.
void checkOutput(const std::string& path, const std::vector<std::string>& inputs);

/// The same for a program that reads a whole folder: nothing in `folder` is to be replaced but bags, which
/// are no part of a dataset.
void checkOutputBesideFolder(const std::string& path, const std::string& folder);

/// A file that is written under a temporary name beside its final one. Destroyed before moveIntoPlace() it
/// leaves nothing behind, so a failed program never leaves half a file.
class TemporaryOutput {
 public:
  /// `ending`: what the temporary name ends with, for writers that go by it.
  explicit TemporaryOutput(std::string path, const std::string& ending = {});
  ~TemporaryOutput();
  TemporaryOutput(const TemporaryOutput&) = delete;
  TemporaryOutput& operator=(const TemporaryOutput&) = delete;

  const std::string& path() const { return path_; }
  const std::string& temporaryPath() const { return temporary_path_; }
  /// Gives the file its final name. Throws std::runtime_error when that fails.
  void moveIntoPlace();
  /// What to throw when writing failed: the reason that the system gave (disk full, file too large), or
  /// `otherwise`.
  [[noreturn]] void fail(const std::string& otherwise) const;

 private:
  std::string path_, temporary_path_;
  bool moved_{false};
};

/// Writes a whole file, or none. A file that is there keeps its permissions. Throws std::runtime_error.
void writeOutput(const std::string& path, const std::string& content);

}  // namespace tet_line_tracker
