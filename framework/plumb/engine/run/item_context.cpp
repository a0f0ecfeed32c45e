#include "plumb/engine/run/item_context.hpp"

#include <time.h>

#include "plumb/engine/run/parallel.hpp"

namespace plumb {
namespace {

thread_local Stopwatch* running = nullptr;

std::int64_t thread_nanoseconds() {
  timespec now{};
  clock_gettime(CLOCK_THREAD_CPUTIME_ID, &now);
  return std::int64_t{1'000'000'000} * now.tv_sec + now.tv_nsec;
}

}  // namespace

Stopwatch::Stopwatch(Bookkeeping& books, const std::string& path, std::atomic<std::int64_t>* sum)
    : books_(books),
      path_(path),
      sum_(sum),
      outer_(running),
      begin_(Bookkeeping::Clock::now()),
      cpu_begin_(thread_nanoseconds()) {
  running = this;
}

Stopwatch::~Stopwatch() {
  const std::int64_t spent = thread_nanoseconds() - cpu_begin_, own = spent - inner_ + added_;
  running = outer_;
  if (outer_) outer_->inner_ += spent;
  if (sum_)
    *sum_ += own;
  else if (item_)
    books_.item({path_, item_->name, item_->pass, item_->reused, begin_, Bookkeeping::Clock::now(),
                 1e-9 * static_cast<double>(own), 0, worker_number()});
  else
    books_.add_time(path_, 1e-9 * static_cast<double>(own));
}

void Stopwatch::item(std::string name, int pass, bool reused) {
  if (running) running->item_ = Item{std::move(name), pass, reused};
}

void Stopwatch::add(std::int64_t nanoseconds) {
  if (running) running->added_ += nanoseconds;
}

const std::string* Stopwatch::path() { return running ? &running->path_ : nullptr; }

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
  std::atomic<std::int64_t> spent = 0;
  parallel_for(n, [&](std::size_t k) {
    const Stopwatch watch(books_, path_,
                          &spent);  // bodies may run on threads that have no stopwatch of this step
    body(k);
  });
  Stopwatch::add(spent);
}

}  // namespace plumb
