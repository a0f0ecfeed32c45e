#include "plumb/engine/remote/slurm/queue.hpp"

#include <fcntl.h>
#include <poll.h>
#include <signal.h>
#include <spawn.h>
#include <sys/wait.h>
#include <unistd.h>

#include <algorithm>
#include <set>
#include <sstream>

#include "plumb/data/error.hpp"

extern char** environ;

namespace plumb {
namespace {

std::string quoted(const std::string& word) {
  std::string text = "'";
  for (const char c : word) text += c == '\'' ? std::string("'\\''") : std::string(1, c);
  return text + "'";
}

std::string first_line(const std::string& text) { return text.substr(0, text.find('\n')); }

}  // namespace

CommandSaid run_command(const std::vector<std::string>& words) {
  CommandSaid said;
  int out[2], err[2];
  if (pipe2(out, O_CLOEXEC) != 0) return said;
  if (pipe2(err, O_CLOEXEC) != 0) return close(out[0]), close(out[1]), said;
  posix_spawn_file_actions_t actions;
  posix_spawn_file_actions_init(&actions);
  posix_spawn_file_actions_addopen(&actions, STDIN_FILENO, "/dev/null", O_RDONLY, 0);
  posix_spawn_file_actions_adddup2(&actions, out[1], STDOUT_FILENO);
  posix_spawn_file_actions_adddup2(&actions, err[1], STDERR_FILENO);
  std::vector<char*> arguments;
  arguments.reserve(words.size() + 1);
  for (const std::string& word : words) arguments.push_back(const_cast<char*>(word.c_str()));
  arguments.push_back(nullptr);
  pid_t id = -1;
  posix_spawnattr_t attributes;  // signals that this process holds back, the command does not
  posix_spawnattr_init(&attributes);
  sigset_t none;
  sigemptyset(&none);
  posix_spawnattr_setsigmask(&attributes, &none);
  posix_spawnattr_setflags(&attributes, POSIX_SPAWN_SETSIGMASK);
  const int fault =
      posix_spawnp(&id, arguments[0], &actions, &attributes, arguments.data(), environ);
  posix_spawnattr_destroy(&attributes);
  posix_spawn_file_actions_destroy(&actions);
  close(out[1]);
  close(err[1]);
  pollfd ends[2] = {{out[0], POLLIN, 0}, {err[0], POLLIN, 0}};
  std::string* texts[2] = {&said.out, &said.err};
  for (int open = fault == 0 ? 2 : 0; open > 0;) {
    if (poll(ends, 2, -1) < 0) continue;
    for (int e = 0; e < 2; ++e) {
      if (ends[e].fd < 0 || !ends[e].revents) continue;
      char buffer[4096];
      const ssize_t n = read(ends[e].fd, buffer, sizeof buffer);
      if (n > 0)
        texts[e]->append(buffer, static_cast<std::size_t>(n));
      else if (n == 0 || errno != EINTR)
        ends[e].fd = -1, --open;
    }
  }
  close(out[0]);
  close(err[0]);
  if (fault != 0) {
    said.code = 127;
    return said;
  }
  int status = 0;
  while (waitpid(id, &status, 0) < 0 && errno == EINTR) {
  }
  said.code = WIFEXITED(status) ? WEXITSTATUS(status) : 128 + WTERMSIG(status);
  return said;
}

void SlurmQueue::require(const std::string& partition) const {
  const CommandSaid said = run_command({"sinfo", "--all", "--noheader", "--format", "%R"});
  if (said.code == 127)
    throw Error(
        "--executor slurm: there is no 'sinfo' here; run where Slurm is installed, or without "
        "--executor");
  if (said.code != 0)
    throw Error("--executor slurm: Slurm does not answer: " + first_line(said.err) +
                "; look at its controller (scontrol ping), or run without --executor");
  std::set<std::string> there;
  std::string all, name;
  for (std::istringstream lines(said.out); lines >> name;)
    if (there.insert(name).second) all += (all.empty() ? "" : ", ") + name;
  for (std::istringstream asked(partition); std::getline(asked, name, ',');)
    if (!there.contains(name))
      throw Error("--executor slurm: Slurm has no partition '" + name + "', it has: " + all +
                  "; look at the executor profile");
}

std::string SlurmQueue::submit(const Submission& submission) {
  std::vector<std::string> words = {"sbatch",
                                    "--parsable",
                                    "--no-requeue",
                                    "--job-name",
                                    submission.name,
                                    "--output",
                                    submission.log,
                                    "--array",
                                    "0-" + std::to_string(submission.chunks - 1),
                                    "--cpus-per-task",
                                    std::to_string(submission.cpus)};
  const auto add = [&](const char* option, const std::string& value) {
    if (!value.empty()) words.insert(words.end(), {option, value});
  };
  add("--partition", submission.partition);
  add("--time", submission.time);
  if (submission.memory > 0)
    add("--mem", std::to_string((submission.memory + (1 << 20) - 1) >> 20) + "M");
  std::string line = "exec";
  for (const std::string& word : submission.command) line += " " + quoted(word);
  add("--wrap", line + " \"$SLURM_ARRAY_TASK_ID\"");
  const CommandSaid said = run_command(words);
  if (said.code == 127)
    throw Error(
        "--executor slurm: there is no 'sbatch' here; run where Slurm is installed, or without "
        "--executor");
  if (said.code != 0)
    throw Error("--executor slurm: sbatch does not take the job: " + first_line(said.err) +
                "; look at the executor profile");
  const std::string job = first_line(said.out);
  return job.substr(0, job.find(';'));  // "123;cluster" where there are several
}

JobState SlurmQueue::state(const std::string& job) {
  const CommandSaid said = run_command({"squeue", "--noheader", "--jobs", job, "--format", "%T"});
  if (said.code == 127)
    throw Error("--executor slurm: there is no 'squeue' here; run where Slurm is installed");
  if (said.code != 0)
    return said.err.find("Invalid job id") != std::string::npos ? JobState::over
                                                                : JobState::unknown;
  return said.out.find_first_not_of(" \n") == std::string::npos ? JobState::over : JobState::active;
}

void SlurmQueue::cancel(const std::string& job) { run_command({"scancel", job}); }

}  // namespace plumb
