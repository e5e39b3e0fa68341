#pragma once

#include <string>

#include <ros/time.h>
#include <rosbag/bag.h>

namespace tet_line_tracker {

/// Writes a bag under a temporary name beside its final one and moves it there in close(). Destroyed before
/// close() it leaves nothing behind, so a failed program never leaves half a bag.
class BagWriter {
 public:
  /// Throws std::runtime_error when the file cannot be created.
  explicit BagWriter(const std::string& path);
  ~BagWriter();
  BagWriter(const BagWriter&) = delete;
  BagWriter& operator=(const BagWriter&) = delete;

  template <class Message>
  void write(const std::string& topic, const ros::Time& stamp, const Message& message) {
    bag_.write(topic, stamp, message);
  }

  /// Finishes the bag and gives it its final name. Throws std::runtime_error when that fails.
  void close();

 private:
  std::string path_;
  std::string temporary_path_;
  rosbag::Bag bag_;
  bool closed_{false};
};

}  // namespace tet_line_tracker
