#include "tracking/worker_pool.h"

namespace tet_line_tracker {

WorkerPool::WorkerPool(int threads) {
  for (int i = 1; i < threads; ++i)
    workers_.emplace_back(&WorkerPool::work, this, static_cast<std::size_t>(i));
}

WorkerPool::~WorkerPool() {
  {
    const std::lock_guard<std::mutex> lock(mutex_);
    closing_ = true;
  }
  begin_.notify_all();
  for (std::thread& worker : workers_) worker.join();
}

void WorkerPool::run(std::size_t count, const std::function<void(std::size_t)>& body) {
  if (workers_.empty()) {
    for (std::size_t i = 0; i < count; ++i) body(i);
    return;
  }
  {
    const std::lock_guard<std::mutex> lock(mutex_);
    count_ = count;
    body_ = &body;
    busy_ = workers_.size();
    ++round_;
  }
  begin_.notify_all();
  runShare(0);
  std::unique_lock<std::mutex> lock(mutex_);
  end_.wait(lock, [this] { return busy_ == 0; });
}

void WorkerPool::work(std::size_t share) {
  std::size_t last_round = 0;
  while (true) {
    {
      std::unique_lock<std::mutex> lock(mutex_);
      begin_.wait(lock, [&] { return closing_ || round_ != last_round; });
      if (closing_) return;
      last_round = round_;
    }
    runShare(share);
    {
      const std::lock_guard<std::mutex> lock(mutex_);
      --busy_;
    }
    end_.notify_one();
  }
}

void WorkerPool::runShare(std::size_t share) const {
  for (std::size_t i = share; i < count_; i += workers_.size() + 1) (*body_)(i);
}

}  // namespace tet_line_tracker
