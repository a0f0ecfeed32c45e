#include "journal.hpp"

#include <dlfcn.h>
#include <execinfo.h>

#include <array>
#include <cstdio>
#include <cstdlib>
#include <cstring>

#include "past.hpp"

namespace faults {
namespace {

struct Journal {
  int file = -1;
  std::string module;  ///< this library

  Journal() {
    if (const char* name = std::getenv("FAULTS_LOG"))
      if (file = open_past(name, O_WRONLY | O_CREAT | O_APPEND | O_CLOEXEC); file < 0)
        give_up("faults: FAULTS_LOG cannot be written\n");
    Dl_info here{};
    if (dladdr(reinterpret_cast<void*>(&open_log), &here) != 0) module = here.dli_fname;
    void* none[1];
    backtrace(none, 1);  // loads what it needs
  }
};

const Journal& journal() {
  static const Journal* all = new Journal;  // outlives all that calls at the end of the process
  return *all;
}

void append(std::string& line, const std::string& text) { line += text, line += '\t'; }
void append(std::string& line, std::int64_t number) { append(line, std::to_string(number)); }

std::string hexadecimal(std::string_view bytes) {
  constexpr const char* digits = "0123456789abcdef";
  std::string text;
  text.reserve(2 * bytes.size());
  for (const unsigned char byte : bytes) text += digits[byte >> 4], text += digits[byte & 15];
  return text;
}

/// MODULE+OFFSET of all who are in the midst of a call, without this library.
std::string callers() {
  std::array<void*, 40> frames;
  const int n = backtrace(frames.data(), static_cast<int>(frames.size()));
  std::string text;
  for (int k = 0; k < n; ++k) {
    Dl_info at{};
    if (dladdr(frames[static_cast<std::size_t>(k)], &at) == 0 || journal().module == at.dli_fname)
      continue;
    char part[300];
    const char* name = std::strrchr(at.dli_fname, '/');
    std::snprintf(part, sizeof part, "%s+%zx ", name ? name + 1 : at.dli_fname,
                  static_cast<std::size_t>(static_cast<char*>(frames[static_cast<std::size_t>(k)]) -
                                           static_cast<char*>(at.dli_fbase)));
    text += part;
  }
  return text;
}

}  // namespace

void open_log() { journal(); }

void log(const Call& call, const Fate& fate, long result, int error) {
  if (journal().file < 0) return;
  std::string line;
  append(line, static_cast<std::int64_t>(fate.number));
  append(line, getpid());
  append(line, std::string(call.name));
  append(line, result);
  append(line, result < 0 ? error : 0);
  append(line, fate.fails() || fate.is_short);
  append(line, call.fd);
  append(line, call.offset);
  append(line, call.flags);
  append(line, call.path);
  append(line, call.second);
  append(line,
         hexadecimal(call.bytes.substr(0, result < 0 ? 0 : static_cast<std::size_t>(result))));
  line += callers() + "\n";
  static_cast<void>(!syscall(SYS_write, journal().file, line.data(), line.size()));
}

}  // namespace faults
