#pragma once

#include <condition_variable>
#include <cstddef>
#include <functional>
#include <mutex>
#include <thread>
#include <vector>

namespace tet_line_tracker {

/// Runs a loop body on several threads of its own. Which thread takes which index does not matter as long as
/// the body writes to places of its index alone. With one thread there are no workers and no locks.
class WorkerPool {
 public:
  /// `threads`: the calling one included.
  explicit WorkerPool(int threads);
  ~WorkerPool();
  WorkerPool(const WorkerPool&) = delete;
  WorkerPool& operator=(const WorkerPool&) = delete;

  /// Calls body(i) for each i below `count` and returns when all are done. `body` must not throw.
  void run(std::size_t count, const std::function<void(std::size_t)>& body);

 private:
  void work(std::size_t share);
  /// Every n-th index: neighbours in the list of lines cost about the same.
  void runShare(std::size_t share) const;

  std::mutex mutex_;
  std::condition_variable begin_, end_;
  // Guarded by mutex_; count_ and body_ stay as they are while a round runs.
  std::size_t round_{0};
  std::size_t busy_{0};
  bool closing_{false};
  std::size_t count_{0};
  const std::function<void(std::size_t)>* body_{nullptr};

  std::vector<std::thread> workers_;
};

}  // namespace tet_line_tracker
