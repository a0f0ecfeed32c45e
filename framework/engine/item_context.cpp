#include "plumb/engine/item_context.hpp"

#include <time.h>

#include "plumb/engine/parallel.hpp"

namespace plumb {
namespace {

thread_local Stopwatch* running = nullptr;

double thread_seconds() {
  timespec now{};
  clock_gettime(CLOCK_THREAD_CPUTIME_ID, &now);
  return static_cast<double>(now.tv_sec) + 1e-9 * static_cast<double>(now.tv_nsec);
}

}  // namespace

Stopwatch::Stopwatch(Bookkeeping& books, const std::string& path)
    : books_(books), path_(path), outer_(running), begin_(thread_seconds()) {
  running = this;
}

Stopwatch::~Stopwatch() {
  const double spent = thread_seconds() - begin_;
  books_.add_time(path_, spent - inner_);
  running = outer_;
  if (outer_) outer_->inner_ += spent;
}

void ItemContext::count(std::string_view what, std::uint64_t n) {
  if (counts_) books_.count(path_, what, n);
  if (!said_) return;
  const std::lock_guard lock(mutex_);
  for (auto& [earlier, number] : said_->counts)
    if (earlier == what) {
      number += n;
      return;
    }
  said_->counts.emplace_back(what, n);
}

void ItemContext::warn(const std::string& sentence) {
  books_.warn(path_, sentence);
  if (!said_) return;
  const std::lock_guard lock(mutex_);
  said_->warnings.push_back(sentence);
}

void ItemContext::parallel(std::size_t n, const std::function<void(std::size_t)>& body) {
  parallel_for(n, [&](std::size_t k) {
    const Stopwatch watch(books_, path_);  // bodies may run on threads that have no stopwatch of this step
    body(k);
  });
}

}  // namespace plumb
