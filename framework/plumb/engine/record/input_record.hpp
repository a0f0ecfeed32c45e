#pragma once
/// What a run knows of a file or folder that it reads, for its record.

#include <cstdint>
#include <optional>
#include <string>
#include <vector>

#include "plumb/data/hash.hpp"
#include "plumb/pipeline/bind/plan.hpp"

namespace plumb {

struct InputRecord {
  std::string path;
  std::size_t files = 0;  ///< 0: there is nothing
  std::uint64_t bytes = 0;
  Hash128
      digest;  ///< of each file's name, size and time of the last change: a copy has another one
  std::optional<Hash128> content;  ///< of each file's name and bytes: a copy has the same
};

/// A file, or all that lies in a folder and in the folders below it, in order of name, links
/// followed. What runs left in it is no input and left out: folders of results and of stores. No
/// file is opened unless `content` is asked for. Throws Error: a file cannot be read.
InputRecord input_record(const std::string& path, bool content);

/// What parameters of kind path name in any step and pass: each once, in order.
std::vector<std::string> input_paths(const Plan& plan);

/// Of a file's bytes. Throws Error: it cannot be read.
Hash128 file_hash(const std::string& file);

}  // namespace plumb
