#include "plumb/engine/remote/slurm/profile.hpp"

#include <limits>

#include "plumb/data/amount.hpp"
#include "plumb/data/io/file_text.hpp"
#include "plumb/pipeline/yaml/foreign_file.hpp"
#include "plumb/pipeline/yaml/value.hpp"

namespace plumb {
namespace {

ParameterDescription key(const char* name, ParameterKind kind, ParameterValue standard,
                         const char* doc, double low = 0,
                         double high = std::numeric_limits<double>::infinity(),
                         Quantity quantity = Quantity::none) {
  ParameterDescription description;
  description.name = name;
  description.kind = kind;
  description.standard = std::move(standard);
  description.doc = doc;
  description.low = low;
  description.high = high;
  description.quantity = quantity;
  return description;
}

void set(ExecutorProfile& profile, const std::string& name, const ParameterValue& value) {
  const auto text = [&] { return std::get<std::string>(value); };
  const auto whole = [&] { return std::get<std::int64_t>(value); };
  if (name == "partition") profile.partition = text();
  if (name == "time") profile.time = text();
  if (name == "cpus") profile.cpus = static_cast<unsigned>(whole());
  if (name == "chunk") profile.chunk = static_cast<std::size_t>(whole());
  if (name == "tries") profile.tries = static_cast<unsigned>(whole());
  if (name == "submit_above") profile.submit_above = std::get<double>(value);
  if (name == "poll") profile.poll = std::get<double>(value);
}

std::string profile_text(const std::filesystem::path& file) try {
  constexpr std::uint64_t most = 1 << 20;
  return std::string(io::FileBytes(file, most, "executor profile").view());
} catch (const Error& e) {
  throw Error(std::string("--executor-profile ") + e.what());
}

}  // namespace

const std::vector<ParameterDescription>& profile_keys() {
  using Kind = ParameterKind;
  static const ExecutorProfile p;
  static const std::vector<ParameterDescription> keys = {
      key("partition", Kind::text, p.partition, "Slurm's partition; the site's default without it"),
      key("time", Kind::text, p.time,
          "time limit of a chunk as sbatch takes it, such as 30 or 1:00:00; the partition's "
          "without it"),
      key("memory", Kind::text, std::string(),
          "memory of a chunk, such as 4 GiB; the partition's without it"),
      key("cpus", Kind::integer, std::int64_t{p.cpus},
          "processors of a chunk: so many of its calls run at a time", 1, 1024),
      key("chunk", Kind::integer, static_cast<std::int64_t>(p.chunk),
          "calls of an array element; let one take minutes", 1, 1e6),
      key("submit_above", Kind::number, p.submit_above,
          "work of a step expected to take less than this is made on the driver's own machine", 0,
          86400, Quantity::time),
      key("tries", Kind::integer, std::int64_t{p.tries},
          "of a call whose process does not survive it, before it is set aside", 1, 10),
      key("poll", Kind::number, p.poll, "longest time between two looks at the queue", 0.1, 600,
          Quantity::time),
  };
  return keys;
}

ExecutorProfile read_profile(const std::filesystem::path& file) {
  ExecutorProfile profile;
  std::vector<std::string> known;
  for (const ParameterDescription& one : profile_keys()) known.push_back(one.name);
  const std::string text = profile_text(file);
  pipeline::Diagnostics diagnostics;
  const auto tree = pipeline::parse_yaml(text, file.string(), diagnostics);
  if ((!tree || !tree->is_map()) && !pipeline::has_key(text, known))  // nothing of it is shown
    throw Error("--executor-profile " + file.string() +
                ": is no executor profile: no line of it begins with one of its keys, which are " +
                pipeline::joined(known));
  diagnostics.raise();
  if (tree && !tree->is_map())
    diagnostics.add(tree->origin, "an executor profile is a map of keys and values.");
  if (tree)
    for (const pipeline::Entry& entry : tree->entries) {
      const ParameterDescription* description = nullptr;
      for (const ParameterDescription& one : profile_keys())
        if (one.name == entry.key) description = &one;
      if (!description) {
        diagnostics.add(entry.origin, "an executor profile has no key '" + entry.key + "'.",
                        pipeline::did_you_mean(entry.key, known));
        continue;
      }
      auto value = pipeline::read_value(*description, entry.value);
      if (const auto* fault = std::get_if<pipeline::Fault>(&value)) {
        diagnostics.add(entry.value.origin, "'" + entry.key + "': " + fault->sentence + ".",
                        fault->hint);
      } else if (entry.key == "memory") {
        try {
          profile.memory = bytes_of_text("memory", entry.value.text);
        } catch (const Error& e) {
          diagnostics.add(entry.value.origin, e.what(), "Write it as in '4GiB' or '500MiB'.");
        }
      } else {
        set(profile, entry.key, std::get<ParameterValue>(value));
      }
    }
  diagnostics.raise();
  return profile;
}

}  // namespace plumb
