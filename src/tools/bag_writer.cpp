#include "bag_writer.h"

#include <fcntl.h>
#include <unistd.h>

#include <cstdlib>
#include <filesystem>
#include <system_error>
#include <vector>

namespace tet_line_tracker {
namespace {

namespace fs = std::filesystem;

/// What this program writes to the file from here on goes nowhere, and never fails.
void divertWrites(const std::string& path) {
  const int nowhere = open("/dev/null", O_WRONLY | O_CLOEXEC);
  std::error_code error;
  for (const fs::directory_entry& descriptor : fs::directory_iterator("/proc/self/fd", error)) {
    if (fs::equivalent(descriptor.path(), path, error)) {
      dup2(nowhere, std::atoi(descriptor.path().filename().c_str()));
    }
  }
  close(nowhere);
}

/// The destructor of a rosbag::Bag writes its index and ends the program when it cannot (std::terminate). A
/// bag that failed is therefore written to nowhere, or, where that fails too, kept to the end of the program.
void abandon(std::unique_ptr<rosbag::Bag> bag, const std::string& path) {
  divertWrites(path);
  try {
    bag->close();
  } catch (const std::exception&) {
    static auto& abandoned = *new std::vector<rosbag::Bag*>();
    abandoned.push_back(bag.release());
  }
}

}  // namespace

BagWriter::BagWriter(const std::string& path) : output_(path), bag_(std::make_unique<rosbag::Bag>()) {
  errno = 0;
  try {
    bag_->open(output_.temporaryPath(), rosbag::bagmode::Write);
  } catch (const std::exception& error) {
    const int reason = errno;
    abandon(std::move(bag_), output_.temporaryPath());
    errno = reason;
    output_.fail(error.what());
  }
}

BagWriter::~BagWriter() {
  if (!bag_) return;
  try {
    bag_->close();
  } catch (const std::exception&) {
    abandon(std::move(bag_), output_.temporaryPath());
  }
}

void BagWriter::copy(const rosbag::MessageInstance& message) {
  errno = 0;
  try {
    bag_->write(message.getTopic(), message.getTime(), message);
  } catch (const std::exception& error) {
    if (errno == 0) throw;
    output_.fail(error.what());
  }
}

void BagWriter::close() {
  errno = 0;
  try {
    bag_->close();
  } catch (const std::exception& error) {
    const int reason = errno;
    abandon(std::move(bag_), output_.temporaryPath());
    errno = reason;
    output_.fail(error.what());
  }
  bag_.reset();
  output_.moveIntoPlace();
}

}  // namespace tet_line_tracker
