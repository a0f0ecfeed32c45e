#include "cache_size.hpp"

#include <cstdlib>
#include <iostream>

#include "command_line.hpp"
#include "plumb/data/amount.hpp"
#include "plumb/data/counted.hpp"
#include "plumb/data/error.hpp"
#include "usage.hpp"

namespace plumb::command {
namespace {

constexpr const char *option = "--cache-size", *variable = "PLUMB_CACHE_SIZE";

/// "500MB", "none", said by `by`. Throws UsageError.
CacheLimit read(const std::string& text, const char* by) {
  if (text == "none") return {{}, text, by, false};
  try {
    return {bytes_of_text(by, text), text, by, false};
  } catch (const Error& e) {
    throw UsageError(std::string(e.what()) + ", or none");
  }
}

/// What the command line or the environment says; none when neither does.
std::optional<CacheLimit> said(const std::string& given) {
  if (!given.empty()) return read(given, option);
  if (const char* value = std::getenv(variable); value && *value) return read(value, variable);
  return std::nullopt;
}

/// A round amount that holds so much: "4GB".
std::string amount_above(std::uint64_t bytes) {
  constexpr std::uint64_t mega = 1'000'000, giga = 1'000'000'000;
  return bytes < giga ? std::to_string(bytes / mega + 1) + "MB"
                      : std::to_string(bytes / giga + 1) + "GB";
}

}  // namespace

void CacheSize::add_to(Command& command) {
  command.add_option(option, given,
                     "What the cache may hold, such as 50GB, or `none`: at the end of a run, and "
                     "meanwhile, results that were used least recently are removed, but none that "
                     "a run in progress made or used. Without: PLUMB_CACHE_SIZE, or 20 GB, or four "
                     "fifths of what its disk has for it if that is less");
}

void CacheSize::require_one_meaning(const StoreOption& store) const {
  said(given);
  if (!given.empty() && store.none())
    throw UsageError(std::string(option) + " " + given +
                     ": bounds a cache, and there is none; leave it out, or give --cache-dir DIR");
}

CacheLimit CacheSize::limit(Store& store) const {
  if (auto limit = said(given)) return *limit;
  const std::uint64_t bytes = default_bound(store);
  if (bytes == default_store_size)
    return {bytes, std::to_string(bytes / 1'000'000'000) + " GB", "the default", false};
  return {bytes, text_of_bytes(bytes), "four fifths of what its disk has for it", true};
}

void BoundedCache::end(bool quiet) {
  if (!limit_.bytes) return;
  bound_.at_end();
  const Trimmed& trimmed = bound_.trimmed();
  if (trimmed.results > 0 && !quiet)
    std::cerr << "cache: removed " << counted(trimmed.results, "results") << " ("
              << text_of_bytes(trimmed.bytes)
              << "), least recently used first, to hold no more than " << limit_.shown() << "\n";
  if (trimmed.own_bytes <= *limit_.bytes) return;
  std::cerr << "cache: holds more than " << limit_.shown() << ", for this run alone made or used "
            << text_of_bytes(trimmed.own_bytes)
            << ", of which nothing was removed; the next run removes what it does not use: "
            << (limit_.of_disk ? "make room on the disk, or name a folder on another one with "
                                 "--cache-dir\n"
                               : "give " + std::string(option) + " " +
                                     amount_above(trimmed.own_bytes) + " to keep it all\n");
}

}  // namespace plumb::command
