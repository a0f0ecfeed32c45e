#include "plumb/store/blob.hpp"

#include "plumb/data/archive.hpp"

namespace plumb {
namespace {

constexpr std::string_view magic = "plumb blob 1\n";

Hash128 checksum(std::string_view bytes) {
  Hasher hasher;
  hasher.bytes(bytes.data(), bytes.size());
  return hasher.hash();
}

}  // namespace

std::string blob_of(const Hash128& key, const StoredResult& result) {
  OutArchive<TextSink> out;
  out.put(magic.data(), magic.size());
  out(key.high, key.low, static_cast<std::uint64_t>(result.outputs.size()));
  for (const auto& values : result.outputs) {
    out(static_cast<std::uint64_t>(values.size()));
    for (const AnyValue& value : values)
      out(std::string(value.type->name), value.type->version, value.type->write(value.value.get()));
  }
  out(static_cast<std::uint64_t>(result.counts.size()));
  for (const auto& [what, n] : result.counts) out(what, n);
  out(result.warnings);
  const Hash128 sum = checksum(out.text);
  out(sum.high, sum.low);
  return std::move(out.text);
}

std::optional<StoredResult> read_blob(const Hash128& key, std::string_view bytes) {
  constexpr std::size_t sum_size = 2 * sizeof(std::uint64_t);
  if (bytes.size() < magic.size() + sum_size || !bytes.starts_with(magic)) return std::nullopt;
  const std::string_view body = bytes.substr(0, bytes.size() - sum_size);
  Hash128 sum, own;
  InArchive(bytes.substr(body.size()))(sum.high, sum.low);
  if (sum != checksum(body)) return std::nullopt;
  try {
    InArchive in(body.substr(magic.size()));
    std::uint64_t outputs = 0, count = 0;
    in(own.high, own.low, outputs);
    if (own != key) return std::nullopt;
    StoredResult result;
    for (std::uint64_t o = 0; o < outputs; ++o) {
      std::uint64_t values = 0;
      in(values);
      auto& to = result.outputs.emplace_back();
      for (std::uint64_t v = 0; v < values; ++v) {
        std::string name, value;
        int version = 0;
        in(name, version, value);
        const Type* type = find_type(name);
        if (!type || type->version != version) return std::nullopt;
        to.push_back({type, type->read(value)});
      }
    }
    in(count);
    for (std::uint64_t n = 0; n < count; ++n) {
      auto& [what, number] = result.counts.emplace_back();
      in(what, number);
    }
    in(result.warnings);
    if (!in.at_end()) return std::nullopt;
    return result;
  } catch (const Error&) {
    return std::nullopt;
  }
}

}  // namespace plumb
