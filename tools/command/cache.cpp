/// plumb cache: what the cache holds, whether it is whole, and how it is kept small.

#include <algorithm>
#include <ctime>
#include <iomanip>
#include <iostream>
#include <limits>
#include <map>

#include "cache_size.hpp"
#include "command.hpp"
#include "command_line.hpp"
#include "plumb/data/amount.hpp"
#include "plumb/data/counted.hpp"
#include "plumb/store/index.hpp"
#include "plumb/store/upkeep.hpp"
#include "store_option.hpp"
#include "usage.hpp"

namespace plumb::command {
namespace {

struct Options {
  StoreOption store;
  std::string older, size;
};

std::string day_and_time(std::int64_t ms) {
  const std::time_t seconds = ms / 1000;
  char text[32];
  std::strftime(text, sizeof text, "%Y-%m-%d %H:%M", std::localtime(&seconds));
  return text;
}

std::string results(std::size_t n) { return counted(n, "results"); }

/// The store that is meant; none, which is said, when there is none yet: looking for one does not
/// make it.
std::unique_ptr<Store> existing(const Options& options) {
  options.store.require_one_meaning();
  const auto folder = options.store.folder();
  if (folder.empty())
    throw UsageError(options.store.none()
                         ? options.store.title() +
                               ": there is nothing to look after; name a folder by --cache-dir DIR"
                         : "neither XDG_CACHE_HOME nor HOME names a folder; say by "
                           "--cache-dir DIR which cache is meant");
  if (std::filesystem::exists(folder)) return options.store.open(folder);
  std::cout << folder.string() << ": nothing is kept yet\n";
  return nullptr;
}

void show(const Options& options) {
  CacheSize().require_one_meaning(options.store);
  const auto store = existing(options);
  if (!store) return;
  struct Sum {
    std::size_t results = 0;
    std::uint64_t bytes = 0;
    std::int64_t made = std::numeric_limits<std::int64_t>::max(), used = 0;
    void add(const IndexRow& row) {
      ++results, bytes += row.bytes;
      made = std::min(made, row.made), used = std::max(used, row.used);
    }
  };
  Sum all;
  std::map<std::string, Sum> by_step;
  for (const IndexRow& row : store->index()->rows()) all.add(row), by_step[row.step].add(row);
  say_faults(*store);
  std::cout << store->folder().string() << ": " << results(all.results) << ", "
            << text_of_bytes(all.bytes) << "; bound: " << CacheSize().limit(*store).shown() << "\n";
  if (all.results == 0) return;
  std::vector<std::pair<std::string, Sum>> lines(by_step.begin(), by_step.end());
  std::ranges::stable_sort(
      lines, [](const auto& a, const auto& b) { return a.second.bytes > b.second.bytes; });
  std::cout << "\n"
            << std::left << std::setw(28) << "step" << std::right << std::setw(9) << "results"
            << std::setw(11) << "size" << std::setw(19) << "oldest" << std::setw(19) << "last used"
            << "\n";
  lines.emplace_back("all", all);
  for (const auto& [step, sum] : lines)
    std::cout << std::left << std::setw(28) << step << std::right << std::setw(9) << sum.results
              << std::setw(11) << text_of_bytes(sum.bytes) << std::setw(19)
              << day_and_time(sum.made) << std::setw(19) << day_and_time(sum.used) << "\n";
}

void verify_store(const Options& options) {
  const auto store = existing(options);
  if (!store) return;
  const Verified verified = verify(*store);
  say_faults(*store);
  for (const std::string& damaged : verified.damaged)
    std::cout << "damaged and removed: " << damaged << "\n";
  std::cout << results(verified.results) << ", " << text_of_bytes(verified.bytes) << ": ";
  if (verified.damaged.empty())
    std::cout << "all whole\n";
  else
    std::cout << verified.damaged.size()
              << " damaged and removed; a run that needs them makes them again\n";
  if (!verified.good(*store)) throw ExitWith{1};
}

void prune_store(const Options& options) {
  PruneLimits limits;
  if (!options.older.empty())
    limits.older = usage([&] { return age_of_text("--older", options.older); });
  if (!options.size.empty())
    limits.bytes = usage([&] { return bytes_of_text("--size", options.size); });
  if (!limits.older && !limits.bytes)
    throw UsageError(
        "cache prune: removes nothing without a limit; give --older 30d, --size 10GiB or both");
  const auto store = existing(options);
  if (!store) return;
  const Pruned pruned = prune(*store, limits);
  say_faults(*store);
  std::cout << "freed " << text_of_bytes(pruned.bytes + pruned.unfinished_bytes) << ": "
            << results(pruned.results);
  if (pruned.unfinished) std::cout << " and " << pruned.unfinished << " that runs left unfinished";
  std::cout << "; " << results(pruned.left) << ", " << text_of_bytes(pruned.left_bytes)
            << " are left";
  if (pruned.held)
    std::cout << ", " << pruned.held << " of them because a run in progress holds "
              << (pruned.held == 1 ? "it" : "them");
  std::cout << "\n";
}

}  // namespace

void add_cache(Command& program) {
  Command command = program.add_subcommand("cache", "Shows, checks and prunes what runs have kept");
  auto options = std::make_shared<Options>();
  options->store.add_to(command);
  command.require_subcommand(0, 1);
  command.footer(
      "Without a sub-command: number and size of the results by step, and the bound that runs hold "
      "(run --cache-size, PLUMB_CACHE_SIZE). All of it is safe while runs use the cache; what is "
      "removed is made again.\n"
      "Example: plumb cache prune --older 30d --size 10GiB");
  Command check = command.add_subcommand(
      "verify", "Checks every result and the index, and removes what is damaged");
  check.footer("Exit 1 when anything was damaged.");
  Command less = command.add_subcommand("prune", "Removes results, least recently used first");
  less.add_option("--older", options->older,
                  "Removes what was not used for this long: 12h, 30d, 8w");
  less.add_option("--size", options->size, "Removes until no more than this is left: 500MB, 10GiB");
  less.footer(
      "What a run in progress made or used stays.\n"
      "Example: plumb cache prune --older 30d --size 10GiB");
  for (Command sub : {check, less})
    sub.fallthrough();  // --cache-dir and --trust-cache behind the sub-command are the command's
                        // own
  check.callback([options] { verify_store(*options); });
  less.callback([options] { prune_store(*options); });
  command.callback([command, options] {
    if (!command.has_subcommand()) show(*options);
  });
}

}  // namespace plumb::command
