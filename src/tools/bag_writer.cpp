#include "bag_writer.h"

#include <vector>

namespace tet_line_tracker {
namespace {

/// The destructor of a rosbag::Bag writes its index and ends the program when it cannot (std::terminate). A
/// bag that failed is therefore kept to the end of the program.
void abandon(std::unique_ptr<rosbag::Bag> bag) {
  static auto& abandoned = *new std::vector<rosbag::Bag*>();
  abandoned.push_back(bag.release());
}

}  // namespace

BagWriter::BagWriter(const std::string& path) : output_(path), bag_(std::make_unique<rosbag::Bag>()) {
  errno = 0;
  try {
    bag_->open(output_.temporaryPath(), rosbag::bagmode::Write);
  } catch (const std::exception& error) {
    const int reason = errno;
    abandon(std::move(bag_));
    errno = reason;
    output_.fail(error.what());
  }
}

BagWriter::~BagWriter() {
  if (!bag_) return;
  try {
    bag_->close();
  } catch (const std::exception&) {
    abandon(std::move(bag_));
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
    abandon(std::move(bag_));
    errno = reason;
    output_.fail(error.what());
  }
  bag_.reset();
  output_.moveIntoPlace();
}

}  // namespace tet_line_tracker
