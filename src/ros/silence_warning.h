#pragma once

#include <chrono>
#include <functional>
#include <future>
#include <optional>
#include <string>

#include "throttled_warning.h"

namespace tet_line_tracker {

/// Topics that carry images but for `own`, separated by commas, for a user who named another. Asks the master
/// once and does not wait for one that is gone.
std::string imageTopics(const std::string& own);

/// The topic that image_transport subscribes to for the images of `topic`, a resolved name.
std::string topicOfTransport(const std::string& topic, const std::string& transport);

/// Decides when to warn that no images come, and finds out what could help. The question runs in a thread of
/// its own, since an answer may take as long as it likes: callbacks, and with them the images, must not wait
/// for the master. Not thread-safe.
class SilenceWarning {
 public:
  using Clock = ThrottledWarning::Clock;
  static constexpr std::chrono::seconds kPeriod{60};
  static constexpr std::chrono::seconds kAnswerTime{2};  ///< after which the warning goes without

  /// `ask` is called in the other thread, never twice at a time; the destructor waits for it.
  explicit SilenceWarning(std::function<std::string()> ask) : ask_(std::move(ask)) {}

  /// To be called about once a second. Gives the answer of `ask` when it is time to warn, in silence once per
  /// period.
  std::optional<std::string> update(bool is_silent, Clock::time_point now = Clock::now());

 private:
  std::function<std::string()> ask_;
  ThrottledWarning due_{kPeriod};
  std::optional<Clock::time_point> asked_;  ///< when the warning became due that waits for its answer
  std::future<std::string> answer_;
};

}  // namespace tet_line_tracker
