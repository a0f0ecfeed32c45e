/// run.lock.yaml: YAML for people and tools, of which every line stands where it must, so that it
/// is read back byte by byte.
#include <charconv>
#include <sstream>

#include "plumb/data/error.hpp"
#include "plumb/data/io/file_text.hpp"
#include "plumb/engine/record/quoted.hpp"
#include "plumb/engine/record/run_record.hpp"
#include "plumb/pipeline/yaml/foreign_file.hpp"

namespace plumb {
namespace {

/// Of all other lines, so that an edited record does not pass for the run's own.
const std::string hash_line = "record_hash: ";

std::string digest_of(const std::string& text) {
  Hasher hasher;
  hasher.text(text);
  return hasher.hash().text();
}

/// The lines of a lock, each of which is expected.
class Reader {
 public:
  Reader(std::string file, const std::string& text) : file_(std::move(file)), in_(text) { step(); }

  bool at(const std::string& begin) const { return !over_ && line_.starts_with(begin); }
  /// What follows `begin` in this line; goes on to the next.
  std::string take(const std::string& begin) {
    if (!at(begin)) fail("'" + begin + "' is expected");
    std::string rest = line_.substr(begin.size());
    step();
    return rest;
  }
  std::string take_quoted(const std::string& begin) {
    const auto text = from_quotes(take(begin));
    if (!text) fail("text is expected before");
    return *text;
  }
  template <class T>
  T take_number(const std::string& begin) {
    return number<T>(take(begin));
  }
  template <class T>
  T number(const std::string& text) {
    T value{};
    const auto [end, error] = std::from_chars(text.data(), text.data() + text.size(), value);
    if (error != std::errc() || end != text.data() + text.size())
      fail("a number is expected before, not '" + text + "'");
    return value;
  }
  Hash128 take_hash(const std::string& begin) { return hash(take(begin)); }
  Hash128 hash(const std::string& text) const {
    Hash128 value;
    if (text.size() != 32 ||
        std::from_chars(text.data(), text.data() + 16, value.high, 16).ptr != text.data() + 16 ||
        std::from_chars(text.data() + 16, text.data() + 32, value.low, 16).ptr != text.data() + 32)
      fail("32 hexadecimal digits are expected before, not '" + text + "'");
    return value;
  }
  bool over() const { return over_; }
  [[noreturn]] void fail(const std::string& why) const {
    throw Error(
        file_ + ":" + std::to_string(number_) + ": " + why +
        "; the record is damaged or of another Plumb: run the pipeline itself to get a new one");
  }

 private:
  void step() {
    ++number_;
    over_ = !std::getline(in_, line_);
  }
  std::string file_;
  std::istringstream in_;
  std::string line_;
  int number_ = 0;
  bool over_ = false;
};

/// "a b.txt": {bytes: 12, hash: HASH}
FileRecord file_of(Reader& reader) {
  const std::string line = reader.take("  - ");
  const auto bytes = line.rfind(": {bytes: "), hash = line.rfind(", hash: ");
  if (bytes == line.npos || hash == line.npos || hash < bytes + 10 || line.back() != '}')
    reader.fail("a file is expected before");
  FileRecord file;
  file.name = line.substr(0, bytes);
  file.name = from_quotes(file.name).value_or(file.name);
  file.bytes = reader.number<std::uint64_t>(line.substr(bytes + 10, hash - bytes - 10));
  file.hash = reader.hash(line.substr(hash + 8, line.size() - hash - 9));
  return file;
}

/// {use: match.nearest, version: 1, module: HASH}
StepRecord step_of(Reader& reader) {
  const std::string line = reader.take("  ");
  const auto use = line.find(": {use: "), version = line.find(", version: "),
             module = line.find(", module: ");
  const auto end = line.size() - 1;
  if (use == line.npos || version == line.npos || version < use || line.back() != '}')
    reader.fail("a step is expected before");
  StepRecord step;
  step.path = line.substr(0, use);
  step.use = line.substr(use + 8, version - use - 8);
  const auto from = version + 11, to = module == line.npos ? end : module;
  if (to < from) reader.fail("a step is expected before");
  step.version = reader.number<int>(line.substr(from, to - from));
  if (module != line.npos) step.module = line.substr(module + 10, end - module - 10);
  return step;
}

}  // namespace

std::string lock_text(const RunRecord& record) {
  std::ostringstream out;
  out << pipeline::lock_first_line << "\nplumb: " << record.plumb
      << "\nabi: " << in_quotes(record.abi) << "\nlibrary: " << in_quotes(record.library)
      << "\nname: " << in_quotes(record.name) << "\nfiles:\n";
  for (const FileRecord& file : record.files)
    out << "  - " << in_quotes_where_needed(file.name) << ": {bytes: " << file.bytes
        << ", hash: " << file.hash.text() << "}\n";
  out << "steps:\n";
  for (const StepRecord& step : record.steps) {
    out << "  " << step.path << ": {use: " << step.use << ", version: " << step.version;
    if (!step.module.empty()) out << ", module: " << step.module;
    out << "}\n";
  }
  out << "inputs:\n";
  for (const InputRecord& input : record.inputs) {
    out << "  - path: " << in_quotes(input.path) << "\n    files: " << input.files
        << "\n    bytes: " << input.bytes << "\n    digest: " << input.digest.text() << '\n';
    if (input.content) out << "    content: " << input.content->text() << '\n';
  }
  out << "pipeline_digest: " << digest_of(record.pipeline) << "\npipeline: |\n";
  std::istringstream lines(record.pipeline);
  for (std::string line; std::getline(lines, line);) out << "  " << line << '\n';
  std::string text = out.str();
  return text.insert(text.find("\nfiles:\n") + 1, hash_line + digest_of(text) + "\n");
}

std::optional<std::vector<FileRecord>> files_of_lock(const std::string& text) {
  if (!text.starts_with(pipeline::lock_first_line)) return std::nullopt;
  const auto begin = text.find("\n" + hash_line) + 1, end = text.find('\n', begin);
  if (begin == 0 || end == text.npos) return std::nullopt;
  std::string hashed = text;
  hashed.erase(begin, end + 1 - begin);
  if (text.substr(begin, end - begin) != hash_line + digest_of(hashed)) return std::nullopt;
  std::vector<FileRecord> files;
  Reader reader(lock_name, text.substr(end + 1));
  reader.take("files:");
  while (reader.at("  - ")) files.push_back(file_of(reader));
  return files;
}

namespace {

std::string text_of(const std::filesystem::path& file) try {
  constexpr std::uint64_t most = std::uint64_t{64} << 20;
  return std::string(io::FileBytes(file, most, "record of a run").view());
} catch (const Error& e) {
  throw Error(std::string(e.what()) + "; give the run.lock.yaml of a run");
}

}  // namespace

RunRecord read_lock(const std::filesystem::path& file) {
  const std::string text = text_of(file);
  if (!text.starts_with(pipeline::lock_first_line))
    throw Error(file.string() + ": is no record of a run; give the run.lock.yaml of one");
  Reader reader(file.string(), text);
  reader.take(pipeline::lock_first_line);
  RunRecord record;
  record.plumb = reader.take("plumb: ");
  record.abi = reader.take_quoted("abi: ");
  record.library = reader.take_quoted("library: ");
  record.name = reader.take_quoted("name: ");
  reader.take_hash(hash_line);
  reader.take("files:");
  while (reader.at("  - ")) record.files.push_back(file_of(reader));
  reader.take("steps:");
  while (reader.at("  ")) record.steps.push_back(step_of(reader));
  reader.take("inputs:");
  while (reader.at("  - path: ")) {
    InputRecord& input = record.inputs.emplace_back();
    input.path = reader.take_quoted("  - path: ");
    input.files = reader.take_number<std::size_t>("    files: ");
    input.bytes = reader.take_number<std::uint64_t>("    bytes: ");
    input.digest = reader.take_hash("    digest: ");
    if (reader.at("    content: ")) input.content = reader.take_hash("    content: ");
  }
  const Hash128 digest = reader.take_hash("pipeline_digest: ");
  reader.take("pipeline: |");
  while (!reader.over()) record.pipeline += reader.take("  ") + "\n";
  if (const std::string is = digest_of(record.pipeline); is != digest.text())
    throw Error(file.string() + ": its pipeline was changed after the run: its digest was " +
                digest.text() + ", is " + is +
                "; to run a changed pipeline, give the pipeline itself");
  return record;
}

}  // namespace plumb
