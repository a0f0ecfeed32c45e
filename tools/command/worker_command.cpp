#include "worker_command.hpp"

#include "command.hpp"

namespace plumb::command {

std::vector<std::string> words_of(const WorkerCommand& worker) {
  std::vector<std::string> words = {std::filesystem::read_symlink("/proc/self/exe").string()};
  for (const auto& folder : plugin_path)
    words.insert(words.end(), {"--plugin-path", std::filesystem::absolute(folder).string()});
  words.insert(words.end(),
               {"worker", "--cache-dir", std::filesystem::absolute(worker.store).string()});
  if (worker.memory > 0) words.insert(words.end(), {"--memory", std::to_string(worker.memory)});
  if (worker.trusted) words.push_back("--trust-cache");
  if (worker.contents) words.push_back("--contents");
  return words;
}

}  // namespace plumb::command
