#include "plumb/engine/remote/slurm/slurm_executor.hpp"

#include <algorithm>
#include <set>
#include <thread>

#include "plumb/data/counted.hpp"
#include "plumb/data/error.hpp"

namespace plumb {
namespace {

/// A job that was submitted so often without one more result is not tried again.
constexpr int most_idle_submissions = 3;
/// A call in a chunk that ended without a word is begun again so often beyond its tries: a crash of
/// its own would have been told.
constexpr unsigned kills_forgiven = 3;
/// So long Slurm may leave questions without an answer before that is said [s].
constexpr double patience = 10;
/// Elements of one array; sites allow 1001 by default.
constexpr std::size_t most_chunks = 1000;

/// The calls of one step run until each has a result or is set aside.
class Calls {
 public:
  Calls(StepRun& run, const Prepared& work, unsigned tries, const Executor::Done& done)
      : run_(run), work_(work), tries_(tries), done_(done) {
    for (const Call& call : work.task.calls) open_[call.item] = &call;
  }

  /// Takes what chunks wrote; how many calls it settled.
  std::size_t take(const std::vector<Notice>& news) {
    const std::size_t before = open_.size();
    for (const Notice& notice : news) {
      const auto at = open_.find(notice.reply.item);
      if (at == open_.end()) continue;
      const Reply& reply = notice.reply;
      if (!notice.ended)
        ++begun_[reply.item], ++begun_in_all_;
      else if (reply.machinery)
        trouble_ = reply.fault;  // of that machine, or of this moment: left open
      else if (reply.outside)
        continue;  // as if its chunk had been killed
      else if (reply.crashed && ++crashed_[reply.item] < tries_)
        continue;
      else if (!reply.fault.empty() || run_.has_result(reply.item))
        settle(at->first, reply);
    }
    return before - open_.size();
  }

  /// When no job runs any more: results of which no reply came, and calls whose chunk did not
  /// survive them as often as they may.
  std::size_t take_rest() {
    const std::size_t before = open_.size();
    std::vector<Reply> settled;
    for (const auto& [item, call] : open_) {
      Reply reply;
      reply.item = item;
      if (run_.adopt_result(item)) {
        settled.push_back(reply);
      } else if (begun_[item] >= tries_ + kills_forgiven) {
        reply.fault = call->title + ": was begun " + counted(begun_[item], "times") +
                      " and its job was ended each time; it is set aside";
        settled.push_back(reply);
      }
    }
    for (const Reply& reply : settled) settle(reply.item, reply);
    return before - open_.size();
  }

  bool all_settled() const { return open_.empty(); }
  std::size_t begun_in_all() const { return begun_in_all_; }
  const std::string& trouble() const { return trouble_; }  ///< the last that a machine had
  Task rest() const {
    Task task = work_.task;
    task.calls.clear();
    for (const auto& [item, call] : open_) task.calls.push_back(*call);
    return task;
  }

 private:
  void settle(std::size_t item, Reply reply) {
    open_.erase(item);
    reply.process = 0;  // of another machine: its number means nothing here
    book_passed(reply, work_.runs);
    run_.take(reply);
    done_(reply.item, reply.fault);
  }
  StepRun& run_;
  const Prepared& work_;
  unsigned tries_;
  const Executor::Done& done_;
  std::map<std::size_t, const Call*> open_;
  std::map<std::size_t, unsigned> begun_, crashed_;
  std::size_t begun_in_all_ = 0;
  std::string trouble_;
};

}  // namespace

SlurmExecutor::SlurmExecutor(SlurmOptions options, WorkerOptions here)
    : options_(std::move(options)), threads_(here.workers), pool_(std::move(here)) {
  queue_.require(options_.profile.partition);
  std::filesystem::create_directories(options_.store / "jobs");
}

bool SlurmExecutor::worth_submitting(const Reply& first, std::size_t more) const {
  return first.seconds * static_cast<double>(more) / threads_ >= options_.profile.submit_above;
}

void SlurmExecutor::make(StepRun& run, const std::vector<std::size_t>& calls, const Done& done) {
  Prepared work = prepared(run, calls, threads_);
  const auto tell = [&](const Reply& reply) { done(reply.item, reply.fault); };
  const auto here = [&](const Task& task, const std::function<void(const Reply&)>& taken) {
    make_by(pool_, run, task, work.runs, taken);
  };
  if (!run.itemwise()) return here(work.task, tell);
  Task first = work.task, rest = work.task;
  first.calls.resize(1);
  rest.calls.erase(rest.calls.begin());
  bool submit = false;
  const bool always = options_.profile.submit_above == 0;
  if (always)
    rest = work.task, submit = true;
  else
    here(first, [&](const Reply& reply) {
      submit = !reply.fault.empty() || worth_submitting(reply, rest.calls.size()), tell(reply);
    });
  if (rest.calls.empty()) return;
  if (!submit) return here(rest, tell);
  work.task = std::move(rest);
  submit_and_wait(run, std::move(work), done);
}

namespace {

/// A job whose driver stops waiting is not worth the machines' time.
struct CancelUnlessOver {
  SlurmQueue& queue;
  std::string& job;
  bool& mine;  ///< submitted by this driver
  ~CancelUnlessOver() {
    if (mine && !job.empty()) queue.cancel(job);
  }
};

/// The calls that a file holds as one array of chunks.
Submission submission_of(const SlurmOptions& options, const std::string& step,
                         const JobFolder& folder, const std::filesystem::path& file,
                         std::size_t calls) {
  const ExecutorProfile& profile = options.profile;
  const std::size_t size = std::max(profile.chunk, (calls + most_chunks - 1) / most_chunks);
  Submission submission{"plumb-" + step,
                        profile.partition,
                        profile.time,
                        (folder.path() / "log/%A_%a.txt").string(),
                        profile.memory,
                        profile.cpus,
                        (calls + size - 1) / size,
                        options.chunk_command};
  for (const std::string& word : {std::string("--task"), file.string(), std::string("--chunk-size"),
                                  std::to_string(size), std::string("--chunk")})
    submission.command.push_back(word);
  return submission;
}

/// Takes what the chunks of a job write until it is over, no call is open or the rest is to be left
/// out; how many it settled.
std::size_t take_until_over(SlurmQueue& queue, const std::string& job, double poll, StepRun& run,
                            JobFolder& folder, Calls& calls) {
  std::size_t settled = 0;
  double pause = 0.1, unanswered = 0;
  for (;;) {
    settled += calls.take(folder.news());
    if (calls.all_settled() || run.stopped()) return settled;
    const JobState state = queue.state(job);
    if (state == JobState::over) break;
    if (state != JobState::unknown)
      unanswered = 0;
    else if ((unanswered += pause) >= patience)
      run.say("Slurm does not answer; waiting for its job " + job +
              ", whose results count once they are in the cache");
    std::this_thread::sleep_for(std::chrono::duration<double>(pause));
    pause = std::min(pause * 1.5, poll);
  }
  settled += calls.take(folder.news());
  return settled + calls.take_rest();
}

}  // namespace

void SlurmExecutor::submit_and_wait(StepRun& run, Prepared work, const Done& done) {
  Hasher name;  // what the calls see, too: a job for other inputs is another job
  name.text(work.task.image);
  for (const Hash128& key : run.item_keys()) name.bytes(&key, sizeof key);
  JobFolder folder(options_.store / "jobs" / name.hash().text());
  if (options_.fresh) {
    folder.remove();
    for (const Call& call : work.task.calls) run.remove_result(call.item);
  }
  Calls calls(run, work, options_.profile.tries, done);
  std::size_t number = 0;
  std::string job;
  bool mine = false;
  if (const auto earlier = folder.submitted()) {  // of a driver that is gone
    number = earlier->number;
    if (queue_.state(earlier->job) != JobState::over)
      job = earlier->job;
    else
      folder.remove();
  }
  const CancelUnlessOver guard{queue_, job, mine};
  std::size_t begun = 0;
  for (int idle = 0; !calls.all_settled() && !run.stopped();) {
    if (job.empty()) {
      if (idle == most_idle_submissions)
        throw Error("step '" + run.plan().path + "': Slurm ended its job " +
                    counted(idle, "times") + " without one more result" +
                    (calls.trouble().empty() ? std::string() : " (" + calls.trouble() + ")") +
                    "; see " + (folder.path() / "log").string());
      const Task task = calls.rest();
      const auto file = folder.write_task(++number, task);
      job =
          queue_.submit(submission_of(options_, run.plan().path, folder, file, task.calls.size()));
      mine = true;
      folder.write_submitted({number, job});
    }
    const std::size_t settled =
        take_until_over(queue_, job, options_.profile.poll, run, folder, calls);
    if (run.stopped() && !calls.all_settled()) return;  // and the job is cancelled
    idle = settled > 0 || calls.begun_in_all() > begun ? 0 : idle + 1;
    begun = calls.begun_in_all();
    job.clear();
  }
  if (calls.all_settled()) folder.remove();
}

}  // namespace plumb
