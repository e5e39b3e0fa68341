#include "bag_writer.h"

#include <unistd.h>

#include <cstdio>
#include <stdexcept>

namespace tet_line_tracker {

BagWriter::BagWriter(const std::string& path)
    : path_(path), temporary_path_(path + ".part" + std::to_string(getpid())) {
  try {
    bag_.open(temporary_path_, rosbag::bagmode::Write);
  } catch (const std::exception& error) {
    throw std::runtime_error("cannot write " + path + ": " + error.what());
  }
}

BagWriter::~BagWriter() {
  if (closed_) return;
  try {
    bag_.close();
  } catch (const std::exception&) {
    // The file goes away in any case.
  }
  std::remove(temporary_path_.c_str());
}

void BagWriter::close() {
  bag_.close();
  if (std::rename(temporary_path_.c_str(), path_.c_str()) != 0) {
    throw std::runtime_error("cannot move the finished bag to " + path_);
  }
  closed_ = true;
}

}  // namespace tet_line_tracker
